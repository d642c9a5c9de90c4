#include "taut/surface/bezier.h"

#include <cmath>
#include <string>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/surface/bernstein.h"

namespace taut {
namespace {

/// Values of the Bernstein polynomials of degree p and of their derivatives up to order 3 at t:
/// value[k][i] = d^k/dt^k B_i^p(t).
struct Basis {
  double value[4][max_degree + 1];
};

/// The recurrence B_i^r = (1-t) B_i^{r-1} + t B_{i-1}^{r-1} is free of cancellation on [0, 1]; the
/// k-th derivatives come from the k-fold differences of the basis of degree p - k, which the
/// recurrence passes through on its way.
/// The degree is known when compiling (P >= 0) or not (-1).
template <int P = -1>
void bernstein(int degree, double t, int order, Basis& basis) {
  const int p = P >= 0 ? P : degree;
  if (p == 3) {
    auto& b = basis.value;
    cubic_bernstein(t, b);
    b[3][0] = -6;
    b[3][1] = 18;
    b[3][2] = -18;
    b[3][3] = 6;
    return;
  }
  const double s = 1 - t;
  double b[max_degree + 1];
  b[0] = 1;
  const auto store = [&](int passed) {
    const int k = p - passed;
    if (k > order) return;
    double* d = basis.value[k];
    std::copy(b, b + passed + 1, d);
    for (int r = passed; r < p; ++r) {
      d[r + 1] = (r + 1) * d[r];
      for (int i = r; i > 0; --i) d[i] = (r + 1) * (d[i - 1] - d[i]);
      d[0] = -(r + 1) * d[0];
    }
  };
  for (int k = p + 1; k <= order; ++k) std::fill_n(basis.value[k], p + 1, 0.0);
  store(0);
  for (int r = 1; r <= p; ++r) {
    b[r] = t * b[r - 1];
    for (int i = r - 1; i > 0; --i) b[i] = s * b[i] + t * b[i - 1];
    b[0] *= s;
    store(r);
  }
}

/// Indices of polynomials of which the value or a derivative up to the order is not zero: all, or
/// at an end of [0, 1] the few next to it.
struct IndexRange {
  int first, last;
};
IndexRange nonzero(const Basis& basis, int p, int order) {
  const auto is_zero = [&](int i) {
    for (int k = 0; k <= order; ++k) {
      if (basis.value[k][i] != 0) return false;
    }
    return true;
  };
  IndexRange range{0, p};
  while (range.first < range.last && is_zero(range.first)) ++range.first;
  while (range.first < range.last && is_zero(range.last)) --range.last;
  return range;
}

template <int Order>
using Derivatives = std::array<std::array<dvec4, Order + 1>, Order + 1>;

/// Homogeneous partial derivatives d[k][l] with k + l <= Order; degrees are known when compiling
/// (>= 0) or not (-1).
template <int Order, int P = -1, int Q = -1>
Derivatives<Order> homogeneous_derivatives(const BezierPatch& patch, double u, double v) {
  const int p = P >= 0 ? P : patch.degree_u;
  const int q = Q >= 0 ? Q : patch.degree_v;
  Basis bu, bv;
  bernstein<P>(p, u, Order, bu);
  bernstein<Q>(q, v, Order, bv);
  const IndexRange in_u = nonzero(bu, p, Order);
  const IndexRange in_v = nonzero(bv, q, Order);
  Derivatives<Order> d{};
  for (int i = in_u.first; i <= in_u.last; ++i) {
    const dvec4* row = patch.points.data() + i * (q + 1);
    std::array<dvec4, Order + 1> along_v{};
    for (int j = in_v.first; j <= in_v.last; ++j) {
      for (int l = 0; l <= Order; ++l) along_v[l] += bv.value[l][j] * row[j];
    }
    for (int k = 0; k <= Order; ++k) {
      for (int l = 0; k + l <= Order; ++l) d[k][l] += bu.value[k][i] * along_v[l];
    }
  }
  return d;
}

/// Those of common degrees are compiled for them.
template <int Order>
Derivatives<Order> with_known_degrees(const BezierPatch& patch, double u, double v) {
  const auto is = [&](int p, int q) { return patch.degree_u == p && patch.degree_v == q; };
  if (is(3, 3)) return homogeneous_derivatives<Order, 3, 3>(patch, u, v);
  if (is(4, 4)) return homogeneous_derivatives<Order, 4, 4>(patch, u, v);
  return homogeneous_derivatives<Order>(patch, u, v);
}

template <int Order>
using EuclideanDerivatives = std::array<std::array<dvec3, Order + 1>, Order + 1>;

/// Partial derivatives of the quotient X / w by Leibniz' rule: X = S w gives, for each order,
/// S_kl w = X_kl - sum over the terms in which w is differentiated.
template <int Order>
EuclideanDerivatives<Order> quotient(const Derivatives<Order>& d) {
  static constexpr int binomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  EuclideanDerivatives<Order> S;
  for (int k = 0; k <= Order; ++k) {
    for (int l = 0; k + l <= Order; ++l) {
      dvec3 x(d[k][l]);
      for (int a = 0; a <= k; ++a) {
        for (int b = 0; b <= l; ++b) {
          if (a + b == 0) continue;
          x -= double(binomial[k][a] * binomial[l][b]) * d[a][b].w * S[k - a][l - b];
        }
      }
      S[k][l] = x / d[0][0].w;
    }
  }
  return S;
}

template <int Order>
EuclideanDerivatives<Order> euclidean_derivatives(const BezierPatch& patch, double u, double v) {
  const Derivatives<Order> d = with_known_degrees<Order>(patch, u, v);
  if (!is_polynomial(patch.points)) return quotient<Order>(d);
  EuclideanDerivatives<Order> S;
  const double w = patch.points.front().w;
  for (int k = 0; k <= Order; ++k) {
    for (int l = 0; k + l <= Order; ++l) S[k][l] = dvec3(d[k][l]) / w;
  }
  return S;
}

/// Control points of the part over [0, t] by de Casteljau, in place.
void keep_left(dvec4* p, int degree, std::ptrdiff_t stride, double t) {
  for (int r = 1; r <= degree; ++r) {
    for (int i = degree; i >= r; --i) {
      p[i * stride] = (1 - t) * p[(i - 1) * stride] + t * p[i * stride];
    }
  }
}

void keep_right(dvec4* p, int degree, std::ptrdiff_t stride, double t) {
  for (int r = 1; r <= degree; ++r) {
    for (int i = 0; i <= degree - r; ++i) {
      p[i * stride] = (1 - t) * p[i * stride] + t * p[(i + 1) * stride];
    }
  }
}

void keep(dvec4* p, int degree, std::ptrdiff_t stride, Interval t) {
  if (t.upper < 1) keep_left(p, degree, stride, t.upper);
  if (t.lower > 0) keep_right(p, degree, stride, t.lower / t.upper);
}

/// One step of degree elevation along a strided run of degree + 1 points.
void elevate_once(const dvec4* from, dvec4* to, int degree, std::ptrdiff_t stride) {
  to[0] = from[0];
  for (int i = 1; i <= degree; ++i) {
    const double a = double(i) / (degree + 1);
    to[i * stride] = a * from[(i - 1) * stride] + (1 - a) * from[i * stride];
  }
  to[(degree + 1) * stride] = from[degree * stride];
}

/// Norm bounds of a homogeneous difference vector. A k-fold difference of numbers of size m is off
/// by at most 2^k k rounding units of m, which `rounding` adds.
void include(HomogeneousBound& bound, const dvec4& d) {
  bound.space = std::max(bound.space, glm::length(dvec3(d)));
  bound.weight = std::max(bound.weight, std::abs(d.w));
}

HomogeneousBound scaled(const HomogeneousBound& b, double factor, const std::vector<dvec4>& points,
                        double differences) {
  HomogeneousBound magnitude;
  for (const dvec4& p : points) include(magnitude, p);
  const double rounding = differences * std::exp2(differences) * rounding_unit;
  const double up = 1 + 8 * rounding_unit;
  return {factor * (b.space + rounding * magnitude.space) * up,
          factor * (b.weight + (is_polynomial(points) ? 0 : rounding * magnitude.weight)) * up};
}

/// Tells normals from rounding: tangents are differences of control points, so the rounding of the
/// points' coordinates is what they may consist of, wherever the patch lies.
class NormalNoise {
 public:
  explicit NormalNoise(const BezierPatch& patch) {
    double size = 0;
    for (const dvec4& p : patch.points) {
      size = std::max(size, std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) / p.w);
    }
    u_ = roundings * rounding_unit * patch.degree_u * size;
    v_ = roundings * rounding_unit * patch.degree_v * size;
  }

  /// The unit normal, or zero where it may be rounding.
  dvec3 cleaned_normal(const PatchJet1& j) const {
    const double su = glm::length(j.Su);
    const double sv = glm::length(j.Sv);
    const dvec3 N = glm::cross(j.Su, j.Sv);
    const double noise = su * v_ + sv * u_ + roundings * rounding_unit * su * sv;
    return glm::length(N) > noise ? unit(N) : dvec3(0.0);
  }

  /// Whether a derivative of N is well above its rounding, enough for ten good digits or so.
  bool is_certain_derivative(const dvec3& derivative, const PatchJet2& j) const {
    const double largest = std::max({glm::length(j.Su), glm::length(j.Sv), glm::length(j.Suu),
                                     glm::length(j.Suv), glm::length(j.Svv)});
    const double noise = (u_ + v_ + roundings * rounding_unit * largest) * largest;
    return glm::length(derivative) > 1024 * noise;
  }

 private:
  static constexpr double roundings = 64;  ///< that a derivative of a Bernstein sum gathers
  double u_, v_;
};

}  // namespace

bool is_polynomial(const std::vector<dvec4>& points) {
  return std::all_of(points.begin(), points.end(),
                     [&](const dvec4& p) { return p.w == points.front().w; });
}

void validate_points(const std::vector<dvec4>& points, const std::string& name) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec4& p = points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(p.w)) {
      throw InvalidInput(name + ": control point " + std::to_string(i) + " is not finite");
    }
    if (!(p.w > 0)) {
      throw InvalidInput(name + ": the weight of control point " + std::to_string(i) +
                         " is not positive");
    }
  }
  const auto lighter = [](const dvec4& a, const dvec4& b) { return a.w < b.w; };
  const auto [least, most] = std::minmax_element(points.begin(), points.end(), lighter);
  if (!points.empty() && most->w / least->w > max_weight_ratio) {
    throw InvalidInput(
        name + ": the weights of control points " + std::to_string(least - points.begin()) +
        " and " + std::to_string(most - points.begin()) + " differ by a factor of more than 1e12");
  }
}

void validate_degree(int degree, const std::string& name) {
  if (degree < 1 || degree > max_degree) {
    throw InvalidInput(name + ": degree " + std::to_string(degree) + " is not between 1 and " +
                       std::to_string(max_degree));
  }
}

void validate(const BezierCurve& curve, const std::string& name) {
  validate_degree(curve.degree(), name);
  validate_points(curve.points, name);
}

void validate(const BezierPatch& patch, const std::string& name) {
  validate_degree(patch.degree_u, name);
  validate_degree(patch.degree_v, name);
  const auto expected =
      static_cast<std::size_t>(patch.degree_u + 1) * static_cast<std::size_t>(patch.degree_v + 1);
  if (patch.points.size() != expected) {
    throw InvalidInput(name + ": " + std::to_string(patch.points.size()) + " control points, not " +
                       std::to_string(expected));
  }
  validate_points(patch.points, name);
}

dvec3 point(const BezierCurve& curve, double t) {
  Basis b;
  bernstein(curve.degree(), t, 0, b);
  dvec4 x(0.0);
  for (int i = 0; i <= curve.degree(); ++i) x += b.value[0][i] * curve.points[std::size_t(i)];
  return euclidean(x);
}

CurveJet jet(const BezierCurve& curve, double t) {
  Basis b;
  bernstein(curve.degree(), t, 3, b);
  Derivatives<3> d{};
  for (int i = 0; i <= curve.degree(); ++i) {
    for (int k = 0; k <= 3; ++k) d[k][0] += b.value[k][i] * curve.points[std::size_t(i)];
  }
  const auto c = quotient<3>(d);
  return {c[0][0], c[1][0], c[2][0], c[3][0]};
}

dvec3 point(const BezierPatch& patch, double u, double v) {
  return euclidean(homogeneous_derivatives<0>(patch, u, v)[0][0]);
}

PatchJet1 jet1(const BezierPatch& patch, double u, double v) {
  const auto S = euclidean_derivatives<1>(patch, u, v);
  return {S[0][0], S[1][0], S[0][1]};
}

PatchJet2 jet2(const BezierPatch& patch, double u, double v) {
  const auto S = euclidean_derivatives<2>(patch, u, v);
  return {{S[0][0], S[1][0], S[0][1]}, S[2][0], S[1][1], S[0][2]};
}

PatchJet3 jet3(const BezierPatch& patch, double u, double v) {
  const auto S = euclidean_derivatives<3>(patch, u, v);
  return {
      {{S[0][0], S[1][0], S[0][1]}, S[2][0], S[1][1], S[0][2]}, S[3][0], S[2][1], S[1][2], S[0][3]};
}

dvec3 unit_normal(const BezierPatch& patch, double u, double v) {
  const NormalNoise noise(patch);
  const dvec3 N = noise.cleaned_normal(jet1(patch, u, v));
  if (N != dvec3(0.0)) return N;

  const PatchJet2 j = jet2(patch, u, v);
  // N vanishes: its derivative along the line to the centre points where the limit does.
  const dvec2 inward = dvec2(0.5) - dvec2(u, v);
  const dvec3 Nu = glm::cross(j.Suu, j.Sv) + glm::cross(j.Su, j.Suv);
  const dvec3 Nv = glm::cross(j.Suv, j.Sv) + glm::cross(j.Su, j.Svv);
  const dvec3 along = inward.x * Nu + inward.y * Nv;
  if (noise.is_certain_derivative(along, j)) return unit(along);

  // So does the derivative: N(s) = s^k (a + O(s)), and two points at halved distances extrapolate
  // the direction of a to second order in s.
  constexpr double s = 0x1p-12;
  const auto normal_at = [&](double t) {
    return noise.cleaned_normal(jet1(patch, u + t * inward.x, v + t * inward.y));
  };
  return unit(2.0 * normal_at(s) - normal_at(2 * s));
}

BezierCurve elevated(const BezierCurve& curve, int degree) {
  BezierCurve result = curve;
  while (result.degree() < degree) {
    std::vector<dvec4> next(result.points.size() + 1);
    elevate_once(result.points.data(), next.data(), result.degree(), 1);
    result.points = std::move(next);
  }
  return result;
}

BezierPatch elevated(const BezierPatch& patch, int degree_u, int degree_v) {
  BezierPatch result = patch;
  while (result.degree_v < degree_v) {
    BezierPatch next{result.degree_u, result.degree_v + 1, {}};
    next.points.resize(result.points.size() + static_cast<std::size_t>(result.degree_u) + 1);
    for (int i = 0; i <= result.degree_u; ++i) {
      elevate_once(&result.at(i, 0), &next.at(i, 0), result.degree_v, 1);
    }
    result = std::move(next);
  }
  if (result.degree_u < degree_u) {
    result = transposed(elevated(transposed(result), result.degree_v, degree_u));
  }
  return result;
}

BezierCurve restricted(const BezierCurve& curve, Interval t) {
  BezierCurve result = curve;
  keep(result.points.data(), result.degree(), 1, t);
  return result;
}

BezierPatch restricted(const BezierPatch& patch, Interval u, Interval v) {
  BezierPatch result = patch;
  const std::ptrdiff_t row = patch.degree_v + 1;
  for (int j = 0; j <= patch.degree_v; ++j) keep(&result.at(0, j), patch.degree_u, row, u);
  for (int i = 0; i <= patch.degree_u; ++i) keep(&result.at(i, 0), patch.degree_v, 1, v);
  return result;
}

BezierCurve reversed(const BezierCurve& curve) {
  return {{curve.points.rbegin(), curve.points.rend()}};
}

BezierPatch transposed(const BezierPatch& patch) {
  BezierPatch result{patch.degree_v, patch.degree_u, std::vector<dvec4>(patch.points.size())};
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) result.at(j, i) = patch.at(i, j);
  }
  return result;
}

BezierCurve border(const BezierPatch& patch, Side side) {
  BezierCurve curve;
  if (side == Side::u0 || side == Side::u1) {
    const int i = side == Side::u0 ? 0 : patch.degree_u;
    for (int j = 0; j <= patch.degree_v; ++j) curve.points.push_back(patch.at(i, j));
  } else {
    const int j = side == Side::v0 ? 0 : patch.degree_v;
    for (int i = 0; i <= patch.degree_u; ++i) curve.points.push_back(patch.at(i, j));
  }
  return curve;
}

HomogeneousBound second_derivative_bound(const BezierCurve& curve) {
  HomogeneousBound bound;
  const auto& p = curve.points;
  for (std::size_t i = 2; i < p.size(); ++i) include(bound, p[i] - 2.0 * p[i - 1] + p[i - 2]);
  const int d = curve.degree();
  return scaled(bound, d * (d - 1), p, 2);
}

HomogeneousBound second_derivative_bound(const BezierPatch& patch, Direction direction) {
  HomogeneousBound bound;
  const bool along_u = direction == Direction::u;
  const int degree = along_u ? patch.degree_u : patch.degree_v;
  for (int i = along_u ? 2 : 0; i <= patch.degree_u; ++i) {
    for (int j = along_u ? 0 : 2; j <= patch.degree_v; ++j) {
      include(bound, along_u ? patch.at(i, j) - 2.0 * patch.at(i - 1, j) + patch.at(i - 2, j)
                             : patch.at(i, j) - 2.0 * patch.at(i, j - 1) + patch.at(i, j - 2));
    }
  }
  return scaled(bound, degree * (degree - 1), patch.points, 2);
}

HomogeneousBound mixed_derivative_bound(const BezierPatch& patch) {
  HomogeneousBound bound;
  for (int i = 2; i <= patch.degree_u; ++i) {
    for (int j = 2; j <= patch.degree_v; ++j) {
      const auto along_u = [&](int k) {
        return patch.at(i, k) - 2.0 * patch.at(i - 1, k) + patch.at(i - 2, k);
      };
      include(bound, along_u(j) - 2.0 * along_u(j - 1) + along_u(j - 2));
    }
  }
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  return scaled(bound, p * (p - 1) * q * (q - 1), patch.points, 4);
}

}  // namespace taut
