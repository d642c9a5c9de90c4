#include "taut/hull/decide/cell_border.h"

#include <algorithm>
#include <tuple>

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

/// Two curves of three meet in a plane that touches all three, in which the third ends as well; if
/// there is one at most, there is none if they leave the cell as often as not.
std::optional<CellBorder::Found> CellBorder::find(const BranchOrder& order, const Contact& hint) {
  points_.find(view_, branches_);
  for (std::size_t c = 0; c < 4; ++c) {
    corner_[c] = query_(unit(view_.corners()[c]), c == 0 ? hint : corner_[c - 1].contact);
    winner_[c] = branch_of(corner_[c].point);
  }
  // Corners are (0, 0), (0, 1), (1, 0), (1, 1).
  std::vector<int> loop;
  for (const auto& [side, axis, backwards] :
       {std::tuple(CellSide{0, 2}, 0u, false), {CellSide{2, 3}, 1u, false},
        {CellSide{1, 3}, 0u, true}, {CellSide{0, 1}, 1u, true}}) {
    std::optional<std::vector<int>> found = along(side, order, axis);
    if (!found) return std::nullopt;
    if (backwards) std::reverse(found->begin(), found->end());
    append(loop, *found);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  if (loop.size() < 3) return Found{std::move(loop)};
  // How often each is passed by: by the sum of their numbers, of two that exchange the third.
  std::array<int, 3> exchanges = {};
  for (std::size_t k = 0; k < loop.size(); ++k) {
    ++exchanges[std::size_t(3 - loop[k] - loop[(k + 1) % loop.size()])];
  }
  const auto is_odd = [](int count) { return count % 2 == 1; };
  if (std::all_of(exchanges.begin(), exchanges.end(), is_odd)) return Found{{0, 1, 2}, true};
  // Two of a kind, twice each: those that do not exchange are the first and the last.
  const auto never = std::find(exchanges.begin(), exchanges.end(), 0);
  if (loop.size() != 4 || never == exchanges.end()) return std::nullopt;
  const auto middle = int(never - exchanges.begin());
  return Found{{(middle + 1) % 3, middle, (middle + 2) % 3}};
}

std::optional<std::vector<int>> CellBorder::along(const CellSide& side, const BranchOrder& order,
                                                  std::size_t axis) {
  const int from = winner_[side[0]];
  const int to = winner_[side[1]];
  const std::optional<std::array<int, 3>> row = order.row_of_three(axis);
  if (!row) {
    const std::optional<int> only = winner_along(side);
    return only ? std::optional(std::vector<int>{*only}) : std::nullopt;
  }
  const auto place = [&](int branch) { return std::find(row->begin(), row->end(), branch); };
  if (place(to) < place(from)) return std::nullopt;  // it cannot be but for rounding
  std::vector<int> found(place(from), place(to) + 1);
  if (found.size() < 3) return found;
  const std::optional<bool> middle = supports_between((*row)[1], side);
  if (!middle) return std::nullopt;
  if (!*middle) found.erase(found.begin() + 1);
  return found;
}

/// The branch that supports in all directions of a side: a point of it is above all others there.
std::optional<int> CellBorder::winner_along(const CellSide& side) const {
  for (int branch = 0; branch < 3; ++branch) {
    for (const dvec3& x : points_.points(std::size_t(branch))) {
      bool is_highest = true;
      for (int other = 0; other < 3; ++other) {
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
  for (int b = 0; b < 3; ++b) {
    const Branch& branch = branches_.all()[std::size_t(b)];
    const dvec3 gap = glm::max(glm::max(branch.lower - x, x - branch.upper), dvec3(0.0));
    if (glm::length(gap) >= least) continue;
    least = glm::length(gap);
    best = b;
  }
  return best;
}

/// Whether a third one supports between those that do so at a side's ends: where the planes across
/// which these were touched last exchange is nearer to where they do.
std::optional<bool> CellBorder::supports_between(int branch, const CellSide& side) {
  const dvec3 from = view_.corners()[side[0]];
  const dvec3 to = view_.corners()[side[1]];
  Support first = corner_[side[0]];
  Support last = corner_[side[1]];
  const int winner = branch_of(first.point);
  for (int k = 0; k < side_query_limit; ++k) {
    const double before = glm::dot(last.point - first.point, from);
    const double after = glm::dot(last.point - first.point, to);
    if (!(before < 0 && after > 0)) return std::nullopt;
    const dvec3 d = glm::mix(from, to, before / (before - after));
    const Support between = query_(unit(d), first.contact);
    const int holder = branch_of(between.point);
    if (holder == branch) return true;
    const double more = glm::dot(between.point - first.point, d);
    if (more <= view_.noise()) return false;
    (holder == winner ? first : last) = between;
  }
  return std::nullopt;
}

}  // namespace taut
