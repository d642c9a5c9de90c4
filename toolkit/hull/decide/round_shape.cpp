#include "taut/hull/decide/round_shape.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "taut/core/tolerances.h"
#include "taut/surface/bernstein.h"

namespace taut {
namespace {

/// Roundings that a control point goes through on its way into the frame of a shape, and in a
/// product with another.
constexpr int frame_roundings = 16;

/// A way t along which F = 0 is sought with F = g t - t^2 / r^2, where F / g = e and e / (g r^2) is
/// at most a quarter, is at most e (1 + 4 e / (g r^2)).
constexpr double most_bend = 0.25;

/// Of points where the shape is the unit sphere: bounds by coefficients of twice the degrees.
struct Norms {
  Interval squares;  ///< of the norm
  /// Of F = |y|^2 - 1 over a lower bound of the length of its gradient with respect to x; F is
  /// convex, and its gradient's length at a point of norm one is 2 |y / r|, r the radii, which lies
  /// between 2 / greatest and 2 / least, and so over the chord of the root of its square there.
  Interval shares;
};

Norms norms(NetShape net, const std::vector<dvec4>& points, const dvec3& radii, bool flat) {
  const NetShape twice{2 * net.p, 2 * net.q};
  std::vector<dvec3> products(std::size_t(twice.size()), dvec3(0.0));  // |y|^2, |y / r|^2, w^2
  const std::vector<double> of_u = binomials(net.p);
  const std::vector<double> of_v = binomials(net.q);
  const auto row = std::size_t(net.q + 1);
  const dvec3 counts(1, 1, flat ? 0 : 1);
  const dvec3 inverse = counts / glm::max(radii, dvec3(flat ? radii.y : 0));
  double largest = 0;
  for (std::size_t a = 0; a < points.size(); ++a) {
    const dvec4& x = points[a];
    largest = std::max(largest, glm::dot(dvec3(x), dvec3(x)) / (x.w * x.w));
    for (std::size_t b = 0; b < points.size(); ++b) {
      const dvec4& y = points[b];
      const double share = of_u[a / row] * of_u[b / row] * of_v[a % row] * of_v[b % row];
      const std::size_t k = (a / row + b / row) * std::size_t(twice.q + 1) + a % row + b % row;
      const dvec3 product = dvec3(x) * dvec3(y) * counts;
      products[k] += share * dvec3(product.x + product.y + product.z,
                                   glm::dot(product, inverse * inverse), x.w * y.w);
    }
  }
  const double rounding = (frame_roundings + net.size()) * rounding_unit * std::max(1.0, largest);
  const double least = std::min(inverse.x, flat ? inverse.y : std::min(inverse.y, inverse.z));
  const double most = std::max({inverse.x, inverse.y, inverse.z});
  Norms result{{infinity, -infinity}, {0, 0}};
  const auto include = [](Interval& range, double lower, double upper) {
    range.lower = std::min(range.lower, lower);
    range.upper = std::max(range.upper, upper);
  };
  for (const dvec3& k : products) {
    include(result.squares, k.x / k.z - rounding, k.x / k.z + rounding);
    const double slope = 2 * (k.y + least * most * k.x) / (least + most);
    const double value = k.x - k.z;
    const double off = rounding * k.z;
    if (slope > 0) include(result.shares, (value - off) / slope, (value + off) / slope);
    if (!(slope > 0)) include(result.shares, -infinity, infinity);
  }
  return result;
}

/// How far the points are from the plane of an ellipse.
double height(const std::vector<dvec4>& points) {
  double largest = 0;
  for (const dvec4& y : points) largest = std::max(largest, std::abs(y.z) / y.w);
  return largest;
}

}  // namespace

std::vector<dvec4> RoundShape::in_frame(std::span<const dvec4> net) const {
  std::vector<dvec4> result;
  for (const dvec4& p : net) {
    dvec3 y = (dvec3(p) - p.w * center) * axes;
    for (int k = 0; k < (is_flat() ? 2 : 3); ++k) y[k] /= radii[k];
    result.emplace_back(y, p.w);
  }
  return result;
}

/// Along the way from the centre points of norm n are off by the greatest radius times n - 1 at
/// most. Along its gradient, which grows with the norm, F changes by its length times the way, but
/// outwards for the square of the way over that of the least radius.
RoundShape::Distances RoundShape::distances(NetShape net, std::span<const dvec4> points) const {
  const std::vector<dvec4> own = in_frame(points);
  const Norms found = norms(net, own, radii, is_flat());
  const double off = is_flat() ? height(own) : 0;
  const double norm = std::max(1.0, std::sqrt(found.squares.upper));
  const double least_norm = std::min(1.0, std::sqrt(std::max(0.0, found.squares.lower)));
  const double inwards = std::min(greatest_radius() * (1 - least_norm), -found.shares.lower * norm);
  double outwards = greatest_radius() * (norm - 1);
  const double share = found.shares.upper * norm;
  const double bend = share * greatest_radius() / (least_radius() * least_radius());
  if (bend <= most_bend) outwards = std::min(outwards, share * (1 + bend / most_bend));
  return {std::hypot(off, inwards), std::hypot(off, outwards)};
}

bool RoundShape::surely_misses(const dvec3& point, double distance) const {
  const dvec3 x = (point - center) * axes;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(x[k]) > radii[k] + distance) return true;
  }
  return false;
}

bool RoundShape::is_touched_once(const std::array<dvec3, 4>& directions) const {
  dvec3 sum(0.0);
  for (const dvec3& d : directions) sum += root * d;
  return std::all_of(directions.begin(), directions.end(),
                     [&](const dvec3& d) { return glm::dot(root * d, sum) > 0; });
}

RoundShape mean_of(std::span<const RoundShape* const> shapes, std::span<const double> weights) {
  RoundShape mean;
  mean.kind = shapes.front()->kind;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    mean.center += weights[k] * shapes[k]->center;
    mean.root += weights[k] * shapes[k]->root;
    mean.inside += weights[k] * shapes[k]->inside;
  }
  Eigen::Matrix3d root;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) root(j, i) = mean.root[i][j];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(root);
  for (int k = 0; k < 3; ++k) {
    const auto axis = solver.eigenvectors().col(2 - k);
    mean.axes[k] = {axis.x(), axis.y(), axis.z()};
    mean.radii[k] = solver.eigenvalues()[2 - k];
  }
  // Planes of ellipses that differ make it an ellipsoid; without the least axis it is smaller.
  if (mean.is_flat()) mean.radii.z = 0;
  return mean;
}

}  // namespace taut
