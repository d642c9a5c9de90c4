#include "taut/surface/flatness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// The one of the points that is farthest by this measure.
template <class Measure>
dvec3 farthest(const std::vector<dvec4>& points, const Measure& measure) {
  dvec3 result = euclidean(points.front());
  for (const dvec4& p : points) {
    if (measure(euclidean(p)) > measure(result)) result = euclidean(p);
  }
  return result;
}

/// Largest absolute space coordinate and weight of the homogeneous points.
HomogeneousBound largest_entries(const std::vector<dvec4>& points) {
  HomogeneousBound result;
  for (const dvec4& p : points) {
    result.space = std::max({result.space, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    result.weight = std::max(result.weight, p.w);
  }
  return result;
}

/// Scaled so that products of coordinates neither over- nor underflow.
BezierPatch of_unit_size(BezierPatch patch) {
  const double size = largest_coordinate(patch.points);
  if (size == 0) return patch;
  for (dvec4& p : patch.points) p = {dvec3(p) / size, p.w};
  return patch;
}

/// What the rounding of a patch's control points may do to its derivatives.
class DerivativeRounding {
 public:
  explicit DerivativeRounding(const BezierPatch& patch) {
    const auto [least, most] =
        std::minmax_element(patch.points.begin(), patch.points.end(),
                            [](const dvec4& a, const dvec4& b) { return a.w < b.w; });
    const double ratio = most->w / least->w;
    const double rounding = coordinate_rounding * largest_coordinate(patch.points) * ratio;
    const double p = patch.degree_u;
    const double q = patch.degree_v;
    u_ = 2 * p * rounding;
    v_ = 2 * q * rounding;
    // Weights enter the second derivatives once more.
    uu_ = 4 * p * p * rounding * ratio;
    uv_ = 4 * p * q * rounding * ratio;
    vv_ = 4 * q * q * rounding * ratio;
  }

  /// The second fundamental form's determinant is zero up to rounding. @pre n is the unit normal
  bool may_be_parabolic(const PatchJet2& j, const dvec3& n) const {
    const double area = glm::length(glm::cross(j.Su, j.Sv));
    const double turn = (u_ * glm::length(j.Sv) + v_ * glm::length(j.Su)) / area;
    const double L = glm::dot(j.Suu, n);
    const double M = glm::dot(j.Suv, n);
    const double N = glm::dot(j.Svv, n);
    const double eL = uu_ + turn * glm::length(j.Suu);
    const double eM = uv_ + turn * glm::length(j.Suv);
    const double eN = vv_ + turn * glm::length(j.Svv);
    return std::abs(L * N - M * M) <=
           eL * std::abs(N) + eN * std::abs(L) + 2 * eM * std::abs(M) + eL * eN + eM * eM;
  }

 private:
  double u_, v_, uu_, uv_, vv_;
};

/// Places in each parameter, times the degree, at which a plane patch is looked at for folds.
constexpr int fold_places = 4;

/// Of a plane patch without weights: each step along u between control points turns to each along v
/// in one sense, if at all. The coefficients of Su x Sv are sums of the products of these.
bool steps_go_one_way_around(const BezierPatch& patch) {
  const auto same_weight = [&](const dvec4& p) { return p.w == patch.points.front().w; };
  if (!std::all_of(patch.points.begin(), patch.points.end(), same_weight)) return false;
  std::vector<dvec3> along_u, along_v;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const dvec3 x(patch.at(i, j));
      if (i < patch.degree_u) along_u.push_back(dvec3(patch.at(i + 1, j)) - x);
      if (j < patch.degree_v) along_v.push_back(dvec3(patch.at(i, j + 1)) - x);
    }
  }
  dvec3 first(0.0);
  for (const dvec3& u : along_u) {
    for (const dvec3& v : along_v) {
      const dvec3 n = glm::cross(u, v);
      if (first == dvec3(0.0)) first = n;
      if (glm::dot(first, n) < 0) return false;
    }
  }
  return true;
}

}  // namespace

double largest_coordinate(const std::vector<dvec4>& points) {
  double result = 0;
  for (const dvec4& p : points) {
    const dvec3 x = glm::abs(euclidean(p));
    result = std::max({result, x.x, x.y, x.z});
  }
  return result;
}

bool is_straight(const BezierCurve& curve) {
  const double tolerance = ruled_rounding * largest_coordinate(curve.points);
  const dvec3 first = euclidean(curve.points.front());
  const dvec3 last =
      farthest(curve.points, [&](const dvec3& p) { return glm::distance(p, first); });
  const dvec3 along = unit(last - first);
  return std::all_of(curve.points.begin(), curve.points.end(), [&](const dvec4& p) {
    return glm::length(glm::cross(euclidean(p) - first, along)) <= tolerance;
  });
}

bool is_ruled(const BezierPatch& patch, Direction direction) {
  if (direction == Direction::v) return is_ruled(transposed(patch), Direction::u);
  const HomogeneousBound largest = largest_entries(patch.points);
  for (int i = 2; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const dvec4 d = glm::abs(patch.at(i, j) - 2.0 * patch.at(i - 1, j) + patch.at(i - 2, j));
      if (std::max({d.x, d.y, d.z}) > ruled_rounding * largest.space) return false;
      if (d.w > ruled_rounding * largest.weight) return false;
    }
  }
  return true;
}

bool is_folded(const BezierPatch& original) {
  const BezierPatch patch = of_unit_size(original);
  if (steps_go_one_way_around(patch)) return false;
  const int mu = fold_places * patch.degree_u;
  const int mv = fold_places * patch.degree_v;
  std::vector<dvec3> before(to_size(mv + 1), dvec3(0.0));
  for (int i = 0; i <= mu; ++i) {
    for (int k = 0; k <= mv; ++k) {
      const PatchJet1 j = jet1(patch, (i + 0.5) / (mu + 1), (k + 0.5) / (mv + 1));
      const dvec3 n = glm::cross(j.Su, j.Sv);
      if (i > 0 && glm::dot(n, before[to_size(k)]) < 0) return true;
      if (k > 0 && glm::dot(n, before[to_size(k - 1)]) < 0) return true;
      before[to_size(k)] = n;
    }
  }
  return false;
}

bool is_developable(const BezierPatch& original) {
  const BezierPatch patch = of_unit_size(original);
  const DerivativeRounding rounding(patch);
  // In u and v the degrees of the numerator, a polynomial in fourfold products of the homogeneous
  // control points and their derivatives squared, are no more than this.
  const int mu = 8 * patch.degree_u - 4;
  const int mv = 8 * patch.degree_v - 4;
  const auto inside = [](int k, int m) {
    return 0.5 - 0.5 * std::cos(std::numbers::pi * (k + 0.5) / (m + 1));
  };
  std::vector<dvec3> before(to_size(mv + 1), dvec3(0.0));
  for (int i = 0; i <= mu; ++i) {
    for (int k = 0; k <= mv; ++k) {
      const PatchJet2 j = jet2(patch, inside(i, mu), inside(k, mv));
      const dvec3 n = unit(glm::cross(j.Su, j.Sv));
      if (n == dvec3(0.0) || !rounding.may_be_parabolic(j, n)) return false;
      // Normals turn little from one place to the next unless there is a fold between them.
      if (i > 0 && glm::dot(n, before[to_size(k)]) <= 0) return false;
      if (k > 0 && glm::dot(n, before[to_size(k - 1)]) <= 0) return false;
      before[to_size(k)] = n;
    }
  }
  return true;
}

double distance_from_segment(const BezierCurve& curve) {
  const dvec3 first = euclidean(curve.points.front());
  const dvec3 segment = euclidean(curve.points.back()) - first;
  const double square = glm::dot(segment, segment);
  double farthest = 0;
  for (const dvec4& p : curve.points) {
    const dvec3 x = euclidean(p) - first;
    const double share = square > 0 ? std::clamp(glm::dot(x, segment) / square, 0.0, 1.0) : 0;
    farthest = std::max(farthest, glm::length(x - share * segment));
  }
  return farthest;
}

double distance_from_plane(const BezierPatch& patch) {
  const dvec3 a = euclidean(patch.points.front());
  const dvec3 b = farthest(patch.points, [&](const dvec3& p) { return glm::distance(p, a); });
  const dvec3 ab = unit(b - a);
  const dvec3 c =
      farthest(patch.points, [&](const dvec3& p) { return glm::length(glm::cross(p - a, ab)); });
  const dvec3 n = unit(glm::cross(ab, c - a));
  double largest = 0;
  for (const dvec4& p : patch.points) {
    largest = std::max(largest, std::abs(glm::dot(euclidean(p) - a, n)));
  }
  return largest;
}

bool is_plane(const BezierPatch& patch) {
  return distance_from_plane(patch) <= ruled_rounding * largest_coordinate(patch.points);
}

BezierCurve parameter_curve(const BezierPatch& patch, Direction direction, double s) {
  const bool of_u = direction == Direction::u;
  if (s <= 0) return border(patch, of_u ? Side::u0 : Side::v0);
  const Interval below{0, s};
  return of_u ? border(restricted(patch, below, {}), Side::u1)
              : border(restricted(patch, {}, below), Side::v1);
}

}  // namespace taut
