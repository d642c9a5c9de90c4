#include "taut/subdivision/point_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace taut {
namespace {

constexpr std::size_t leaf_size = 8;

dvec3 mean(const std::vector<dvec3>& points) {
  dvec3 sum(0.0);
  for (const dvec3& p : points) sum += p / double(points.size());
  return sum;
}

/// The principal axes of the points about a centre, orthonormal to rounding, as columns.
dmat3 principal_axes(const std::vector<dvec3>& points, const dvec3& centre) {
  double size = 0;
  for (const dvec3& p : points) size = std::max(size, glm::distance(p, centre));
  if (size == 0) return dmat3(1.0);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const dvec3& p : points) {
    const dvec3 d = (p - centre) / size;
    const Eigen::Vector3d v(d.x, d.y, d.z);
    covariance += v * v.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  dmat3 result;
  for (int k = 0; k < 3; ++k) result[k] = dvec3(axes(0, k), axes(1, k), axes(2, k));
  return result;
}

}  // namespace

PointTree::Range PointTree::Range::child(bool upper) const {
  const std::size_t middle = begin + (end - begin) / 2;
  return upper ? Range{middle, end, 2 * node + 2} : Range{begin, middle, 2 * node + 1};
}

bool PointTree::Range::is_leaf() const { return end - begin <= leaf_size; }

PointTree::PointTree(std::vector<dvec3> points) : points_(std::move(points)) {
  if (empty()) return;
  centre_ = mean(points_);
  axes_ = principal_axes(points_, centre_);
  build({0, points_.size(), 0});
}

void PointTree::build(const Range& range) {
  Box box;
  for (std::size_t k = range.begin; k < range.end; ++k) box.include(to_frame(points_[k]));
  if (boxes_.size() <= range.node) boxes_.resize(range.node + 1);
  boxes_[range.node] = box;
  if (range.is_leaf()) return;
  const dvec3 size = box.upper - box.lower;
  const dvec3& axis = axes_[size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2];
  const auto at = [&](std::size_t k) { return points_.begin() + std::ptrdiff_t(k); };
  std::nth_element(
      at(range.begin), at(range.child(true).begin), at(range.end),
      [&axis](const dvec3& a, const dvec3& b) { return glm::dot(axis, a) < glm::dot(axis, b); });
  for (const bool upper : {false, true}) build(range.child(upper));
}

/// Boxes whose bound is not below the least value so far are passed over.
template <typename OfBox, typename OfPoint>
void PointTree::search(const Range& range, const OfBox& of_box, const OfPoint& of_point,
                       double& least, std::size_t& found) const {
  if (range.is_leaf()) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const double value = of_point(points_[k]);
      if (value < least) {
        least = value;
        found = k;
      }
    }
    return;
  }
  const std::array<Range, 2> children = {range.child(false), range.child(true)};
  const std::array<double, 2> bounds = {of_box(boxes_[children[0].node]),
                                        of_box(boxes_[children[1].node])};
  const std::size_t first = bounds[0] <= bounds[1] ? 0 : 1;
  for (const std::size_t k : {first, 1 - first}) {
    if (bounds[k] < least) search(children[k], of_box, of_point, least, found);
  }
}

template <typename OfBox, typename OfPoint>
dvec3 PointTree::least(const OfBox& of_box, const OfPoint& of_point) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t found = 0;
  search({0, points_.size(), 0}, of_box, of_point, least, found);
  return points_[found];
}

dvec3 PointTree::nearest(const dvec3& p) const {
  const auto square = [](const dvec3& d) { return glm::dot(d, d); };
  const dvec3 in_frame = to_frame(p);
  return least(
      [&](const Box& box) { return square(glm::clamp(in_frame, box.lower, box.upper) - in_frame); },
      [&](const dvec3& q) { return square(q - p); });
}

dvec3 PointTree::lowest(const dvec3& direction) const {
  const dvec3 in_frame = direction * axes_;
  const auto upper = glm::lessThan(in_frame, dvec3(0.0));
  return least(
      [&](const Box& box) { return glm::dot(in_frame, glm::mix(box.lower, box.upper, upper)); },
      [&](const dvec3& q) { return glm::dot(direction, q - centre_); });
}

}  // namespace taut
