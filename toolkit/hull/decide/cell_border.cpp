#include "taut/hull/decide/cell_border.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace taut {
namespace {

/// Support queries after which it is not told what is between two contacts.
constexpr int side_query_limit = 24;

/// One that follows the same as before is the same.
void append(std::vector<int>& loop, const std::vector<int>& next) {
  for (const int k : next) {
    if (loop.empty() || loop.back() != k) loop.push_back(k);
  }
}

}  // namespace

std::optional<CellBorder::Found> CellBorder::find(const BranchOrder& order, const Contact& hint) {
  points_.find(view_, branches_);
  for (std::size_t c = 0; c < 4; ++c) {
    corner_[c] = query_(unit(view_.corners()[c]), c == 0 ? hint : corner_[c - 1].contact);
    winner_[c] = branch_of(corner_[c].point);
  }
  // Corners are (0, 0), (0, 1), (1, 0), (1, 1).
  std::vector<int> loop;
  for (const auto& [side, axis, backwards] : {std::tuple(CellSide{0, 2}, 0u, false),
                                              {CellSide{2, 3}, 1u, false},
                                              {CellSide{1, 3}, 0u, true},
                                              {CellSide{0, 1}, 1u, true}}) {
    std::optional<std::vector<int>> found = along(side, order, axis);
    if (!found) return std::nullopt;
    if (backwards) std::reverse(found->begin(), found->end());
    append(loop, *found);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return inside(loop);
}

/// Of what follows each other around the cell.
std::optional<CellBorder::Found> CellBorder::inside(const std::vector<int>& loop) const {
  if (loop.size() == 1) return Found{loop};
  std::map<std::pair<int, int>, int> exchanges;
  std::map<int, std::set<int>> beside;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const auto [a, b] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
    ++exchanges[{a, b}];
    beside[a].insert(b);
    beside[b].insert(a);
  }
  const auto odd = std::count_if(exchanges.begin(), exchanges.end(),
                                 [](const auto& e) { return e.second % 2 == 1; });
  if (odd == 3 && count() == 3) return Found{{0, 1, 2}, true};
  if (odd > 0) return std::nullopt;
  // From an end on; what branches is no line.
  Found found;
  int last = -1;
  const auto end = std::find_if(beside.begin(), beside.end(),
                                [](const auto& b) { return b.second.size() == 1; });
  if (end == beside.end()) return std::nullopt;
  for (int next = end->first; next >= 0;) {
    const std::set<int>& own = beside[next];
    if (own.size() > 2) return std::nullopt;
    found.supporting.push_back(next);
    const auto beyond = std::find_if(own.begin(), own.end(), [&](int b) { return b != last; });
    last = next;
    next = beyond == own.end() ? -1 : *beyond;
  }
  return found;
}

std::optional<std::vector<int>> CellBorder::along(const CellSide& side, const BranchOrder& order,
                                                  std::size_t axis) {
  const std::optional<std::vector<int>> row = order.row(axis);
  if (!row) {
    const std::optional<int> only = winner_along(side);
    return only ? std::optional(std::vector<int>{*only}) : std::nullopt;
  }
  std::vector<int> found = {winner_[side[0]]};
  const bool known = add_between(*row, view_.corners()[side[0]], corner_[side[0]],
                                 view_.corners()[side[1]], corner_[side[1]], found);
  if (!known) return std::nullopt;
  append(found, {winner_[side[1]]});
  return found;
}

/// The branch that supports in all directions of a side: a point of it is above all others there.
std::optional<int> CellBorder::winner_along(const CellSide& side) const {
  for (int branch = 0; branch < int(count()); ++branch) {
    for (const dvec3& x : points_.points(std::size_t(branch))) {
      bool is_highest = true;
      for (int other = 0; other < int(count()); ++other) {
        is_highest = is_highest && (other == branch || !is_above(other, x, side));
      }
      if (is_highest) return branch;
    }
  }
  return std::nullopt;
}

/// Some of it may be above a point.
bool CellBorder::is_above(int branch, const dvec3& point, const CellSide& side) const {
  const std::vector<int>& charts = branches_.all()[std::size_t(branch)].charts;
  return std::any_of(charts.begin(), charts.end(), [&](int chart) {
    const std::vector<int>& own = branches_.chart(chart).pieces;
    return std::any_of(own.begin(), own.end(), [&](int k) {
      const SeenPiece& seen = view_.seen()[std::size_t(k)];
      return std::any_of(side.begin(), side.end(), [&](std::size_t c) {
        const double height = glm::dot(point - view_.q(), view_.corners()[c]);
        return !(seen.top[c] < height - view_.noise());
      });
    });
  });
}

int CellBorder::branch_of(const dvec3& x) const {
  int best = -1;
  double least = infinity;
  for (int b = 0; b < int(count()); ++b) {
    const Branch& branch = branches_.all()[std::size_t(b)];
    const double own = distance(Box{branch.lower, branch.upper}, x);
    if (own >= least) continue;
    least = own;
    best = b;
  }
  return best;
}

/// Adds those that support between two directions, in their order, to what is found: where the
/// planes across which the two at the ends were touched last exchange is nearer to where they do.
bool CellBorder::add_between(const std::vector<int>& row, const dvec3& from, const Support& first,
                             const dvec3& to, const Support& last, std::vector<int>& found) {
  const auto place = [&](const Support& s) {
    return std::find(row.begin(), row.end(), branch_of(s.point)) - row.begin();
  };
  const std::ptrdiff_t begin = place(first);
  const std::ptrdiff_t end = place(last);
  if (end < begin) return false;  // it cannot be but for rounding
  if (end - begin < 2) return true;
  Support lower = first;
  Support upper = last;
  for (int k = 0; k < side_query_limit; ++k) {
    const double before = glm::dot(upper.point - lower.point, from);
    const double after = glm::dot(upper.point - lower.point, to);
    if (!(before < 0 && after > 0)) return false;
    const dvec3 d = glm::mix(from, to, before / (before - after));
    const Support between = query_(unit(d), lower.contact);
    const std::ptrdiff_t own = place(between);
    if (own > begin && own < end) {
      if (!add_between(row, from, first, d, between, found)) return false;
      append(found, {row[std::size_t(own)]});
      return add_between(row, d, between, to, last, found);
    }
    if (glm::dot(between.point - lower.point, d) <= view_.noise()) return true;
    if (own != begin && own != end) return false;
    (own == begin ? lower : upper) = between;
  }
  return false;
}

}  // namespace taut
