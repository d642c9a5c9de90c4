#include "taut/hull/decide/branch_order.h"

#include <algorithm>

namespace taut {
namespace {

Interval difference(const Interval& x, const Interval& y) {
  return {x.lower - y.upper, x.upper - y.lower};
}

Interval product(const Interval& x, const Interval& y) {
  const auto [least, most] =
      std::minmax({x.lower * y.lower, x.lower * y.upper, x.upper * y.lower, x.upper * y.upper});
  return {least, most};
}

dvec2 turned(const dvec2& x) { return {-x.y, x.x}; }

}  // namespace

void BranchOrder::find(const CellView& view, const Branches& branches, const dvec3& first,
                       const dvec3& second) {
  points_.resize(branches.all().size());
  for (std::size_t b = 0; b < points_.size(); ++b) {
    points_[b].clear();
    for (const int chart : branches.all()[b].charts) {
      for (const int k : branches.chart(chart).pieces) {
        const StoredNet& net = view.seen()[std::size_t(k)].piece->net;
        const dvec4* p = net.points;
        for (int i = 0; i < net.shape.size(); ++i) {
          const dvec3 x = euclidean(p[i]) - view.q();
          points_[b].emplace_back(glm::dot(x, first), glm::dot(x, second));
        }
      }
    }
  }
}

Interval BranchOrder::along(std::size_t branch, const dvec2& axis) const {
  Interval range{infinity, -infinity};
  for (const dvec2& x : points_[branch]) {
    range.lower = std::min(range.lower, glm::dot(x, axis));
    range.upper = std::max(range.upper, glm::dot(x, axis));
  }
  return range;
}

dvec2 BranchOrder::middle(std::size_t branch) const {
  const Interval x = along(branch, {1, 0});
  const Interval y = along(branch, {0, 1});
  return {0.5 * (x.lower + x.upper), 0.5 * (y.lower + y.upper)};
}

/// By the line between their middles and that across it, and the axes.
bool BranchOrder::apart(std::size_t a, std::size_t b) const {
  const dvec2 between = middle(b) - middle(a);
  for (const dvec2& axis : {between, dvec2(1, 0), dvec2(0, 1), turned(between)}) {
    if (excludes_zero(difference(along(a, axis), along(b, axis)))) return true;
  }
  return false;
}

std::optional<std::vector<int>> BranchOrder::row(std::size_t axis) const {
  const dvec2 way = axis == 0 ? dvec2(1, 0) : dvec2(0, 1);
  std::vector<Interval> range(points_.size());
  std::vector<int> order(points_.size());
  for (std::size_t b = 0; b < points_.size(); ++b) {
    range[b] = along(b, way);
    order[b] = int(b);
  }
  const auto of = [&](int b) -> const Interval& { return range[std::size_t(b)]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return of(a).lower < of(b).lower; });
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    if (!(of(order[k]).upper < of(order[k + 1]).lower)) return std::nullopt;
  }
  return order;
}

bool BranchOrder::go_around_alike(const std::vector<int>& row) const {
  int way = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (std::size_t j = i + 1; j < row.size(); ++j) {
      for (std::size_t k = j + 1; k < row.size(); ++k) {
        const int own = turn(std::size_t(row[i]), std::size_t(row[j]), std::size_t(row[k]));
        if (own == 0 || own == -way) return false;
        way = own;
      }
    }
  }
  return true;
}

bool BranchOrder::go_around(std::size_t a, std::size_t b, std::size_t c) const {
  return turn(a, b, c) != 0;
}

/// In axes along the line between the middles of two of them.
int BranchOrder::turn(std::size_t a, std::size_t b, std::size_t c) const {
  for (const std::array<std::size_t, 3>& turn : {std::array{a, b, c}, {b, c, a}, {c, a, b}}) {
    const std::size_t from = turn[0];
    const std::size_t to = turn[1];
    const std::size_t third = turn[2];
    const dvec2 own = middle(to) - middle(from);
    const dvec2 across = turned(own);
    const auto offset = [&](std::size_t branch, const dvec2& axis) {
      return difference(along(branch, axis), along(from, axis));
    };
    const Interval p = product(offset(to, own), offset(third, across));
    const Interval q = product(offset(to, across), offset(third, own));
    const Interval area = difference(p, q);
    if (excludes_zero(area)) return area.lower > 0 ? 1 : -1;
  }
  return 0;
}

}  // namespace taut
