#include "taut/bounds/normal_net.h"

#include <algorithm>

#include "taut/bounds/scaled_net.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Of a control point that was turned, moved or multiplied by its weight, as a share of its size:
/// three products and sums.
constexpr double stored_rounding = 4 * rounding_unit;

/// Su x Sv / (p q) from differences of the control points.
NormalNet polynomial_net(const BezierPatch& patch, const std::vector<dvec3>& x) {
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  const auto point = [&](int i, int j) { return x[patch.index(i, j)]; };
  double longest_u = 0;
  double longest_v = 0;
  const auto u = scaled<dvec3>({p - 1, q}, [&](int i, int j) {
    const dvec3 d = point(i + 1, j) - point(i, j);
    longest_u = std::max(longest_u, glm::length(d));
    return d;
  });
  const auto v = scaled<dvec3>({p, q - 1}, [&](int i, int j) {
    const dvec3 d = point(i, j + 1) - point(i, j);
    longest_v = std::max(longest_v, glm::length(d));
    return d;
  });
  ScaledNet<dvec3> sum({2 * p - 1, 2 * q - 1});
  add_product(u, v, 0, 0, sum, [](const dvec3& a, const dvec3& b) { return glm::cross(a, b); });
  NormalNet net{sum.shape, unscaled(sum), 0};
  // Each is a mean of products, of at most p (q + 1) terms: as many roundings of the sum, one of
  // each difference, two of each binomial factor and three of the cross product's components, by
  // a factor of sqrt(3) for their length; twice that for good measure.
  net.rounding_bound = 2 * 1.75 * (p * (q + 1) + 12) * rounding_unit * longest_u * longest_v;
  // A control point that was turned or moved is off by a few units of its size.
  double size = 0;
  for (const dvec3& c : x) size = std::max(size, glm::length(c));
  net.rounding_bound += 2 * stored_rounding * size * (longest_u + longest_v);
  return net;
}

/// The wedge of two homogeneous points: their moment and difference.
struct Wedge {
  dvec3 moment = dvec3(0.0);
  dvec3 difference = dvec3(0.0);
  Wedge& operator+=(const Wedge& other) {
    moment += other.moment;
    difference += other.difference;
    return *this;
  }
};

Wedge wedge(const dvec4& a, const dvec4& b) {
  return {glm::cross(dvec3(a), dvec3(b)), a.w * dvec3(b) - b.w * dvec3(a)};
}

/// The normal of the plane through three homogeneous points.
dvec3 plane_normal(const Wedge& ab, const dvec4& c) {
  return c.w * ab.moment + glm::cross(ab.difference, dvec3(c));
}

/// With X the homogeneous point, the normal is the space part of X ^ Xu ^ Xv: w^3 Su x Sv. Written
/// as X = (1-u)(1-v) a + u (1-v) b + (1-u) v c + u v d with nets of degrees (p - 1, q - 1), its
/// derivatives are p and q times those with a, b, c, d held fixed, and the wedge is p q times
///     (1-u)(1-v) abc + u (1-v) abd + (1-u) v dca + u v dcb,
/// two degrees less in each direction than the product of the three.
NormalNet rational_net(const BezierPatch& patch, const std::vector<dvec4>& x) {
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  const NetShape shape{p - 1, q - 1};
  const auto part = [&](int di, int dj) {
    return scaled<dvec4>(shape, [&](int i, int j) { return x[patch.index(i + di, j + dj)]; });
  };
  const auto a = part(0, 0);
  const auto b = part(1, 0);
  const auto c = part(0, 1);
  const auto d = part(1, 1);
  ScaledNet<Wedge> ab({2 * p - 2, 2 * q - 2});
  ScaledNet<Wedge> dc(ab.shape);
  add_product(a, b, 0, 0, ab, wedge);
  add_product(d, c, 0, 0, dc, wedge);
  ScaledNet<dvec3> sum({3 * p - 2, 3 * q - 2});
  add_product(ab, c, 0, 0, sum, plane_normal);
  add_product(ab, d, 1, 0, sum, plane_normal);
  add_product(dc, a, 0, 1, sum, plane_normal);
  add_product(dc, b, 1, 1, sum, plane_normal);
  NormalNet net{sum.shape, unscaled(sum), 0};
  double reach = 0;
  double weight = 0;
  for (const dvec4& point : x) {
    reach = std::max(reach, glm::length(dvec3(point)));
    weight = std::max(weight, point.w);
  }
  // Each is a mean of triple products, whose three terms are at most weight reach^2: the roundings
  // of two sums of up to p q terms, of the products and of the binomial factors; twice that for
  // good measure.
  net.rounding_bound = 2 * 1.75 * 3 * (2 * p * q + 24) * rounding_unit * weight * reach * reach;
  double size = 0;
  for (const dvec4& point : patch.points) size = std::max(size, glm::length(dvec3(point)));
  net.rounding_bound += 6 * stored_rounding * size * weight * reach;
  return net;
}

}  // namespace

NormalNet normal_net(const BezierPatch& patch) {
  if (is_polynomial(patch.points)) {
    std::vector<dvec3> points;
    for (const dvec4& p : patch.points) points.push_back(euclidean(p));
    return polynomial_net(patch, points);
  }
  Box box;
  for (const dvec4& p : patch.points) box.include(euclidean(p));
  const dvec3 center = box.center();
  std::vector<dvec4> points = patch.points;
  for (dvec4& p : points) p -= dvec4(p.w * center, 0.0);
  return rational_net(patch, points);
}

}  // namespace taut
