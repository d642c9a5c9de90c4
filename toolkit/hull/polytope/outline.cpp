#include "taut/hull/polytope/outline.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "taut/core/predicates.h"

namespace taut {
namespace {

/// Extends a chain of points by one more, so that it turns left everywhere.
template <class Point>
void extend(std::vector<int>& chain, std::size_t first, int next, const Point& point) {
  while (chain.size() >= first + 2 &&
         orientation(point(chain[chain.size() - 2]), point(chain.back()), point(next)) !=
             Sign::positive) {
    chain.pop_back();
  }
  chain.push_back(next);
}

}  // namespace

PlaneView::PlaneView(const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 n = glm::abs(glm::cross(unit(b - a), unit(c - a)));
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int i, int j) { return n[i] > n[j]; });
  // The rounded normal proposes; some axis shows the triangle with an area.
  for (const int axis : axes) {
    first_ = (axis + 1) % 3;
    second_ = (axis + 2) % 3;
    const Sign sense = orientation((*this)(a), (*this)(b), (*this)(c));
    if (sense == Sign::negative) std::swap(first_, second_);
    if (sense != Sign::zero) return;
  }
}

std::vector<int> convex_outline(std::span<const dvec3> points, const PlaneView& view) {
  const auto point = [&](int i) { return view(points[std::size_t(i)]); };
  const auto key = [&](int i) {
    const dvec2 p = point(i);
    return std::tuple(p.x, p.y, i);
  };
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return key(i) < key(j); });
  const auto last =
      std::unique(order.begin(), order.end(), [&](int i, int j) { return point(i) == point(j); });
  order.erase(last, order.end());
  if (order.size() < 3) return order;

  std::vector<int> outline;
  for (const int i : order) extend(outline, 0, i, point);
  const std::size_t upper = outline.size() - 1;
  for (auto i = order.rbegin() + 1; i != order.rend(); ++i) extend(outline, upper, *i, point);
  outline.pop_back();  // the first point again
  return outline;
}

std::vector<int> simplified_outline(const std::vector<int>& outline, std::span<const dvec3> points,
                                    const RoundingWidth& width) {
  const std::size_t count = outline.size();
  const auto point = [&](std::size_t k) { return points[std::size_t(outline[k % count])]; };
  const auto farthest = [&](std::size_t from) {
    std::size_t best = from;
    for (std::size_t k = 0; k < count; ++k) {
      if (glm::distance(point(k), point(from)) > glm::distance(point(best), point(from))) best = k;
    }
    return best;
  };
  const std::size_t start = farthest(0);
  const std::size_t middle = farthest(start);
  if (middle == start) return {outline[start]};

  // Chains of the outline whose corners between the ends are to be looked at (Douglas and Peucker).
  std::vector<std::size_t> kept = {start};
  std::vector<std::pair<std::size_t, std::size_t>> chains;
  const std::size_t end = start + count;
  const std::size_t half = middle > start ? middle : middle + count;
  chains.emplace_back(half, end);
  chains.emplace_back(start, half);
  while (!chains.empty()) {
    const auto [from, to] = chains.back();
    chains.pop_back();
    const dvec3 side = unit(point(to) - point(from));
    std::pair<double, std::size_t> highest = {0, from};
    for (std::size_t k = from + 1; k < to; ++k) {
      const double height = glm::length(glm::cross(side, point(k) - point(from)));
      if (height > highest.first) highest = {height, k};
    }
    const dvec3 to_highest = point(highest.second) - point(from);
    const dvec3 across = to_highest - glm::dot(to_highest, side) * side;
    if (highest.first > 0 && highest.first > width.along(unit(across))) {
      chains.emplace_back(highest.second, to);
      chains.emplace_back(from, highest.second);
    } else if (to != end) {
      kept.push_back(to);
    }
  }
  std::vector<int> result;
  result.reserve(kept.size());
  for (const std::size_t k : kept) result.push_back(outline[k % count]);
  return result;
}

}  // namespace taut
