#include "taut/surface/bezier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "error_checks.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using taut_test::expect_invalid;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Taylor coefficients c[k][l] of s^k t^l up to total order 3, in long double: the reference for
/// all derivatives. Unlike the code under test it differentiates nothing: it runs de Casteljau on
/// polynomials instead of numbers, and divides them.
struct Series {
  long double c[4][4] = {};

  Series() = default;
  Series(long double constant) { c[0][0] = constant; }
  Series(long double constant, long double s, long double t) : Series(constant) {
    c[1][0] = s;
    c[0][1] = t;
  }
  friend Series operator+(Series a, const Series& b) {
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; k + l < 4; ++l) a.c[k][l] += b.c[k][l];
    }
    return a;
  }
  friend Series operator*(const Series& a, const Series& b) {
    Series r;
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; k + l < 4; ++l) {
        for (int m = 0; k + l + m < 4; ++m) {
          for (int n = 0; k + l + m + n < 4; ++n) r.c[k + m][l + n] += a.c[k][l] * b.c[m][n];
        }
      }
    }
    return r;
  }
  /// Order by order: the coefficients of the quotient q solve q * b = a.
  friend Series operator/(const Series& a, const Series& b) {
    Series q;
    for (int order = 0; order < 4; ++order) {
      for (int k = 0; k <= order; ++k) {
        const Series product = q * b;
        q.c[k][order - k] = (a.c[k][order - k] - product.c[k][order - k]) / b.c[0][0];
      }
    }
    return q;
  }
  long double derivative(int k, int l) const {
    constexpr long double factorial[] = {1, 1, 2, 6};
    return factorial[k] * factorial[l] * c[k][l];
  }
};

/// Homogeneous points whose coordinates are Series or long double.
template <class T>
using Point = std::array<T, 4>;

template <class T>
Point<T> de_casteljau(std::vector<Point<T>> p, const T& t) {
  const T s = T(1) + T(-1) * t;
  for (; p.size() > 1; p.pop_back()) {
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      for (std::size_t k = 0; k < 4; ++k) p[i][k] = s * p[i][k] + t * p[i + 1][k];
    }
  }
  return p.front();
}

template <class T>
Point<T> reference(const BezierPatch& patch, const T& u, const T& v) {
  std::vector<Point<T>> rows;
  for (int i = 0; i <= patch.degree_u; ++i) {
    std::vector<Point<T>> row;
    for (int j = 0; j <= patch.degree_v; ++j) {
      const dvec4& p = patch.at(i, j);
      row.push_back({T(p.x), T(p.y), T(p.z), T(p.w)});
    }
    rows.push_back(de_casteljau(row, v));
  }
  return de_casteljau(rows, u);
}

/// The patch around (u, v) and the curve around t.
Point<Series> series(const BezierPatch& patch, double u, double v) {
  return reference(patch, Series(u, 1, 0), Series(v, 0, 1));
}
Point<Series> series(const BezierCurve& curve, double t) {
  return series(BezierPatch{curve.degree(), 0, curve.points}, t, 0);
}

dvec3 derivative(const Point<Series>& X, int k, int l) {
  dvec3 d;
  for (int i = 0; i < 3; ++i) {
    d[i] = static_cast<double>((X[static_cast<std::size_t>(i)] / X[3]).derivative(k, l));
  }
  return d;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  dvec3 vector() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
  /// Weights in [1/ratio, ratio], log-uniform.
  dvec4 point(double ratio) {
    const double log_ratio = std::log(ratio);
    const double w = ratio == 1 ? 1 : std::exp((*this)(-log_ratio, log_ratio));
    return homogeneous(vector(), w);
  }
  BezierCurve curve(int degree, double ratio) {
    BezierCurve c;
    for (int i = 0; i <= degree; ++i) c.points.push_back(point(ratio));
    return c;
  }
  BezierPatch patch(int degree_u, int degree_v, double ratio) {
    BezierPatch p{degree_u, degree_v, {}};
    for (int i = 0; i < (degree_u + 1) * (degree_v + 1); ++i) p.points.push_back(point(ratio));
    return p;
  }
  /// Now and then an end of [0, 1].
  double parameter() { return std::clamp((*this)(-0.1, 1.1), 0.0, 1.0); }

 private:
  std::mt19937_64 engine_;
};

void expect_near(const dvec3& a, const dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance) << "(" << a.x << ", " << a.y << ", " << a.z << ") and ("
                                           << b.x << ", " << b.y << ", " << b.z << ")";
}

/// Rounding of a derivative of a rational map of unit size: every differentiation multiplies by the
/// degree and, through the quotient, by the ratio of the weights.
double rounding(int degree, int order, double ratio) {
  return 64 * rounding_unit * degree * std::pow(2 * degree * ratio * ratio, order) * ratio * ratio;
}

/// The octant of the sphere: u from the equator to the pole, where the patch collapses.
BezierPatch sphere_octant(double radius, const dvec3& center) {
  const double c = std::numbers::sqrt2 / 2;
  const std::array<dvec3, 3> arc = {dvec3(1, 0, 1), dvec3(1, 1, c),
                                    dvec3(0, 1, 1)};  // x, y, weight
  BezierPatch patch{2, 2, {}};
  for (const dvec3& profile : arc) {
    for (const dvec3& circle : arc) {
      const dvec3 p(profile.x * circle.x, profile.x * circle.y, profile.y);
      patch.points.push_back(homogeneous(center + radius * p, profile.z * circle.z));
    }
  }
  return patch;
}

TEST(Bezier, PatchAndDerivativesAgainstSeries) {
  Random random(1);
  for (const double ratio : {1.0, 2.0}) {
    for (int p = 1; p <= 9; ++p) {
      for (int q = 1; q <= 9; ++q) {
        const BezierPatch patch = random.patch(p, q, ratio);
        for (int k = 0; k < 4; ++k) {
          const double u = random.parameter();
          const double v = random.parameter();
          const Point<Series> X = series(patch, u, v);
          const PatchJet3 j = jet3(patch, u, v);
          const auto check = [&](const dvec3& d, int a, int b) {
            SCOPED_TRACE(testing::Message() << "degrees " << p << " " << q << " at " << u << " "
                                            << v << ", derivative " << a << " " << b);
            expect_near(d, derivative(X, a, b), rounding(std::max(p, q), a + b, ratio));
          };
          check(point(patch, u, v), 0, 0);
          check(j.S, 0, 0);
          check(j.Su, 1, 0);
          check(j.Sv, 0, 1);
          check(j.Suu, 2, 0);
          check(j.Suv, 1, 1);
          check(j.Svv, 0, 2);
          check(j.Suuu, 3, 0);
          check(j.Suuv, 2, 1);
          check(j.Suvv, 1, 2);
          check(j.Svvv, 0, 3);
          const PatchJet1 j1 = jet1(patch, u, v);
          check(j1.S, 0, 0);
          check(j1.Su, 1, 0);
          check(j1.Sv, 0, 1);
          const PatchJet2 j2 = jet2(patch, u, v);
          check(j2.Su, 1, 0);
          check(j2.Sv, 0, 1);
          check(j2.Suu, 2, 0);
          check(j2.Suv, 1, 1);
          check(j2.Svv, 0, 2);
        }
      }
    }
  }
}

TEST(Bezier, CurveAndDerivativesAgainstSeries) {
  Random random(2);
  for (const double ratio : {1.0, 2.0}) {
    for (int p = 1; p <= 9; ++p) {
      const BezierCurve curve = random.curve(p, ratio);
      for (int k = 0; k < 50; ++k) {
        const double t = random.parameter();
        SCOPED_TRACE(testing::Message() << "degree " << p << " at " << t);
        const Point<Series> X = series(curve, t);
        const CurveJet j = jet(curve, t);
        expect_near(point(curve, t), derivative(X, 0, 0), rounding(p, 0, ratio));
        expect_near(j.c, derivative(X, 0, 0), rounding(p, 0, ratio));
        expect_near(j.ct, derivative(X, 1, 0), rounding(p, 1, ratio));
        expect_near(j.ctt, derivative(X, 2, 0), rounding(p, 2, ratio));
        expect_near(j.cttt, derivative(X, 3, 0), rounding(p, 3, ratio));
      }
    }
  }
}

TEST(Bezier, PointErrorWithinItsBound) {
  Random random(3);
  for (const int p : {1, 2, 3, 5, 9, 20, max_degree}) {
    for (const int q : {1, 3, 9, max_degree}) {
      for (const double offset : {0.0, 1e3, 1e8}) {
        BezierPatch patch = random.patch(p, q, 1);
        double largest = 0;
        for (dvec4& x : patch.points) {
          x += dvec4(dvec3(offset), 0);
          largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        }
        const double bound = (4 * p + 4 * q + 8) * rounding_unit * largest;
        for (int k = 0; k < 20; ++k) {
          const double u = random.parameter();
          const double v = random.parameter();
          const dvec3 S = point(patch, u, v);
          const auto exact = reference<long double>(patch, u, v);
          for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(std::abs(S[axis] - exact[static_cast<std::size_t>(axis)] / exact[3]), bound)
                << p << " " << q << " " << offset;
          }
        }
      }
    }
  }
}

TEST(Bezier, CornersAreControlPoints) {
  Random random(4);
  const BezierPatch patch = random.patch(3, 5, 2);
  EXPECT_EQ(point(patch, 0, 0), euclidean(patch.at(0, 0)));
  EXPECT_EQ(point(patch, 0, 1), euclidean(patch.at(0, 5)));
  EXPECT_EQ(point(patch, 1, 0), euclidean(patch.at(3, 0)));
  EXPECT_EQ(point(patch, 1, 1), euclidean(patch.at(3, 5)));
}

TEST(Bezier, RestrictedPatch) {
  Random random(5);
  for (int p = 1; p <= 9; ++p) {
    const int q = 1 + (p * 5) % 9;
    const BezierPatch patch = random.patch(p, q, 2);
    for (int k = 0; k < 20; ++k) {
      double u[] = {random.parameter(), random.parameter()};
      double v[] = {random.parameter(), random.parameter()};
      const Interval iu{std::min(u[0], u[1]), std::max(u[0], u[1])};
      const Interval iv{std::min(v[0], v[1]), std::max(v[0], v[1])};
      if (iu.upper == 0 || iv.upper == 0) continue;
      const BezierPatch part = restricted(patch, iu, iv);
      const double s = random.parameter();
      const double t = random.parameter();
      expect_near(point(part, s, t), point(patch, iu.at(s), iv.at(t)), rounding(9, 0, 2));
    }
    // A split at one parameter gives the same border to both halves.
    const double m = random.parameter();
    const BezierPatch left = restricted(patch, {0, m}, {0, 1});
    const BezierPatch right = restricted(patch, {m, 1}, {0, 1});
    for (int j = 0; j <= q; ++j) {
      expect_near(euclidean(left.at(p, j)), euclidean(right.at(0, j)), rounding(9, 0, 2));
    }
  }
}

TEST(Bezier, RestrictedCurve) {
  Random random(6);
  for (int p = 1; p <= 9; ++p) {
    const BezierCurve curve = random.curve(p, 2);
    const Interval all{0, 1};
    EXPECT_EQ(restricted(curve, all).points, curve.points);
    const Interval part{0.25, 0.625};
    const BezierCurve piece = restricted(curve, part);
    for (int k = 0; k <= 8; ++k) {
      const double s = k / 8.0;
      expect_near(point(piece, s), point(curve, part.at(s)), rounding(9, 0, 2));
    }
    const BezierCurve nothing = restricted(curve, {0.5, 0.5});
    for (const dvec4& x : nothing.points) {
      expect_near(euclidean(x), point(curve, 0.5), rounding(9, 0, 2));
    }
  }
}

TEST(Bezier, RestrictedToTheStart) {
  Random random(61);
  const BezierCurve curve = random.curve(4, 2);
  const BezierCurve start = restricted(curve, {0, 0});
  for (const dvec4& x : start.points) expect_near(euclidean(x), point(curve, 0), rounding(4, 0, 2));
}

TEST(Bezier, Elevated) {
  Random random(7);
  for (int p = 1; p <= 6; ++p) {
    const BezierPatch patch = random.patch(p, 7 - p, 2);
    const BezierPatch high = elevated(patch, p + 2, 8 - p);
    EXPECT_EQ(high.degree_u, p + 2);
    EXPECT_EQ(high.degree_v, 8 - p);
    validate(high, "elevated");
    const BezierCurve curve = random.curve(p, 2);
    const BezierCurve high_curve = elevated(curve, p + 3);
    EXPECT_EQ(high_curve.degree(), p + 3);
    for (int k = 0; k < 20; ++k) {
      const double u = random.parameter();
      const double v = random.parameter();
      expect_near(point(high, u, v), point(patch, u, v), rounding(9, 0, 2));
      expect_near(point(high_curve, u), point(curve, u), rounding(9, 0, 2));
    }
    EXPECT_EQ(elevated(curve, p).points, curve.points);
  }
}

TEST(Bezier, TransposedReversedAndBorders) {
  Random random(8);
  const BezierPatch patch = random.patch(2, 5, 2);
  const BezierPatch other = transposed(patch);
  EXPECT_EQ(other.degree_u, 5);
  EXPECT_EQ(other.degree_v, 2);
  EXPECT_EQ(transposed(other).points, patch.points);
  const BezierCurve curve = random.curve(4, 2);
  EXPECT_EQ(reversed(reversed(curve)).points, curve.points);
  for (int k = 0; k <= 10; ++k) {
    const double t = k / 10.0;
    expect_near(point(other, t, 0.3), point(patch, 0.3, t), rounding(5, 0, 2));
    expect_near(point(reversed(curve), t), point(curve, 1 - t), rounding(4, 0, 2));
    expect_near(point(border(patch, Side::u0), t), point(patch, 0, t), rounding(5, 0, 2));
    expect_near(point(border(patch, Side::u1), t), point(patch, 1, t), rounding(5, 0, 2));
    expect_near(point(border(patch, Side::v0), t), point(patch, t, 0), rounding(5, 0, 2));
    expect_near(point(border(patch, Side::v1), t), point(patch, t, 1), rounding(5, 0, 2));
  }
}

TEST(Bezier, IsPolynomial) {
  Random random(9);
  EXPECT_TRUE(is_polynomial(random.curve(3, 1).points));
  EXPECT_TRUE(is_polynomial(std::vector<dvec4>(3, dvec4(0, 0, 0, 0.1))));
  EXPECT_FALSE(is_polynomial(random.curve(3, 2).points));
}

/// The net of the k-th derivative along u, homogeneous.
BezierPatch differentiated(BezierPatch patch, int k) {
  for (; k > 0; --k) {
    BezierPatch d{patch.degree_u - 1, patch.degree_v, {}};
    for (int i = 0; i < patch.degree_u; ++i) {
      for (int j = 0; j <= patch.degree_v; ++j) {
        d.points.push_back(double(patch.degree_u) * (patch.at(i + 1, j) - patch.at(i, j)));
      }
    }
    if (d.points.empty()) return {0, 0, {dvec4(0)}};
    patch = d;
  }
  return patch;
}

/// Largest homogeneous derivative of order (k, l) over a grid, space and weight part.
HomogeneousBound sampled(const BezierPatch& patch, int k, int l) {
  const BezierPatch d = differentiated(transposed(differentiated(transposed(patch), l)), k);
  HomogeneousBound largest;
  const int n = 16;
  for (int a = 0; a <= n; ++a) {
    for (int b = 0; b <= n; ++b) {
      const auto X = reference<long double>(d, a / (1.0L * n), b / (1.0L * n));
      const dvec3 space(X[0], X[1], X[2]);
      largest.space = std::max(largest.space, glm::length(space));
      largest.weight = std::max(largest.weight, static_cast<double>(std::abs(X[3])));
    }
  }
  return largest;
}

TEST(Bezier, DerivativeBoundsHold) {
  Random random(10);
  for (const double ratio : {1.0, 3.0}) {
    for (int p = 1; p <= 6; ++p) {
      for (int q = 1; q <= 6; ++q) {
        const BezierPatch patch = random.patch(p, q, ratio);
        const auto check = [&](const HomogeneousBound& bound, int k, int l, double looseness) {
          SCOPED_TRACE(testing::Message() << p << " " << q << " derivative " << k << " " << l);
          const HomogeneousBound largest = sampled(patch, k, l);
          EXPECT_GE(bound.space, largest.space);
          EXPECT_GE(bound.weight, largest.weight);
          // Up to cubics the extremes of the second derivatives' nets lie on the surface.
          if (p > 3 || q > 3) return;
          EXPECT_LE(bound.space, looseness * largest.space + 1e-12);
          EXPECT_LE(bound.weight, looseness * largest.weight + 1e-12);
        };
        check(second_derivative_bound(patch, Direction::u), 2, 0, 4);
        check(second_derivative_bound(patch, Direction::v), 0, 2, 4);
        check(mixed_derivative_bound(patch), 2, 2, 4);
      }
    }
  }
}

TEST(Bezier, CurveDerivativeBoundHolds) {
  Random random(11);
  for (int p = 1; p <= 8; ++p) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      const BezierCurve curve = random.curve(p, 3);
      const HomogeneousBound bound = second_derivative_bound(curve);
      const HomogeneousBound largest = sampled({p, 0, curve.points}, 2, 0);
      EXPECT_GE(bound.space, largest.space);
      EXPECT_GE(bound.weight, largest.weight);
      if (p > 3) continue;
      // A second derivative of degree 1 is largest at an end.
      EXPECT_LE(bound.space, largest.space * (1 + 1e-12));
      EXPECT_LE(bound.weight, largest.weight * (1 + 1e-12));
    }
  }
}

/// Sizes log-uniform, so that the differences of the control points round.
TEST(Bezier, DerivativeBoundCoversRounding) {
  Random random(16);
  for (int k = 0; k < 10000; ++k) {
    BezierCurve curve;
    for (int i = 0; i < 3; ++i) {
      const double size = std::exp2(random(-40, 40));
      curve.points.emplace_back(size * random.vector(), std::exp2(random(-40, 40)));
    }
    const HomogeneousBound bound = second_derivative_bound(curve);
    std::array<long double, 4> d;
    for (int axis = 0; axis < 4; ++axis) {
      const auto x = [&](std::size_t i) { return static_cast<long double>(curve.points[i][axis]); };
      d[static_cast<std::size_t>(axis)] = 2 * (x(2) - 2 * x(1) + x(0));
    }
    EXPECT_GE(bound.space, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    EXPECT_GE(bound.weight, std::abs(d[3]));
  }
}

/// The difference 2^-60 - 2 * 0.5 + 1 of the weights rounds to zero but is not.
TEST(Bezier, DerivativeBoundWhereAllIsRounding) {
  const BezierCurve curve{
      {homogeneous(dvec3(1), 1), homogeneous(dvec3(1), 0.5), homogeneous(dvec3(1), 0x1p-60)}};
  EXPECT_GE(second_derivative_bound(curve).space, std::sqrt(3) * 0x1p-59);
  EXPECT_GE(second_derivative_bound(curve).weight, 0x1p-59);
}

TEST(Bezier, DerivativeBoundsOfFlatThings) {
  const BezierCurve line{{homogeneous(dvec3(0)), homogeneous(dvec3(1, 2, 3))}};
  EXPECT_EQ(second_derivative_bound(line).space, 0);
  EXPECT_EQ(second_derivative_bound(line).weight, 0);
  const BezierPatch plane{1,
                          1,
                          {homogeneous(dvec3(0, 0, 0)), homogeneous(dvec3(0, 1, 0)),
                           homogeneous(dvec3(1, 0, 0)), homogeneous(dvec3(1, 1, 0))}};
  EXPECT_EQ(second_derivative_bound(plane, Direction::u).space, 0);
  EXPECT_EQ(second_derivative_bound(plane, Direction::v).space, 0);
  EXPECT_EQ(mixed_derivative_bound(plane).space, 0);
}

TEST(Bezier, UnitNormalOfRegularPoints) {
  Random random(12);
  for (int k = 0; k < 100; ++k) {
    const BezierPatch patch = random.patch(3, 4, 2);
    const double u = random.parameter();
    const double v = random.parameter();
    const Point<Series> X = series(patch, u, v);
    const dvec3 N = glm::cross(derivative(X, 1, 0), derivative(X, 0, 1));
    expect_near(unit_normal(patch, u, v), N / glm::length(N), 1e-9);
  }
}

TEST(Bezier, UnitNormalOfSphereOctant) {
  for (const double radius : {1e-6, 1.0, 1e6}) {
    for (const double distance : {0.0, 1.0, 1e3}) {
      const dvec3 center = radius * distance * dvec3(0.3, -0.7, 3.15);
      const BezierPatch patch = sphere_octant(radius, center);
      SCOPED_TRACE(testing::Message() << "radius " << radius << " distance " << distance);
      for (int i = 0; i <= 16; ++i) {
        for (int j = 0; j <= 16; ++j) {
          const double u = i / 16.0;
          const double v = j / 16.0;
          // Su points to the pole, Sv around it: their product points inwards. The whole side u = 1
          // is the pole, where each tangent along v vanishes.
          const dvec3 inward = (center - point(patch, u, v)) / radius;
          expect_near(unit_normal(patch, u, v), inward, 1e-6);
        }
      }
    }
  }
}

/// At the tip of a cone the normal depends on where along the collapsed side one asks.
TEST(Bezier, UnitNormalAtTheTipOfACone) {
  const double c = std::numbers::sqrt2 / 2;
  const dvec3 tip(5, 6, 7);
  const std::array<dvec3, 3> circle = {dvec3(1, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 0)};
  const std::array<double, 3> weight = {1, c, 1};
  BezierPatch patch{1, 2, {}};
  for (std::size_t j = 0; j < 3; ++j) patch.points.push_back(homogeneous(tip, weight[j]));
  for (std::size_t j = 0; j < 3; ++j) {
    patch.points.push_back(homogeneous(tip + circle[j] - dvec3(0, 0, 1), weight[j]));
  }
  for (int j = 0; j <= 8; ++j) {
    const double v = j / 8.0;
    const dvec3 radial = point(patch, 1, v) - tip + dvec3(0, 0, 1);
    expect_near(unit_normal(patch, 0, v), (radial + dvec3(0, 0, 1)) / std::numbers::sqrt2, 1e-6);
  }
}

/// The unit disc as one patch: at its corners the tangents of the circle are parallel.
TEST(Bezier, UnitNormalWhereTangentsAreParallel) {
  const double c = std::numbers::sqrt2 / 2;
  BezierPatch disc{2, 2, {}};
  const double w[3][3] = {{1, c, 1}, {c, 1, c}, {1, c, 1}};
  const double x[3][3] = {{-c, -1 / c, -c}, {0, 0, 0}, {c, 1 / c, c}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double px = i == 1 ? 0 : (j == 1 ? x[i][1] : x[i][j]);
      const double py = j == 1 ? 0 : (i == 1 ? x[j][1] : x[j][i]);
      disc.points.push_back(homogeneous(dvec3(px, py, 2), w[i][j]));
    }
  }
  for (int i = 0; i <= 4; ++i) {
    const double t = i / 4.0;
    EXPECT_NEAR(glm::length(point(disc, t, 0) - dvec3(0, 0, 2)), 1, 1e-14);
    for (int j = 0; j <= 4; ++j) {
      expect_near(unit_normal(disc, t, j / 4.0), dvec3(0, 0, 1), 1e-6);
    }
  }
}

TEST(Bezier, NoNormal) {
  Random random(13);
  // All rows alike: a curve. All points alike: a point.
  BezierPatch curve = random.patch(0, 3, 1);
  for (int i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 4; ++j) curve.points.push_back(curve.points[j]);
  }
  curve.degree_u = 2;
  const BezierPatch dot{2, 3, std::vector<dvec4>(12, homogeneous(dvec3(0.1, 0.2, 0.3)))};
  for (const double u : {0.0, 0.4, 1.0}) {
    for (const double v : {0.0, 0.7, 1.0}) {
      EXPECT_EQ(unit_normal(curve, u, v), dvec3(0.0));
      EXPECT_EQ(unit_normal(dot, u, v), dvec3(0.0));
    }
  }
}

TEST(Bezier, ValidateNamesWhatIsWrong) {
  Random random(14);
  const BezierPatch good = random.patch(2, 3, 2);
  EXPECT_NO_THROW(validate(good, "patch"));
  const auto bad = [&](const auto& change, const std::string& message) {
    BezierPatch patch = good;
    change(patch);
    expect_invalid([&] { validate(patch, "lid"); }, message);
    expect_invalid([&] { validate(patch, "lid"); }, "lid");
  };
  bad([](BezierPatch& p) { p.degree_u = 0; }, "degree 0");
  bad([](BezierPatch& p) { p.degree_v = max_degree + 1; }, "degree 32");
  bad([](BezierPatch& p) { p.degree_u = -1; }, "degree -1");
  bad([](BezierPatch& p) { p.points.pop_back(); }, "11");
  bad([](BezierPatch& p) { p.points[7].y = nan; }, "control point 7");
  bad([](BezierPatch& p) { p.points[7].x = infinity; }, "control point 7");
  bad([](BezierPatch& p) { p.points[7].w = infinity; }, "control point 7");
  bad([](BezierPatch& p) { p.points[4].w = 0; }, "control point 4");
  bad([](BezierPatch& p) { p.points[4].w = -2; }, "weight");
}

TEST(Bezier, ValidateCurve) {
  Random random(15);
  EXPECT_NO_THROW(validate(random.curve(1, 2), "curve"));
  EXPECT_NO_THROW(validate(random.curve(max_degree, 2), "curve"));
  expect_invalid([&] { validate(BezierCurve{}, "spine"); }, "spine");
  expect_invalid([&] { validate(random.curve(0, 2), "spine"); }, "degree 0");
  expect_invalid([&] { validate(random.curve(max_degree + 1, 2), "spine"); }, "degree 32");
  BezierCurve curve = random.curve(3, 2);
  curve.points[2].z = -infinity;
  expect_invalid([&] { validate(curve, "spine"); }, "control point 2");
  curve = random.curve(3, 2);
  curve.points[1].w = -1;
  expect_invalid([&] { validate(curve, "spine"); }, "weight");
}

}  // namespace
}  // namespace taut
