#include "taut/surface/nurbs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "error_checks.h"
#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using taut_test::expect_invalid;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Knots = std::vector<double>;

/// B-spline basis function i of a degree by the recurrence of Cox and de Boor, on the polynomial of
/// one knot span, so that the ends of the span need no convention.
long double basis(const Knots& knots, std::size_t span, std::size_t i, int degree, long double t) {
  if (degree == 0) return i == span ? 1 : 0;
  const auto term = [&](long double numerator, long double denominator, std::size_t k) {
    return denominator == 0 ? 0 : numerator / denominator * basis(knots, span, k, degree - 1, t);
  };
  const long double a = knots[i];
  const long double b = knots[i + to_size(degree)];
  const long double c = knots[i + 1];
  const long double d = knots[i + to_size(degree) + 1];
  return term(t - a, b - a, i) + term(d - t, d - c, i + 1);
}

/// The span that begins at a parameter.
std::size_t span_at(const Knots& knots, double begin) {
  return static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), begin) -
                                  knots.begin()) -
         1;
}

using Homogeneous = std::array<long double, 4>;

/// Sum of basis functions over a grid of points; a curve is a grid of one column.
Homogeneous reference(const NurbsSurface& s, const PatchPiece& piece, long double u,
                      long double v) {
  const std::size_t span_u = span_at(s.knots_u, piece.u.lower);
  const std::size_t span_v = span_at(s.knots_v, piece.v.lower);
  Homogeneous sum = {};
  for (std::size_t i = span_u - to_size(s.degree_u); i <= span_u; ++i) {
    for (std::size_t j = span_v - to_size(s.degree_v); j <= span_v; ++j) {
      const long double b =
          basis(s.knots_u, span_u, i, s.degree_u, u) * basis(s.knots_v, span_v, j, s.degree_v, v);
      const dvec4& p = s.points[i * to_size(s.count_v()) + j];
      for (int k = 0; k < 4; ++k) sum[to_size(k)] += b * p[k];
    }
  }
  return sum;
}

Homogeneous reference(const NurbsCurve& curve, const CurvePiece& piece, long double t) {
  const std::size_t span = span_at(curve.knots, piece.t.lower);
  Homogeneous sum = {};
  for (std::size_t i = span - to_size(curve.degree); i <= span; ++i) {
    const long double b = basis(curve.knots, span, i, curve.degree, t);
    for (int k = 0; k < 4; ++k) sum[to_size(k)] += b * curve.points[i][k];
  }
  return sum;
}

dvec3 euclidean_of(const Homogeneous& x) {
  return {static_cast<double>(x[0] / x[3]), static_cast<double>(x[1] / x[3]),
          static_cast<double>(x[2] / x[3])};
}

class RandomNurbs {
 public:
  explicit RandomNurbs(unsigned seed) : engine_(seed) {}
  double operator()(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  int integer(int lower, int upper) {
    return std::uniform_int_distribution<int>(lower, upper)(engine_);
  }
  std::vector<dvec4> points(std::size_t count) {
    std::vector<dvec4> result(count);
    for (dvec4& p : result) {
      p = homogeneous(dvec3((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)), (*this)(0.5, 2));
    }
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

/// A knot vector of every kind there is.
Knots random_knots(RandomNurbs& random, int degree) {
  enum { clamped, unclamped, loose };
  const int kind = random.integer(clamped, loose);
  Knots knots;
  double t = random(-10, 10);
  const auto step = [&] { t += std::exp2(random(-8, 2)); };
  const auto append = [&](int multiplicity) {
    for (int k = 0; k < multiplicity; ++k) knots.push_back(t);
    step();
  };
  // `loose`: an end of a multiplicity between those of the two usual forms.
  const int end = kind == clamped ? degree + 1 : random.integer(1, degree);
  if (kind == unclamped) {
    for (int k = 0; k <= degree; ++k) append(1);
  } else {
    for (int k = degree + 1 - end; k > 0; --k) append(1);
    append(end);
  }
  for (int k = random.integer(0, 5); k > 0; --k) append(random.integer(1, degree + 1));
  if (kind == unclamped) {
    for (int k = 0; k <= degree; ++k) append(1);
  } else {
    append(end);
    for (int k = degree + 1 - end; k > 0; --k) append(1);
  }
  return knots;
}

/// The sum of products of basis functions in [0, 1] is stable; what remains is the blossoms' and
/// the Bernstein sums' rounding.
double rounding(int degree) { return 32 * rounding_unit * degree; }

void expect_within(const dvec3& a, const dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance) << "(" << a.x << ", " << a.y << ", " << a.z << ") and ("
                                           << b.x << ", " << b.y << ", " << b.z << ")";
}

/// The curve's pieces cover its domain without gap, and are the curve.
void check(const NurbsCurve& curve) {
  ASSERT_NO_THROW(validate(curve, "curve"));
  const std::vector<CurvePiece> pieces = decompose(curve);
  ASSERT_FALSE(pieces.empty());
  EXPECT_EQ(pieces.front().t.lower, curve.domain().lower);
  EXPECT_EQ(pieces.back().t.upper, curve.domain().upper);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (k > 0) {
      EXPECT_EQ(pieces[k].t.lower, pieces[k - 1].t.upper);
    }
    ASSERT_LT(pieces[k].t.lower, pieces[k].t.upper);
    ASSERT_EQ(pieces[k].bezier.degree(), curve.degree);
    EXPECT_NO_THROW(validate(pieces[k].bezier, "piece"));
    for (int i = 0; i <= 8; ++i) {
      const double s = i / 8.0;
      const long double t =
          pieces[k].t.lower + s * (static_cast<long double>(pieces[k].t.upper) - pieces[k].t.lower);
      SCOPED_TRACE(testing::Message()
                   << "degree " << curve.degree << " piece " << k << " at " << s);
      expect_within(point(pieces[k].bezier, s), euclidean_of(reference(curve, pieces[k], t)),
                    rounding(curve.degree));
    }
  }
}

NurbsCurve curve_on(RandomNurbs& random, int degree, const Knots& knots) {
  return {degree, knots, random.points(knots.size() - to_size(degree) - 1)};
}

NurbsSurface surface_on(RandomNurbs& random, int degree_u, int degree_v, const Knots& u,
                        const Knots& v) {
  const std::size_t count = (u.size() - to_size(degree_u) - 1) * (v.size() - to_size(degree_v) - 1);
  return {degree_u, degree_v, u, v, random.points(count)};
}

/// Derivatives with respect to the original parameter agree up to an order at every inner knot.
void expect_continuous(const NurbsCurve& curve, int order) {
  const std::vector<CurvePiece> pieces = decompose(curve);
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const CurveJet a = jet(pieces[k - 1].bezier, 1);
    const CurveJet b = jet(pieces[k].bezier, 0);
    const double da = pieces[k - 1].t.upper - pieces[k - 1].t.lower;
    const double db = pieces[k].t.upper - pieces[k].t.lower;
    const std::array<dvec3, 4> left = {a.c, a.ct, a.ctt, a.cttt};
    const std::array<dvec3, 4> right = {b.c, b.ct, b.ctt, b.cttt};
    for (int d = 0; d <= order; ++d) {
      const dvec3 l = left[to_size(d)] / std::pow(da, d);
      const dvec3 r = right[to_size(d)] / std::pow(db, d);
      SCOPED_TRACE(testing::Message() << "knot " << pieces[k].t.lower << " derivative " << d);
      expect_within(l, r, 1e-9 * (1 + glm::length(l)));
    }
  }
}

NurbsCurve circle() {
  const double w = std::numbers::sqrt2 / 2;
  NurbsCurve curve{2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {}};
  const std::array<dvec2, 9> corners = {dvec2(1, 0),  dvec2(1, 1),  dvec2(0, 1),
                                        dvec2(-1, 1), dvec2(-1, 0), dvec2(-1, -1),
                                        dvec2(0, -1), dvec2(1, -1), dvec2(1, 0)};
  for (std::size_t i = 0; i < 9; ++i) {
    curve.points.push_back(homogeneous(dvec3(corners[i], 0), i % 2 == 0 ? 1 : w));
  }
  return curve;
}

TEST(Nurbs, ClampedCurve) {
  RandomNurbs random(1);
  check(curve_on(random, 1, {0, 0, 1, 1}));
  check(curve_on(random, 2, {0, 0, 0, 1, 3, 3, 3}));
  check(curve_on(random, 3, {-1, -1, -1, -1, 0, 0.5, 0.75, 8, 8, 8, 8}));
  check(curve_on(random, 5, {0, 0, 0, 0, 0, 0, 1e-3, 1, 1, 1, 1, 1, 1}));
}

TEST(Nurbs, UnclampedCurve) {
  RandomNurbs random(2);
  check(curve_on(random, 1, {0, 1, 3, 4}));
  check(curve_on(random, 2, {0, 1, 2, 4, 8, 16, 32}));
  check(curve_on(random, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  check(curve_on(random, 3, {0, 0, 0, 3, 4, 4.5, 6, 6, 6, 6}));
}

TEST(Nurbs, InnerKnotsOfAllMultiplicities) {
  RandomNurbs random(3);
  for (int p = 1; p <= 6; ++p) {
    for (int multiplicity = 1; multiplicity <= p + 1; ++multiplicity) {
      Knots knots(to_size(p) + 1, 0.0);
      knots.insert(knots.end(), to_size(multiplicity), 0.3);
      knots.insert(knots.end(), to_size(p) + 1, 1.0);
      const NurbsCurve curve = curve_on(random, p, knots);
      check(curve);
      EXPECT_EQ(decompose(curve).size(), 2u);
      if (multiplicity <= p) expect_continuous(curve, std::min(p - multiplicity, 3));
    }
  }
}

TEST(Nurbs, FullMultiplicityMayBeAGap) {
  RandomNurbs random(4);
  const NurbsCurve curve = curve_on(random, 2, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  const std::vector<CurvePiece> pieces = decompose(curve);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].bezier.points,
            std::vector<dvec4>(curve.points.begin(), curve.points.begin() + 3));
  EXPECT_EQ(pieces[1].bezier.points,
            std::vector<dvec4>(curve.points.begin() + 3, curve.points.end()));
}

TEST(Nurbs, PeriodicCurveClosesSmoothly) {
  RandomNurbs random(5);
  for (int p = 1; p <= 5; ++p) {
    NurbsCurve curve;
    curve.degree = p;
    const int period = 6;
    // Spans of unequal lengths, repeated.
    const double lengths[period] = {1, 0.5, 2, 1.5, 0.25, 1};
    double t = 0;
    for (int i = 0; i < period + 2 * p + 1; ++i) {
      curve.knots.push_back(t);
      t += lengths[i % period];
    }
    curve.points = random.points(period);
    for (int i = 0; i < p; ++i) curve.points.push_back(curve.points[to_size(i)]);
    check(curve);
    expect_continuous(curve, std::min(p - 1, 3));
    const std::vector<CurvePiece> pieces = decompose(curve);
    ASSERT_EQ(pieces.size(), to_size(period));
    expect_within(point(pieces.front().bezier, 0), point(pieces.back().bezier, 1), 1e-14);
    if (p == 1) continue;
    const double first = pieces.front().t.upper - pieces.front().t.lower;
    const double last = pieces.back().t.upper - pieces.back().t.lower;
    expect_within(jet(pieces.front().bezier, 0).ct / first, jet(pieces.back().bezier, 1).ct / last,
                  1e-12);
  }
}

TEST(Nurbs, RandomCurves) {
  RandomNurbs random(6);
  for (int k = 0; k < 400; ++k) {
    const int degree = random.integer(1, 7);
    check(curve_on(random, degree, random_knots(random, degree)));
  }
}

TEST(Nurbs, HighestDegree) {
  RandomNurbs random(7);
  const std::size_t order = max_degree + 1;
  Knots knots(order, 0.0);
  knots.push_back(0.5);
  knots.insert(knots.end(), order, 1.0);
  const NurbsCurve curve = curve_on(random, max_degree, knots);
  ASSERT_NO_THROW(validate(curve, "curve"));
  const std::vector<CurvePiece> pieces = decompose(curve);
  ASSERT_EQ(pieces.size(), 2u);
  // The recurrence of the reference takes 2^31 steps here: continuity must do.
  expect_within(point(pieces[0].bezier, 1), point(pieces[1].bezier, 0), 1e-13);
  expect_within(jet(pieces[0].bezier, 1).ct, jet(pieces[1].bezier, 0).ct, 1e-11);
}

/// Spans of very different lengths, and far from zero.
TEST(Nurbs, SpansOfAllSizes) {
  RandomNurbs random(8);
  check(curve_on(random, 3, {0, 0, 0, 0, 1e-12, 1, 1e12, 1e12, 1e12, 1e12}));
  check(curve_on(random, 3, {1e9, 1e9, 1e9, 1e9, 1e9 + 1, 1e9 + 2, 1e9 + 2, 1e9 + 2, 1e9 + 2}));
  check(curve_on(random, 2, {-1e300, 0, 1e-300, 1, 1e300, 1.5e300}));
}

TEST(Nurbs, RationalCircle) {
  const NurbsCurve curve = circle();
  check(curve);
  const std::vector<CurvePiece> pieces = decompose(curve);
  ASSERT_EQ(pieces.size(), 4u);
  for (const CurvePiece& piece : pieces) {
    for (int i = 0; i <= 16; ++i) {
      EXPECT_NEAR(glm::length(point(piece.bezier, i / 16.0)), 1, 1e-15);
    }
  }
}

/// Inserting knots by hand: the cubic with knots 0 0 0 0 1 2 2 2 2 and the textbook's Bezier
/// points.
TEST(Nurbs, KnownBezierPoints) {
  NurbsCurve curve{3, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {}};
  for (int i = 0; i < 5; ++i) curve.points.push_back(homogeneous(dvec3(i * i, i, 1)));
  const std::vector<CurvePiece> pieces = decompose(curve);
  ASSERT_EQ(pieces.size(), 2u);
  // b0 = P0, b1 = P1, b2 = (P1 + P2) / 2, b3 = (b2 + b4) / 2, b4 = (P2 + P3) / 2, b5 = P3, b6 = P4.
  const std::array<double, 7> x = {0, 1, 2.5, 4.5, 6.5, 9, 16};
  const std::array<double, 7> y = {0, 1, 1.5, 2, 2.5, 3, 4};
  for (std::size_t i = 0; i < 7; ++i) {
    const dvec4 expected(x[i], y[i], 1, 1);
    if (i < 4) {
      EXPECT_EQ(pieces[0].bezier.points[i], expected);
    }
    if (i >= 3) {
      EXPECT_EQ(pieces[1].bezier.points[i - 3], expected);
    }
  }
}

TEST(Nurbs, RandomSurfaces) {
  RandomNurbs random(9);
  for (int k = 0; k < 60; ++k) {
    const int p = random.integer(1, 5);
    const int q = random.integer(1, 5);
    const NurbsSurface s =
        surface_on(random, p, q, random_knots(random, p), random_knots(random, q));
    ASSERT_NO_THROW(validate(s, "surface"));
    const std::vector<PatchPiece> pieces = decompose(s);
    ASSERT_FALSE(pieces.empty());
    for (const PatchPiece& piece : pieces) {
      ASSERT_NO_THROW(validate(piece.bezier, "piece"));
      for (int i = 0; i <= 3; ++i) {
        for (int j = 0; j <= 3; ++j) {
          const auto at = [](Interval t, int n) {
            return t.lower + (static_cast<long double>(t.upper) - t.lower) * n / 3;
          };
          expect_within(point(piece.bezier, i / 3.0, j / 3.0),
                        euclidean_of(reference(s, piece, at(piece.u, i), at(piece.v, j))),
                        rounding(p + q));
        }
      }
    }
  }
}

/// u outer, v inner, both ascending.
TEST(Nurbs, OrderOfPatches) {
  RandomNurbs random(10);
  const NurbsSurface s = surface_on(random, 1, 2, {0, 0, 1, 3, 3}, {5, 5, 5, 6, 6, 8, 9, 9, 9});
  const std::vector<PatchPiece> pieces = decompose(s);
  ASSERT_EQ(pieces.size(), 6u);
  const Knots u = {0, 1, 3};
  const Knots v = {5, 6, 8, 9};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const PatchPiece& piece = pieces[3 * i + j];
      EXPECT_EQ(piece.u.lower, u[i]);
      EXPECT_EQ(piece.u.upper, u[i + 1]);
      EXPECT_EQ(piece.v.lower, v[j]);
      EXPECT_EQ(piece.v.upper, v[j + 1]);
      EXPECT_EQ(piece.bezier.degree_u, 1);
      EXPECT_EQ(piece.bezier.degree_v, 2);
    }
  }
  EXPECT_EQ(s.domain_u().upper, 3);
  EXPECT_EQ(s.domain_v().lower, 5);
  EXPECT_EQ(s.count_u(), 3);
  EXPECT_EQ(s.count_v(), 6);
}

/// Positive weights stay positive, and the control box does not grow, also where the knots outside
/// the domain are far away.
TEST(Nurbs, PiecesStayInTheConvexHull) {
  RandomNurbs random(11);
  for (int k = 0; k < 200; ++k) {
    const int degree = random.integer(1, 6);
    NurbsCurve curve = curve_on(random, degree, random_knots(random, degree));
    Box box;
    for (dvec4& p : curve.points) {
      p.w = 1;
      box.include(dvec3(p));
    }
    for (const CurvePiece& piece : decompose(curve)) {
      for (const dvec4& p : piece.bezier.points) {
        for (int i = 0; i < 3; ++i) {
          EXPECT_GE(p[i], box.lower[i] - 1e-15);
          EXPECT_LE(p[i], box.upper[i] + 1e-15);
        }
        EXPECT_NEAR(p.w, 1, 1e-15);
      }
    }
  }
}

TEST(Nurbs, BezierAsNurbsAndBack) {
  RandomNurbs random(12);
  for (int p = 1; p <= 9; ++p) {
    const BezierCurve curve{random.points(to_size(p) + 1)};
    const NurbsCurve nurbs_curve = as_nurbs(curve);
    ASSERT_NO_THROW(validate(nurbs_curve, "curve"));
    const std::vector<CurvePiece> curves = decompose(nurbs_curve);
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].bezier.points, curve.points);
    EXPECT_EQ(curves[0].t.lower, 0);
    EXPECT_EQ(curves[0].t.upper, 1);

    const BezierPatch patch{p, 10 - p, random.points(to_size((p + 1) * (11 - p)))};
    const NurbsSurface nurbs_surface = as_nurbs(patch);
    ASSERT_NO_THROW(validate(nurbs_surface, "surface"));
    const std::vector<PatchPiece> patches = decompose(nurbs_surface);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_EQ(patches[0].bezier.points, patch.points);
    EXPECT_EQ(patches[0].bezier.degree_u, p);
    EXPECT_EQ(patches[0].bezier.degree_v, 10 - p);
  }
}

TEST(Nurbs, ValidateCurveNamesWhatIsWrong) {
  RandomNurbs random(13);
  const NurbsCurve good = curve_on(random, 2, {0, 0, 0, 1, 2, 2, 2});
  EXPECT_NO_THROW(validate(good, "rail"));
  const auto bad = [&](const std::string& message, const std::function<void(NurbsCurve&)>& change) {
    NurbsCurve curve = good;
    change(curve);
    expect_invalid([&] { validate(curve, "rail"); }, message);
    expect_invalid([&] { validate(curve, "rail"); }, "rail");
  };
  bad("degree 0", [](NurbsCurve& c) { c.degree = 0; });
  bad("degree -7", [](NurbsCurve& c) { c.degree = -7; });
  bad("degree 32", [](NurbsCurve& c) { c.degree = max_degree + 1; });
  bad("degree 2147483647", [](NurbsCurve& c) { c.degree = std::numeric_limits<int>::max(); });
  bad("0 knots", [](NurbsCurve& c) { c.knots.clear(); });
  bad("5 knots", [](NurbsCurve& c) { c.knots.resize(5); });
  bad("3 control points", [](NurbsCurve& c) { c.points.resize(3); });
  bad("5 control points", [](NurbsCurve& c) { c.points.resize(5, dvec4(1)); });
  bad("0 control points", [](NurbsCurve& c) { c.points.clear(); });
  bad("knot 4 is below", [](NurbsCurve& c) { c.knots[4] = 0.5; });
  bad("knot 3 is not finite", [](NurbsCurve& c) { c.knots[3] = not_a_number; });
  bad("knot 6 is not finite", [](NurbsCurve& c) { c.knots[6] = infinity; });
  bad("overflows",
      [](NurbsCurve& c) { c.knots = {-1e308, -1e308, -1e308, 0, 1e308, 1e308, 1e308}; });
  bad("domain is empty", [](NurbsCurve& c) { c.knots = {0, 1, 2, 2, 2, 3, 4}; });
  bad("domain is empty", [](NurbsCurve& c) { c.knots = {1, 1, 1, 1, 1, 1, 1}; });
  bad("multiplicity of knot 3", [](NurbsCurve& c) { c.knots = {0, 0, 0, 0, 2, 2, 2}; });
  bad("control point 1 is not finite", [](NurbsCurve& c) { c.points[1].x = not_a_number; });
  bad("control point 2 is not finite", [](NurbsCurve& c) { c.points[2].w = infinity; });
  bad("weight of control point 3", [](NurbsCurve& c) { c.points[3].w = 0; });
  bad("weight of control point 3", [](NurbsCurve& c) { c.points[3].w = -1; });
}

TEST(Nurbs, ValidateInnerMultiplicity) {
  RandomNurbs random(14);
  EXPECT_NO_THROW(validate(curve_on(random, 2, {0, 0, 0, 1, 1, 1, 2, 2, 2}), "rail"));
  expect_invalid(
      [&] {
        validate(curve_on(random, 2, {0, 0, 0, 1, 1, 1, 1, 2, 2, 2}), "rail");
      },
      "multiplicity of knot 6");
  expect_invalid(
      [&] {
        validate(curve_on(random, 2, {0, 0, 0, 1, 2, 2, 2, 2}), "rail");
      },
      "multiplicity of knot 7");
}

TEST(Nurbs, ValidateSurfaceNamesWhatIsWrong) {
  RandomNurbs random(15);
  const NurbsSurface good = surface_on(random, 2, 1, {0, 0, 0, 1, 2, 2, 2}, {0, 0, 1, 1});
  EXPECT_NO_THROW(validate(good, "lid"));
  const auto bad = [&](const std::string& message,
                       const std::function<void(NurbsSurface&)>& change) {
    NurbsSurface surface = good;
    change(surface);
    expect_invalid([&] { validate(surface, "lid"); }, message);
    expect_invalid([&] { validate(surface, "lid"); }, "lid");
  };
  bad("u: degree 0", [](NurbsSurface& s) { s.degree_u = 0; });
  bad("v: degree 32", [](NurbsSurface& s) { s.degree_v = max_degree + 1; });
  bad("u: 3 knots", [](NurbsSurface& s) { s.knots_u.resize(3); });
  bad("v: 0 knots", [](NurbsSurface& s) { s.knots_v.clear(); });
  bad("7 control points", [](NurbsSurface& s) { s.points.resize(7); });
  bad("9 control points", [](NurbsSurface& s) { s.points.resize(9, dvec4(1)); });
  bad("u: knot 4 is below", [](NurbsSurface& s) { s.knots_u[4] = 0.5; });
  bad("v: knot 1 is not finite", [](NurbsSurface& s) { s.knots_v[1] = not_a_number; });
  bad("v: the domain is empty", [](NurbsSurface& s) { s.knots_v = {0, 1, 1, 2}; });
  bad("u: the multiplicity", [](NurbsSurface& s) { s.knots_u = {0, 0, 0, 0, 2, 2, 2}; });
  bad("control point 5 is not finite", [](NurbsSurface& s) { s.points[5].z = -infinity; });
  bad("weight of control point 6", [](NurbsSurface& s) { s.points[6].w = -0.0; });
}

}  // namespace
}  // namespace taut
