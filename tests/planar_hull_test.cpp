#include "taut/hull/planar/planar_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "models.h"
#include "taut/core/error.h"
#include "taut/core/stopwatch.h"
#include "taut/hull/planar/planar_arcs.h"
#include "taut/hull/planar/planar_tree.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

using Curve = std::vector<dvec3>;
using Curves = std::vector<Curve>;
using Points = std::vector<dvec2>;
using real = long double;

/// An arc of less than half a circle.
Curve circular(const dvec2& center, double radius, double from, double to) {
  const double w = std::cos((to - from) / 2);
  const double middle = (from + to) / 2;
  const auto at = [&](double angle, double r) {
    return center + r * dvec2(std::cos(angle), std::sin(angle));
  };
  return {dvec3(at(from, radius), 1), dvec3(w * at(middle, radius / w), w),
          dvec3(at(to, radius), 1)};
}

void add_circle(Curves& curves, const dvec2& center, double radius) {
  for (int k = 0; k < 4; ++k) {
    curves.push_back(circular(center, radius, k * pi / 2, (k + 1) * pi / 2));
  }
}

Curve polynomial(const Points& control) {
  Curve curve;
  curve.reserve(control.size());
  for (const dvec2& p : control) curve.emplace_back(p, 1);
  return curve;
}

struct LongPoint {
  real x, y;
};

LongPoint at(const Curve& curve, real t) {
  std::vector<std::array<real, 3>> b;
  b.reserve(curve.size());
  for (const dvec3& p : curve) b.push_back({p.x, p.y, p.z});
  for (std::size_t last = b.size() - 1; last > 0; --last) {
    for (std::size_t i = 0; i < last; ++i) {
      for (std::size_t c = 0; c < 3; ++c) b[i][c] = (1 - t) * b[i][c] + t * b[i + 1][c];
    }
  }
  return {b[0][0] / b[0][2], b[0][1] / b[0][2]};
}

/// A part of a curve, sampled.
class Sampled {
 public:
  Sampled(const Curve& curve, real from, real to) : curve_(curve), from_(from), to_(to) {
    samples_.reserve(count + 1);
    for (int k = 0; k <= count; ++k) samples_.push_back(at(curve, from + (to - from) * k / count));
  }

  /// The largest height, or a smaller one where it is below `least`: samples that are higher than
  /// their neighbours, refined.
  real height(const dvec2& n, real least) const {
    std::vector<real> heights;
    heights.reserve(samples_.size());
    for (const LongPoint& p : samples_) heights.push_back(p.x * n.x + p.y * n.y);
    // No curve here rises more from a sample.
    constexpr real room = 0.01;
    least = std::max(least, *std::max_element(heights.begin(), heights.end())) - room;
    real best = least;
    for (int k = 0; k <= count; ++k) {
      const real h = heights[std::size_t(k)];
      if (h < least || h < heights[std::size_t(std::max(k - 1, 0))] ||
          h < heights[std::size_t(std::min(k + 1, count))]) {
        continue;
      }
      best = std::max(
          {best, h,
           refined(n, real(std::max(k - 1, 0)) / count, real(std::min(k + 1, count)) / count)});
    }
    return best;
  }

 private:
  /// By golden sections.
  real refined(const dvec2& n, real lower, real upper) const {
    const auto value = [&](real s) {
      const LongPoint p = at(curve_, from_ + (to_ - from_) * s);
      return p.x * n.x + p.y * n.y;
    };
    const real share = (std::sqrt(real(5)) - 1) / 2;
    for (int step = 0; step < 28; ++step) {
      const real s = upper - share * (upper - lower);
      const real t = lower + share * (upper - lower);
      if (value(s) > value(t)) {
        upper = t;
      } else {
        lower = s;
      }
    }
    return std::max(value(lower), value(upper));
  }

  static constexpr int count = 160;
  const Curve& curve_;
  real from_;
  real to_;
  std::vector<LongPoint> samples_;
};

real height(const Points& corners, const std::vector<Sampled>& parts, const dvec2& n) {
  real best = -10;
  for (const dvec2& p : corners) best = std::max(best, real(p.x) * n.x + real(p.y) * n.y);
  for (const Sampled& part : parts) best = std::max(best, part.height(n, best));
  return best;
}

/// Corners lie where they say, sides begin in them, and the support agrees in many directions.
void expect_hull(const PlanarHull& hull, const Points& points, const Curves& curves,
                 int directions = 200) {
  EXPECT_TRUE(hull.verified);
  for (std::size_t k = 0; k < hull.sides.size(); ++k) {
    const OutlineSide& s = hull.sides[k];
    ASSERT_NE(s.point < 0, s.curve < 0);
    const auto is_at = [&](const dvec2& x, int curve, double t) {
      const LongPoint p = at(curves[std::size_t(curve)], t);
      EXPECT_LT(std::hypot(p.x - x.x, p.y - x.y), curve == s.curve ? 1e-14 : 1e-10);
    };
    if (s.point >= 0) {
      EXPECT_EQ(s.x, points[std::size_t(s.point)]);
    }
    if (s.curve >= 0) is_at(s.x, s.curve, s.t);
    if (s.along < 0) continue;
    is_at(s.x, s.along, s.from);
    is_at(hull.sides[(k + 1) % hull.sides.size()].x, s.along, s.to);
  }
  Points corners;
  std::vector<Sampled> parts;
  corners.reserve(hull.sides.size());
  parts.reserve(hull.sides.size());
  for (const OutlineSide& s : hull.sides) {
    corners.push_back(s.x);
    if (s.along >= 0) parts.emplace_back(curves[std::size_t(s.along)], s.from, s.to);
  }
  std::vector<Sampled> whole;
  whole.reserve(curves.size());
  for (const Curve& c : curves) whole.emplace_back(c, 0, 1);
  for (int k = 0; k < directions; ++k) {
    const double angle = 2 * pi * (k + 0.123) / directions;
    const dvec2 n(std::cos(angle), std::sin(angle));
    EXPECT_NEAR(double(height(corners, parts, n) - height(points, whole, n)), 0, 1e-12) << angle;
  }
}

int curved_sides(const PlanarHull& hull) {
  return int(std::count_if(hull.sides.begin(), hull.sides.end(),
                           [](const OutlineSide& s) { return s.along >= 0; }));
}

TEST(PlanarHull, NothingAndPoints) {
  EXPECT_TRUE(planar_hull({}, {}).sides.empty());
  const Points one(3, dvec2(0.5, -0.25));
  const PlanarHull point = planar_hull(one, {});
  ASSERT_EQ(point.sides.size(), 1U);
  EXPECT_EQ(point.sides[0].point, 0);
  const Points line = {{0, 0}, {0.5, 0.25}, {1, 0.5}, {0.25, 0.125}};
  EXPECT_EQ(planar_hull(line, {}).sides.size(), 2U);
  const Points square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.3}, {0.5, 0.5}, {1, 1}};
  const PlanarHull hull = planar_hull(square, {});
  EXPECT_EQ(hull.sides.size(), 4U);
  expect_hull(hull, square, {});
}

/// All of many points are corners, each of which asks for all points.
TEST(PlanarHull, StopsWhenAsked) {
  constexpr int count = 50'000;
  Points circle;
  for (int k = 0; k < count; ++k)
    circle.push_back({std::cos(2 * pi * k / count), std::sin(2 * pi * k / count)});
  std::stop_source stop;
  Stopwatch watch;
  const std::jthread asks([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    watch.lap();
    stop.request_stop();
  });
  EXPECT_THROW(planar_hull(circle, {}, stop.get_token()), Cancelled);
  EXPECT_LT(watch.lap(), 0.2);
}

TEST(PlanarHull, CircleOfFourArcs) {
  Curves curves;
  add_circle(curves, {0.1, -0.2}, 0.7);
  const PlanarHull hull = planar_hull({}, curves);
  EXPECT_EQ(hull.sides.size(), 4U);
  EXPECT_EQ(curved_sides(hull), 4);
  for (const OutlineSide& s : hull.sides) {
    EXPECT_EQ(s.from, 0);
    EXPECT_EQ(s.to, 1);
  }
  expect_hull(hull, {}, curves);
}

TEST(PlanarHull, CircleAndPoint) {
  Curves curves;
  add_circle(curves, {0, 0}, 0.5);
  const Points points = {{1.3, 0}};
  const PlanarHull hull = planar_hull(points, curves);
  expect_hull(hull, points, curves);
  ASSERT_EQ(hull.sides.size(), 6U);
  const double x = 0.25 / 1.3;
  for (const double y : {std::sqrt(0.25 - x * x), -std::sqrt(0.25 - x * x)}) {
    EXPECT_TRUE(std::any_of(hull.sides.begin(), hull.sides.end(), [&](const OutlineSide& s) {
      return glm::distance(s.x, dvec2(x, y)) < 1e-14;
    }));
  }
}

TEST(PlanarHull, TwoCircles) {
  for (const double r : {0.5, 0.3, 0.01}) {
    Curves curves;
    add_circle(curves, {0, 0}, 0.5);
    add_circle(curves, {1.2, 0}, r);
    const PlanarHull hull = planar_hull({}, curves);
    expect_hull(hull, {}, curves);
    // The bitangent's normal makes this angle with the line of the centres.
    const double c = (0.5 - r) / 1.2;
    const double s = std::sqrt(1 - c * c);
    int found = 0;
    for (const OutlineSide& side : hull.sides) {
      for (const double sign : {1.0, -1.0}) {
        found += int(glm::distance(side.x, 0.5 * dvec2(c, sign * s)) < 1e-14);
        found += int(glm::distance(side.x, dvec2(1.2, 0) + r * dvec2(c, sign * s)) < 1e-14);
      }
    }
    EXPECT_EQ(found, 4);
  }
}

TEST(PlanarHull, ParabolaAndHalfCircle) {
  const Curves parabola = {polynomial({{-1, 1}, {0, -1}, {1, 1}})};
  const PlanarHull cap = planar_hull({}, parabola);
  ASSERT_EQ(cap.sides.size(), 2U);
  expect_hull(cap, {}, parabola);
  const Curves half = {circular({0, 0}, 1, 0, pi / 2), circular({0, 0}, 1, pi / 2, pi)};
  const PlanarHull hull = planar_hull({}, half);
  EXPECT_EQ(hull.sides.size(), 3U);
  EXPECT_EQ(curved_sides(hull), 2);
  expect_hull(hull, {}, half);
}

TEST(PlanarHull, ClosedCurve) {
  Curve curve = polynomial({{0, 0}, {1.5, 0}, {1.5, 1.5}, {-1.5, 1.5}, {-1.5, 0}, {0, 0}});
  for (int k = 0; k < 2; ++k) {
    const PlanarHull hull = planar_hull({}, Curves{curve});
    ASSERT_EQ(hull.sides.size(), 1U);
    EXPECT_EQ(hull.sides[0].from, k);
    EXPECT_EQ(hull.sides[0].to, 1 - k);
    expect_hull(hull, {}, {curve});
    std::reverse(curve.begin(), curve.end());
  }
}

TEST(PlanarHull, InflectionConcaveAndSelfBitangent) {
  const Curves bend = {polynomial({{-1, 0}, {-0.3, 1.5}, {0.3, -1.5}, {1, 0}})};
  expect_hull(planar_hull({}, bend), {}, bend);
  const Curves camel = {polynomial({{-1, 0}, {-0.9, 2}, {0, -2}, {0.9, 2}, {1, 0}})};
  const PlanarHull hull = planar_hull({}, camel);
  EXPECT_EQ(hull.sides.size(), 4U);
  expect_hull(hull, {}, camel);
  // A hollow square.
  const Curves hollow = {
      polynomial({{0, 0}, {0.5, 0.3}, {1, 0}}), polynomial({{1, 0}, {0.7, 0.5}, {1, 1}}),
      polynomial({{1, 1}, {0.5, 0.7}, {0, 1}}), polynomial({{0, 1}, {0.3, 0.5}, {0, 0}})};
  const PlanarHull square = planar_hull({}, hollow);
  EXPECT_EQ(square.sides.size(), 4U);
  EXPECT_EQ(curved_sides(square), 0);
  expect_hull(square, {}, hollow);
}

TEST(PlanarHull, Cusps) {
  // The derivative of the first is zero at 1/2.
  const Curves curves = {polynomial({{0, 0}, {1, 1}, {0, 1}, {1, 0}}),
                         polynomial({{0, -0.5}, {1, -0.5}, {1, -0.5}, {0, -1}})};
  for (const Curve& curve : curves) expect_hull(planar_hull({}, Curves{curve}), {}, {curve});
  expect_hull(planar_hull({}, curves), {}, curves);
}

TEST(PlanarHull, StraightCurves) {
  const Points points = {{0, 0}, {0.5, 1}};
  const Curves curves = {polynomial({{0, 0}, {0.2, 0}, {0.5, 0}}), polynomial({{0.5, 0}, {1, 0}}),
                         polynomial({{1, 0}, {0.5, 1}})};
  const PlanarHull hull = planar_hull(points, curves);
  ASSERT_EQ(hull.sides.size(), 3U);
  EXPECT_EQ(curved_sides(hull), 0);
  int named = 0;
  for (const OutlineSide& s : hull.sides) named += int(s.point >= 0);
  EXPECT_EQ(named, 2);
  expect_hull(hull, points, curves);
}

TEST(PlanarHull, Duplicates) {
  Curves curves;
  add_circle(curves, {0, 0}, 0.5);
  add_circle(curves, {0, 0}, 0.5);
  // Overlapping arcs, a circle that touches from inside, and points at joints.
  for (const double a : {0.3, 1.1, 2.9}) curves.push_back(circular({0, 0}, 0.5, a, a + 1.4));
  add_circle(curves, {0.25 * std::cos(0.7), 0.25 * std::sin(0.7)}, 0.25);
  const Points points = {{0.5, 0}, {0, 0.5}, {0.5, 0}};
  const PlanarHull hull = planar_hull(points, curves);
  EXPECT_LE(hull.sides.size(), 8U);
  EXPECT_EQ(std::size_t(curved_sides(hull)), hull.sides.size());
  expect_hull(hull, points, curves);
}

TEST(PlanarHull, SmallBumps) {
  // Small circles that are farther out than a large one, in few directions.
  for (int k = 0; k < 50; ++k) {
    const double angle = 0.11 * k + 0.013;
    const dvec2 n(std::cos(angle), std::sin(angle));
    const double out = 1e-7;
    Curves curves;
    add_circle(curves, {0, 0}, 1);
    add_circle(curves, (0.99 + out) * n, 0.01);
    const PlanarHull hull = planar_hull({}, curves);
    EXPECT_TRUE(std::any_of(hull.sides.begin(), hull.sides.end(), [](const OutlineSide& s) {
      return s.along >= 4;
    })) << k;
    expect_hull(hull, {}, curves, 10);
  }
}

TEST(PlanarHull, TouchedFromInside) {
  Curves curves;
  add_circle(curves, {0.4, 0.3}, 0.3);
  const Points points = {{-1, 0}, {1, 0}, {0, 1.5}};
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.1 * k;
    const auto turned = [&](const dvec2& p) {
      return dvec2(std::cos(angle) * p.x - std::sin(angle) * p.y,
                   std::sin(angle) * p.x + std::cos(angle) * p.y);
    };
    Points there;
    for (const dvec2& p : points) there.push_back(turned(p));
    Curves moved = curves;
    for (Curve& c : moved) {
      for (dvec3& p : c) p = dvec3(turned(dvec2(p)), p.z);
    }
    const PlanarHull hull = planar_hull(there, moved);
    EXPECT_EQ(hull.sides.size(), 3U) << k;
    EXPECT_TRUE(hull.verified);
  }
}

Curve wiggly(Random& random, int degree) {
  Curve curve;
  curve.reserve(std::size_t(degree) + 1);
  for (int i = 0; i <= degree; ++i) {
    const double w = log_uniform(random, 0.5, 2);
    const dvec2 x{uniform(random, -1, 1), uniform(random, -1, 1)};
    curve.emplace_back(w * x, w);
  }
  return curve;
}

TEST(PlanarHull, WigglyCurves) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Curves curves;
    for (int k = pick(random, 1, 3); k > 0; --k) curves.push_back(wiggly(random, 9));
    Points points;
    if (seed % 3 == 0) points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1));
    expect_hull(planar_hull(points, curves), points, curves, 1000 / int(curves.size()));
  }
}

/// Outlines have corners at the same places, but for where they begin.
void expect_same(const PlanarHull& a, const PlanarHull& b, double tolerance) {
  ASSERT_EQ(a.sides.size(), b.sides.size());
  for (const OutlineSide& s : a.sides) {
    EXPECT_TRUE(std::any_of(b.sides.begin(), b.sides.end(), [&](const OutlineSide& r) {
      return glm::distance(r.x, s.x) < tolerance;
    }));
  }
}

TEST(PlanarHull, Invariance) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Curves curves;
    for (int k = 0; k < 6; ++k) curves.push_back(wiggly(random, pick(random, 2, 9)));
    const PlanarHull hull = planar_hull({}, curves);
    const double scale = log_uniform(random, 1e-3, 1);
    const double angle = uniform(random, 0, 6);
    const dvec2 shift{uniform(random, -1, 1), uniform(random, -1, 1)};
    const auto moved = [&](const dvec2& p) {
      return shift + scale * dvec2(std::cos(angle) * p.x - std::sin(angle) * p.y,
                                   std::sin(angle) * p.x + std::cos(angle) * p.y);
    };
    Curves there(curves.rbegin(), curves.rend());
    for (Curve& c : there) {
      for (dvec3& p : c) p = dvec3(p.z * moved(dvec2(p) / p.z), p.z);
    }
    const PlanarHull other = planar_hull({}, there);
    EXPECT_TRUE(other.verified);
    PlanarHull expected = hull;
    for (OutlineSide& s : expected.sides) s.x = moved(s.x);
    expect_same(expected, other, 1e-11);
  }
}

TEST(PlanarHull, HundredsOfCurves) {
  Random random(5);
  Curves curves;
  for (int k = 0; k < 400; ++k) {
    const double a = uniform(random, 0, 6);
    const dvec2 center{uniform(random, -1, 1), uniform(random, -1, 1)};
    curves.push_back(circular(center, log_uniform(random, 1e-3, 0.3), a, a + 1.5));
  }
  expect_hull(planar_hull({}, curves), {}, curves, 20);
}

/// Circles all around another one: each has a straight side to the next.
TEST(PlanarHull, ThousandsOfCircles) {
  constexpr int count = 2000;
  Curves curves;
  for (int k = 0; k < count; ++k) {
    add_circle(curves, direction_at(2 * pi * (k + 0.3) / count), 1e-4);
  }
  const PlanarHull hull = planar_hull({}, curves);
  EXPECT_TRUE(hull.verified);
  EXPECT_EQ(std::count_if(hull.sides.begin(), hull.sides.end(),
                          [](const OutlineSide& s) { return s.along < 0; }),
            count);
}

/// All that reaches above a height is visited, and little else.
TEST(PlanarTree, VisitsWhatReachesAboveAHeight) {
  constexpr int count = 4096;
  std::vector<PlanarTree::Entry> entries;
  for (int k = 0; k < count; ++k) {
    const dvec2 x = direction_at(2 * pi * k / count);
    entries.push_back({k, PlanarBox({0.999 * x, x})});
  }
  const PlanarTree tree(entries);
  for (const double angle : {0.1, 1.7, 3.3, 5.9}) {
    const dvec2 n = direction_at(angle);
    std::vector<int> seen;
    tree.visit(n, 0.99, [&](int k) {
      seen.push_back(k);
      return 0.99;
    });
    std::sort(seen.begin(), seen.end());
    std::vector<int> expected;
    for (const PlanarTree::Entry& e : entries) {
      if (e.box.height(n) > 0.99) expected.push_back(e.number);
    }
    EXPECT_EQ(seen, expected);
    int visited = 0;
    double highest = -2;
    tree.visit(n, highest, [&](int k) {
      ++visited;
      return highest = std::max(highest, glm::dot(n, direction_at(2 * pi * k / count)));
    });
    EXPECT_NEAR(highest, 1, 1e-6);
    EXPECT_LT(visited, 64);
  }
  PlanarTree().visit({1, 0}, -1, [](int) -> double { throw std::logic_error("there is none"); });
}

}  // namespace
}  // namespace taut
