#include "taut/hull/planar/planar_tree.h"

#include <algorithm>

namespace taut {

PlanarBox::PlanarBox(const std::vector<dvec2>& points) : lower(points[0]), upper(points[0]) {
  for (const dvec2& p : points) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
}

PlanarTree::PlanarTree(std::vector<Entry> entries) {
  nodes_.reserve(2 * entries.size());
  if (!entries.empty()) root_ = build(entries);
}

/// Halves them at the middle one along the longer side of the box of all middles.
int PlanarTree::build(std::span<Entry> entries) {
  if (entries.size() == 1) {
    nodes_.push_back({entries[0].box, entries[0].number, {-1, -1}});
    return int(nodes_.size()) - 1;
  }
  const auto middle = [](const Entry& e) { return e.box.lower + e.box.upper; };
  std::vector<dvec2> middles;
  middles.reserve(entries.size());
  for (const Entry& e : entries) middles.push_back(middle(e));
  const PlanarBox spread(middles);
  const dvec2 size = spread.upper - spread.lower;
  const int axis = size.y > size.x ? 1 : 0;
  const std::size_t half = entries.size() / 2;
  std::nth_element(entries.begin(), entries.begin() + std::ptrdiff_t(half), entries.end(),
                   [&](const Entry& a, const Entry& b) {
                     const double at = middle(a)[axis];
                     const double other = middle(b)[axis];
                     return at < other || (at == other && a.number < b.number);
                   });
  const int left = build(entries.first(half));
  const int right = build(entries.subspan(half));
  const PlanarBox box(nodes_[std::size_t(left)].box, nodes_[std::size_t(right)].box);
  nodes_.push_back({box, -1, {left, right}});
  return int(nodes_.size()) - 1;
}

}  // namespace taut
