#include "taut/core/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace taut {
namespace {

using boost::multiprecision::cpp_rational;

constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

// ---- The slow answer ----

using Rational3 = std::array<cpp_rational, 3>;

Rational3 rational_difference(const dvec3& p, const dvec3& q) {
  return {cpp_rational(p.x) - cpp_rational(q.x), cpp_rational(p.y) - cpp_rational(q.y),
          cpp_rational(p.z) - cpp_rational(q.z)};
}

Rational3 rational_cross(const Rational3& v, const Rational3& w) {
  return {v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]};
}

cpp_rational rational_determinant(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const Rational3 n = rational_cross(rational_difference(b, a), rational_difference(c, a));
  const Rational3 w = rational_difference(d, a);
  return n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
}

Sign rational_sign(const cpp_rational& x) { return static_cast<Sign>(x.sign()); }

// ---- Points ----

using Random = std::mt19937_64;
using Tetrahedron = std::array<dvec3, 4>;

double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

int pick(Random& random, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(random);
}

dvec3 random_point(Random& random) {
  const double x = uniform(random, -1, 1);
  const double y = uniform(random, -1, 1);
  return {x, y, uniform(random, -1, 1)};
}

dvec3 grid_point(Random& random, int size) {
  const int x = pick(random, -size, size);
  const int y = pick(random, -size, size);
  return dvec3(x, y, pick(random, -size, size));
}

double one_ulp_aside(Random& random, double x) {
  const int step = pick(random, -1, 1);
  return step == 0 ? x : std::nextafter(x, step * largest);
}

double log_uniform(Random& random, double lower_exponent, double upper_exponent) {
  const double size = std::pow(10, uniform(random, lower_exponent, upper_exponent));
  return pick(random, 0, 1) == 0 ? -size : size;
}

template <class Coordinate>
Tetrahedron each_coordinate(const Coordinate& coordinate) {
  Tetrahedron t;
  for (dvec3& p : t) {
    for (int i = 0; i < 3; ++i) p[i] = coordinate();
  }
  return t;
}

Tetrahedron scaled(Tetrahedron t, double factor) {
  for (dvec3& p : t) p *= factor;
  return t;
}

Tetrahedron uniform_points(Random& random) {
  return each_coordinate([&] { return uniform(random, -1, 1); });
}

/// On a plane but for rounding, then up to one ulp aside in each coordinate.
Tetrahedron nearly_coplanar(Random& random) {
  const dvec3 a = random_point(random);
  const dvec3 u = random_point(random);
  const dvec3 v = random_point(random);
  const double s = uniform(random, -1, 1);
  Tetrahedron t = {a, a + u, a + v, a + s * u + uniform(random, -1, 1) * v};
  for (int i = 0; i < 3; ++i) t[3][i] = one_ulp_aside(random, t[3][i]);
  return t;
}

/// Four points of a parallelogram grid that no axis is parallel to, without rounding.
Tetrahedron exactly_coplanar_grid(Random& random) {
  const dvec3 a = grid_point(random, 1 << 20);
  const dvec3 u = grid_point(random, 1 << 20);
  const dvec3 v = grid_point(random, 1 << 20);
  Tetrahedron t;
  for (dvec3& p : t) p = a + double(pick(random, -99, 99)) * u + double(pick(random, -99, 99)) * v;
  return scaled(t, std::ldexp(1.0, pick(random, -900, 900)));
}

/// Coplanar through the origin, all 53 bits in use, with differences that do not fit a double.
Tetrahedron exactly_coplanar_pairs(Random& random) {
  const dvec3 a = random_point(random) * dvec3(1, 0x1p-9, 0x1p9);
  const dvec3 b = random_point(random);
  return {a, b, -a, -b};
}

/// Determinant -1, 0 or 1 from integers as large as doubles hold: about 2^-155 of the products, out
/// of reach of double_double. Many differences need more than 53 bits.
Tetrahedron unimodular(Random& random) {
  using Row = std::array<std::int64_t, 3>;
  constexpr std::int64_t limit = std::int64_t{1} << 53;
  const Row last = pick(random, 0, 2) == 0 ? Row{1, 1, 2} : Row{1, 1, 3};
  std::array<Row, 3> m = {{{1, 0, 1}, {0, 1, 1}, last}};
  for (;;) {
    const auto i = static_cast<std::size_t>(pick(random, 0, 2));
    const auto j = (i + static_cast<std::size_t>(pick(random, 1, 2))) % 3;
    const int factor = pick(random, 1, 3);
    Row row = m[i];
    for (std::size_t k = 0; k < 3; ++k) row[k] += factor * m[j][k];
    if (*std::max_element(row.begin(), row.end()) >= 2 * limit) break;
    m[i] = row;
  }
  const std::int64_t shift = limit - pick(random, 1, 1000);
  Tetrahedron t = {dvec3(-static_cast<double>(shift))};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      t[i + 1][static_cast<int>(k)] = static_cast<double>(m[i][k] - shift);
    }
  }
  if (pick(random, 0, 1) == 0) std::swap(t[1], t[2]);
  return t;
}

Tetrahedron with_duplicates(Random& random) {
  Tetrahedron t = each_coordinate([&] { return log_uniform(random, -300, 300); });
  const int i = pick(random, 0, 3);
  t[static_cast<std::size_t>(i)] = t[static_cast<std::size_t>((i + pick(random, 1, 3)) % 4)];
  return t;
}

double subnormal(Random& random) { return smallest * pick(random, -1000, 1000); }

/// Powers of two about every place where something under- or overflows: the coordinates themselves,
/// products of two and of three, and the range of double_double.
double critical_scale(Random& random) {
  const std::array<int, 8> exponents = {-1074, -1022, -537, -511, -358, -341, -306, 341};
  return std::ldexp(
      1.0, exponents[static_cast<std::size_t>(pick(random, 0, 7))] + pick(random, -20, 20));
}

struct Sweep {
  std::string name;
  int count;
  std::function<Tetrahedron(Random&)> next;
};

/// The counts keep the rationals within seconds; their cost grows with the spread of exponents.
std::vector<Sweep> sweeps() {
  return {
      {"uniform", 1000, uniform_points},
      {"nearly coplanar", 2000, nearly_coplanar},
      {"nearly coplanar, critical scales", 1000,
       [](Random& r) { return scaled(nearly_coplanar(r), critical_scale(r)); }},
      {"nearly coplanar, stretched axes", 1000,
       [](Random& r) {
         Tetrahedron t = nearly_coplanar(r);
         const dvec3 s{log_uniform(r, -90, 90), log_uniform(r, -90, 90), log_uniform(r, -90, 90)};
         for (dvec3& p : t) p *= s;
         return t;
       }},
      {"rotated grid, coplanar", 1000, exactly_coplanar_grid},
      {"opposite pairs, coplanar", 500, exactly_coplanar_pairs},
      {"unimodular", 1000, unimodular},
      {"unimodular, critical scales", 1000,
       [](Random& r) {
         // Down by 2^54 first: the scales are those of the largest coordinate.
         return scaled(scaled(unimodular(r), 0x1p-54), critical_scale(r));
       }},
      {"sizes 1e-300 .. 1e300", 200,
       [](Random& r) { return scaled(nearly_coplanar(r), log_uniform(r, -300, 300)); }},
      {"each coordinate 1e-20 .. 1e20", 500,
       [](Random& r) { return each_coordinate([&] { return log_uniform(r, -20, 20); }); }},
      {"each coordinate 1e-300 .. 1e300", 150,
       [](Random& r) { return each_coordinate([&] { return log_uniform(r, -300, 300); }); }},
      {"subnormal", 250, [](Random& r) { return each_coordinate([&] { return subnormal(r); }); }},
      {"subnormal among others", 250,
       [](Random& r) {
         return each_coordinate(
             [&] { return pick(r, 0, 1) == 0 ? subnormal(r) : log_uniform(r, -2, 2); });
       }},
      {"subnormal against huge", 150,
       [](Random& r) {
         Tetrahedron t = each_coordinate([&] { return subnormal(r); });
         const double size = log_uniform(r, 0, 300);
         for (dvec3& p : t) p.z = size * uniform(r, -1, 1);
         return t;
       }},
      {"largest", 250,
       [](Random& r) { return each_coordinate([&] { return largest * uniform(r, -1, 1); }); }},
      {"duplicates", 150, with_duplicates},
      {"axis plane", 250,
       [](Random& r) {
         Tetrahedron t = uniform_points(r);
         const int axis = pick(r, 0, 2);
         for (dvec3& p : t) p[axis] = t[0][axis];
         return t;
       }},
  };
}

/// Calls visit(tetrahedron) for every case of every sweep, the same ones each time.
template <class Visit>
void for_all(const Visit& visit) {
  Random random(1);
  for (const Sweep& sweep : sweeps()) {
    SCOPED_TRACE(sweep.name);
    for (int i = 0; i < sweep.count && !testing::Test::HasFailure(); ++i) {
      visit(sweep.next(random));
    }
  }
}

std::string text(const Tetrahedron& t) {
  std::string result;
  for (const dvec3& p : t) {
    std::array<char, 120> line;
    std::snprintf(line.data(), line.size(), "(%a, %a, %a)\n", p.x, p.y, p.z);
    result += line.data();
  }
  return result;
}

Sign orientation_of(const Tetrahedron& t) { return orientation(t[0], t[1], t[2], t[3]); }

Sign rational_orientation(const Tetrahedron& t) {
  return rational_sign(rational_determinant(t[0], t[1], t[2], t[3]));
}

dvec2 projected(const dvec3& p) { return {p.x, p.y}; }

// ---- orientation, in space ----

TEST(Orientation, PositiveWhereTheCrossProductPoints) {
  const dvec3 o(0), x(1, 0, 0), y(0, 1, 0);
  EXPECT_EQ(orientation(o, x, y, dvec3(5, -7, 1)), Sign::positive);
  EXPECT_EQ(orientation(o, x, y, dvec3(5, -7, -1)), Sign::negative);
  EXPECT_EQ(orientation(o, x, y, dvec3(5, -7, 0)), Sign::zero);
}

TEST(Orientation, SmallestAndLargestNumbers) {
  const dvec3 o(0), x(largest, 0, 0), y(0, largest, 0);
  EXPECT_EQ(orientation(o, x, y, dvec3(-largest, -largest, smallest)), Sign::positive);
  EXPECT_EQ(orientation(o, x, y, dvec3(-largest, -largest, -smallest)), Sign::negative);
  EXPECT_EQ(orientation(-x, x, y, dvec3(0, -largest, smallest)), Sign::positive);
  EXPECT_EQ(orientation(-x, x, y, dvec3(0, -largest, 0)), Sign::zero);
  const dvec3 tiny_x(smallest, 0, 0), tiny_y(0, smallest, 0), tiny_z(0, 0, smallest);
  EXPECT_EQ(orientation(o, tiny_x, tiny_y, tiny_z), Sign::positive);
  EXPECT_EQ(orientation(o, tiny_y, tiny_x, tiny_z), Sign::negative);
  EXPECT_EQ(orientation(tiny_x, tiny_y, tiny_z, o), Sign::negative);
}

TEST(Orientation, CoincidentAndCollinearPointsAreZero) {
  const dvec3 a(0.1, 0.2, 0.3), b(1e300, -2, 1e-300), c(7, 1e-9, 0.7);
  EXPECT_EQ(orientation(a, a, a, a), Sign::zero);
  EXPECT_EQ(orientation(a, a, b, c), Sign::zero);
  EXPECT_EQ(orientation(a, b, a, c), Sign::zero);
  EXPECT_EQ(orientation(a, b, c, a), Sign::zero);
  EXPECT_EQ(orientation(a, b, b, c), Sign::zero);
  EXPECT_EQ(orientation(a, b, c, b), Sign::zero);
  EXPECT_EQ(orientation(a, b, c, c), Sign::zero);
  EXPECT_EQ(orientation(-b, dvec3(0), b, c), Sign::zero);
  EXPECT_EQ(orientation(dvec3(0.0), dvec3(-0.0), b, c), Sign::zero);
}

TEST(Orientation, AgreesWithRationals) {
  Random random(1);
  std::array<long, 3> total = {};
  std::printf("%-36s %8s %8s %8s   coplanar\n", "stage that settles it", "double", "double^2",
              "integer");
  for (const Sweep& sweep : sweeps()) {
    std::array<long, 3> used = {};
    int zeros = 0;
    for (int i = 0; i < sweep.count; ++i) {
      const Tetrahedron t = sweep.next(random);
      const Sign expected = rational_orientation(t);
      ASSERT_EQ(orientation_of(t), expected) << sweep.name << "\n" << text(t);
      ++used[static_cast<std::size_t>(orientation_stage(t[0], t[1], t[2], t[3]))];
      zeros += expected == Sign::zero;
    }
    std::printf("%-36s %8ld %8ld %8ld   %d\n", sweep.name.c_str(), used[0], used[1], used[2],
                zeros);
    for (std::size_t i = 0; i < 3; ++i) total[i] += used[i];
    if (sweep.name == "uniform") {
      EXPECT_GE(used[0], sweep.count - 5);
    }
    if (sweep.name == "unimodular") {
      EXPECT_GE(used[2], sweep.count - 5);
    }
  }
  for (long count : total) EXPECT_GE(count, 500);
}

TEST(Orientation, PermutationsChangeTheSignByTheirParity) {
  // Each permutation takes another anchor and other products through the stages.
  for_all([](const Tetrahedron& t) {
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    const Sign expected = orientation_of(t);
    do {
      int inversions = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
      }
      const Sign sign = orientation(t[order[0]], t[order[1]], t[order[2]], t[order[3]]);
      ASSERT_EQ(inversions % 2 == 0 ? sign : -sign, expected) << text(t);
    } while (std::next_permutation(order.begin(), order.end()));
  });
}

TEST(Orientation, MirrorTurnsTheSignAndCyclicAxesKeepIt) {
  for_all([](const Tetrahedron& t) {
    const Sign expected = orientation_of(t);
    Tetrahedron mirrored = t;
    Tetrahedron cycled = t;
    for (std::size_t i = 0; i < 4; ++i) {
      mirrored[i].y = -t[i].y;
      cycled[i] = {t[i].y, t[i].z, t[i].x};
    }
    ASSERT_EQ(orientation_of(mirrored), -expected) << text(t);
    ASSERT_EQ(orientation_of(cycled), expected) << text(t);
  });
}

TEST(Orientation, ExactTranslationAndScalingKeepTheSign) {
  Random random(2);
  std::array<int, 3> seen = {};
  for (int i = 0; i < 10'000; ++i) {
    // Large enough that floating point cannot separate the nearly coplanar; exact when moved.
    const dvec3 a = grid_point(random, 1 << 30);
    const dvec3 u = grid_point(random, 1 << 30);
    const dvec3 v = grid_point(random, 1 << 30);
    const Tetrahedron t = {a, a + u, a + v, a + u + v + grid_point(random, 1) * 0.25};
    const Sign expected = orientation_of(t);
    const dvec3 shift = grid_point(random, 1 << 30) * 0x1p10;
    Tetrahedron moved = t;
    for (dvec3& p : moved) p += shift;
    ASSERT_EQ(orientation_of(moved), expected) << text(t);
    for (double factor : {0x1p-900, 0x1p-400, 0x1p-300, 0x1p300, 0x1p900}) {
      ASSERT_EQ(orientation_of(scaled(moved, factor)), expected) << text(t) << factor;
    }
    ++seen[static_cast<std::size_t>(static_cast<int>(expected) + 1)];
  }
  for (int count : seen) EXPECT_GT(count, 300);
}

TEST(Orientation, PlainDoublesWouldBeWrong) {
  // What the later stages are for: the same formula without them, and without a bound.
  Random random(3);
  int wrong_sign = 0;
  int wrong_zero = 0;
  for (int i = 0; i < 3000; ++i) {
    const Tetrahedron t = i % 2 == 0 ? nearly_coplanar(random) : unimodular(random);
    const dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double value = glm::dot(n, t[3] - t[0]);
    const Sign expected = rational_orientation(t);
    ASSERT_EQ(orientation_of(t), expected) << text(t);
    wrong_sign += value * static_cast<int>(expected) < 0;
    wrong_zero += (value == 0) != (expected == Sign::zero);
  }
  std::printf("wrong by plain doubles: %d signs, %d zeros of 3000\n", wrong_sign, wrong_zero);
  EXPECT_GT(wrong_sign, 100);
  EXPECT_GT(wrong_zero, 100);
}

// ---- orientation, in the plane ----

TEST(PlanarOrientation, PositiveIfCounterClockwise) {
  EXPECT_EQ(orientation(dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)), Sign::positive);
  EXPECT_EQ(orientation(dvec2(0, 0), dvec2(0, 1), dvec2(1, 0)), Sign::negative);
  EXPECT_EQ(orientation(dvec2(0, 0), dvec2(1, 3), dvec2(-2, -6)), Sign::zero);
  EXPECT_EQ(orientation(dvec2(0, 0), dvec2(largest, 0), dvec2(-largest, smallest)), Sign::positive);
  EXPECT_EQ(orientation(dvec2(0, 0), dvec2(smallest, 0), dvec2(0, smallest)), Sign::positive);
  EXPECT_EQ(orientation(dvec2(-largest, 0), dvec2(largest, 0), dvec2(0, smallest)), Sign::positive);
}

/// Triangles from the sweeps: as they come, and with a third point that is made collinear, with
/// rounding and without.
template <class Visit>
void for_all_triangles(const Visit& visit) {
  for_all([&](const Tetrahedron& t) {
    const dvec2 a = projected(t[0]);
    const dvec2 b = projected(t[1]);
    ASSERT_NO_FATAL_FAILURE(visit(a, b, projected(t[2])));
    ASSERT_NO_FATAL_FAILURE(visit(a, b, 0.5 * a + 0.5 * b));
    ASSERT_NO_FATAL_FAILURE(visit(a, b, 0.25 * a + 0.75 * b));
    ASSERT_NO_FATAL_FAILURE(visit(a, -a, b * smallest));
    ASSERT_NO_FATAL_FAILURE(visit(a, b, a));
  });
}

TEST(PlanarOrientation, AgreesWithRationals) {
  std::array<long, 3> used = {};
  for_all_triangles([&](const dvec2& a, const dvec2& b, const dvec2& c) {
    const cpp_rational ax = a.x, ay = a.y;
    const cpp_rational determinant = (cpp_rational(b.x) - ax) * (cpp_rational(c.y) - ay) -
                                     (cpp_rational(b.y) - ay) * (cpp_rational(c.x) - ax);
    ASSERT_EQ(orientation(a, b, c), rational_sign(determinant))
        << text({dvec3(a, 0), dvec3(b, 0), dvec3(c, 0), dvec3(0)});
    ++used[static_cast<std::size_t>(orientation_stage(a, b, c))];
  });
  std::printf("stage that settles it: double %ld, double^2 %ld, integer %ld\n", used[0], used[1],
              used[2]);
  for (long count : used) EXPECT_GE(count, 500);
}

TEST(PlanarOrientation, PermutationsChangeTheSignByTheirParity) {
  for_all_triangles([](const dvec2& a, const dvec2& b, const dvec2& c) {
    const Sign expected = orientation(a, b, c);
    ASSERT_EQ(orientation(b, c, a), expected);
    ASSERT_EQ(orientation(c, a, b), expected);
    ASSERT_EQ(orientation(b, a, c), -expected);
    ASSERT_EQ(orientation(a, c, b), -expected);
    ASSERT_EQ(orientation(c, b, a), -expected);
  });
}

// ---- collinear ----

TEST(Collinear, CoincidentPoints) {
  const dvec3 a(0.1, 1e300, 1e-300), b(-7, 0.3, 1e10);
  EXPECT_TRUE(collinear(a, a, a));
  EXPECT_TRUE(collinear(a, a, b));
  EXPECT_TRUE(collinear(a, b, a));
  EXPECT_TRUE(collinear(b, a, a));
}

TEST(Collinear, OneUlpOffEachAxis) {
  const dvec3 a(3, 5, 7);
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 off = 5.0 * a;
    off[axis] = std::nextafter(off[axis], 0.0);
    EXPECT_TRUE(collinear(a, 3.0 * a, 5.0 * a));
    EXPECT_FALSE(collinear(a, 3.0 * a, off));
    dvec3 tip(0);
    tip[axis] = smallest;
    dvec3 far(0);
    far[(axis + 1) % 3] = largest;
    EXPECT_TRUE(collinear(-far, dvec3(0), far));
    EXPECT_FALSE(collinear(-far, tip, far));
  }
}

TEST(Collinear, AgreesWithRationals) {
  std::array<int, 2> seen = {};
  for_all([&](const Tetrahedron& t) {
    for (const dvec3& c : {t[2], 0.5 * t[0] + 0.5 * t[1], -t[0]}) {
      const Rational3 n =
          rational_cross(rational_difference(t[1], t[0]), rational_difference(c, t[0]));
      const bool expected = n[0] == 0 && n[1] == 0 && n[2] == 0;
      ASSERT_EQ(collinear(t[0], t[1], c), expected) << text(t);
      ASSERT_EQ(collinear(c, t[0], t[1]), expected) << text(t);
      ++seen[expected];
    }
  });
  EXPECT_GT(seen[0], 500);
  EXPECT_GT(seen[1], 200);
}

// ---- PlaneSide ----

dvec3 extent_of(const Tetrahedron& t) { return glm::abs(t[3] - t[0]); }

TEST(PlaneSide, IsOrientation) {
  for_all([](const Tetrahedron& t) {
    const Sign expected = orientation_of(t);
    const dvec3 extent = extent_of(t);
    ASSERT_EQ(PlaneSide(t[0], t[1], t[2], extent).side(t[3]), expected) << text(t);
    ASSERT_EQ(PlaneSide(t[0], t[1], t[2], extent * 1e3).side(t[3]), expected) << text(t);
  });
}

TEST(PlaneSide, IsOrientationBeyondTheExtentToo) {
  for_all([](const Tetrahedron& t) {
    const Sign expected = orientation_of(t);
    const dvec3 extent = extent_of(t);
    ASSERT_EQ(PlaneSide(t[0], t[1], t[2], dvec3(0)).side(t[3]), expected) << text(t);
    ASSERT_EQ(PlaneSide(t[0], t[1], t[2], extent * 1e-9).side(t[3]), expected) << text(t);
    ASSERT_EQ(PlaneSide(t[0], t[1], t[2], {extent.x, extent.y, 0}).side(t[3]), expected) << text(t);
  });
}

TEST(PlaneSide, CollinearPlaneHasEveryPointOnIt) {
  const dvec3 a(0.1, 0.2, 0.3);
  const PlaneSide plane(a, -a, 4.0 * a, dvec3(1e3));
  Random random(4);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(plane.side(random_point(random)), Sign::zero);
}

TEST(PlaneSide, DeterminantIsWithinItsBound) {
  // The bound is 9 rounding units of the largest products; what is reached is far less, since
  // eight roundings seldom conspire. Needles, whose minors cancel, come closest.
  double worst = 0;
  Random random(5);
  const auto measure = [&](const Tetrahedron& t) {
    const PlaneSide plane(t[0], t[1], t[2], extent_of(t));
    if (std::isinf(plane.determinant_bound())) return;
    const cpp_rational error =
        abs(rational_determinant(t[0], t[1], t[2], t[3]) - cpp_rational(plane.determinant(t[3])));
    const cpp_rational bound = plane.determinant_bound();
    ASSERT_LE(error, bound) << text(t);
    worst = std::max(worst, static_cast<double>(cpp_rational(error / bound)));
  };
  for_all(measure);
  for (int i = 0; i < 3000; ++i) {
    Tetrahedron t = nearly_coplanar(random);
    t[2] = t[0] + uniform(random, 0.5, 2) * (t[1] - t[0]) + random_point(random) * 1e-9;
    measure(t);
  }
  std::printf("largest error / bound: %.3f\n", worst);
  EXPECT_GT(worst, 0.1);
}

TEST(PlaneSide, OnePlaneAndManyPoints) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const dvec3 a = random_point(random);
    const dvec3 b = random_point(random);
    const dvec3 c = random_point(random);
    const PlaneSide plane(a, b, c, dvec3(2));
    int settled = 0;
    for (int j = 0; j < 100; ++j) {
      const dvec3 p = random_point(random);
      const dvec3 q =
          a + uniform(random, -0.3, 0.3) * (b - a) + uniform(random, -0.3, 0.3) * (c - a);
      ASSERT_EQ(plane.side(p), orientation(a, b, c, p)) << text({a, b, c, p});
      ASSERT_EQ(plane.side(q), orientation(a, b, c, q)) << text({a, b, c, q});
      settled += std::abs(plane.determinant(p)) > plane.determinant_bound();
    }
    EXPECT_GE(settled, 99);
  }
}

TEST(PlaneSide, BoundIsAFewRoundingUnits) {
  const dvec3 a(0.1, 0.2, 0.3), b(0.9, -0.3, 0.1), c(-0.2, 0.8, -0.4);
  const PlaneSide plane(a, b, c, dvec3(2));
  const double undecided_distance = plane.determinant_bound() / glm::length(plane.normal());
  EXPECT_LT(undecided_distance, 1e-14);
  const dvec3 above = (a + b + c) / 3.0 + glm::normalize(plane.normal()) * 1e-14;
  EXPECT_GT(plane.determinant(above), plane.determinant_bound());
  EXPECT_EQ(plane.side(above), Sign::positive);
}

TEST(PlaneSide, HugeCoordinatesHaveNoBound) {
  const dvec3 a(largest, 0, 0), b(0, largest, 0), c(0, 0, largest);
  const PlaneSide plane(a, b, c, dvec3(largest, 0, 0));
  EXPECT_TRUE(std::isinf(plane.determinant_bound()));
  EXPECT_EQ(plane.side(dvec3(0)), Sign::negative);
  EXPECT_EQ(plane.side(dvec3(largest, largest, largest)), Sign::positive);
  EXPECT_EQ(plane.side(b), Sign::zero);
}

}  // namespace
}  // namespace taut
