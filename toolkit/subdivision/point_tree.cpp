#include "taut/subdivision/point_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace taut {
namespace {

constexpr std::size_t leaf_size = 8;

}  // namespace

PointTree::Range PointTree::Range::child(bool upper) const {
  const std::size_t middle = begin + (end - begin) / 2;
  return upper ? Range{middle, end, 2 * node + 2} : Range{begin, middle, 2 * node + 1};
}

bool PointTree::Range::is_leaf() const { return end - begin <= leaf_size; }

PointTree::PointTree(std::vector<dvec3> points) : points_(std::move(points)) {
  if (!empty()) build({0, points_.size(), 0});
}

void PointTree::build(const Range& range) {
  Box box;
  for (std::size_t k = range.begin; k < range.end; ++k) box.include(points_[k]);
  if (boxes_.size() <= range.node) boxes_.resize(range.node + 1);
  boxes_[range.node] = box;
  if (range.is_leaf()) return;
  const dvec3 size = box.upper - box.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto at = [&](std::size_t k) { return points_.begin() + std::ptrdiff_t(k); };
  std::nth_element(at(range.begin), at(range.child(true).begin), at(range.end),
                   [axis](const dvec3& a, const dvec3& b) { return a[axis] < b[axis]; });
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
  const auto square = [&p](const dvec3& q) { return glm::dot(q - p, q - p); };
  return least([&](const Box& box) { return square(glm::clamp(p, box.lower, box.upper)); }, square);
}

dvec3 PointTree::lowest(const dvec3& direction) const {
  return least(
      [&](const Box& box) {
        return glm::dot(direction,
                        glm::mix(box.lower, box.upper, glm::lessThan(direction, dvec3(0.0))));
      },
      [&](const dvec3& q) { return glm::dot(direction, q); });
}

}  // namespace taut
