#include "taut/hull/decide/parameter_region.h"

#include <algorithm>
#include <array>

#include "taut/core/disjoint_sets.h"

namespace taut {
namespace {

/// With a line more at each end, as far off as they reach.
std::vector<double> grid_lines(std::vector<double> lines) {
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  const double reach = lines.back() - lines.front();
  if (lines.front() > 0) lines.insert(lines.begin(), std::max(0.0, lines.front() - reach));
  if (lines.back() < 1) lines.push_back(std::min(1.0, lines.back() + reach));
  return lines;
}

/// To the cell beyond a side.
std::array<int, 2> step(Side side) {
  const int way = at_upper_end(side) ? 1 : -1;
  return along_v(side) ? std::array{way, 0} : std::array{0, way};
}

}  // namespace

ParameterRegion::ParameterRegion(const std::vector<Cell>& rectangles) {
  for (const Cell& r : rectangles) {
    u_.insert(u_.end(), {r.u.lower, r.u.upper});
    v_.insert(v_.end(), {r.v.lower, r.v.upper});
  }
  u_ = grid_lines(std::move(u_));
  v_ = grid_lines(std::move(v_));
  cells_.assign(std::size_t(rows() * columns()), false);
  for (const Cell& r : rectangles) {
    for (int i = 0; i < rows(); ++i) {
      if (u_[std::size_t(i)] < r.u.lower || u_[std::size_t(i)] >= r.u.upper) continue;
      for (int j = 0; j < columns(); ++j) {
        if (v_[std::size_t(j)] < r.v.lower || v_[std::size_t(j)] >= r.v.upper) continue;
        cells_[std::size_t(i * columns() + j)] = true;
      }
    }
  }
}

bool ParameterRegion::has(int i, int j) const {
  return i >= 0 && j >= 0 && i < rows() && j < columns() && cells_[std::size_t(i * columns() + j)];
}

ParameterRegion::Cell ParameterRegion::cell(int i, int j) const {
  return {{u_[std::size_t(i)], u_[std::size_t(i) + 1]},
          {v_[std::size_t(j)], v_[std::size_t(j) + 1]}};
}

bool ParameterRegion::hangs_together() const {
  DisjointSets sets(cells_.size());
  int first = -1;
  for (int i = 0; i < rows(); ++i) {
    for (int j = 0; j < columns(); ++j) {
      if (!has(i, j)) continue;
      if (first < 0) first = i * columns() + j;
      if (has(i + 1, j)) sets.unite(i * columns() + j, (i + 1) * columns() + j);
      if (has(i, j + 1)) sets.unite(i * columns() + j, i * columns() + j + 1);
    }
  }
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    if (cells_[k] && sets.find(int(k)) != sets.find(first)) return false;
  }
  return first >= 0;
}

/// By Euler's formula, over the corners of the grid.
bool ParameterRegion::is_disc() const {
  int sum = 0;  // corners less sides plus cells
  for (int i = 0; i <= rows(); ++i) {
    for (int j = 0; j <= columns(); ++j) {
      const bool a = has(i - 1, j - 1);
      const bool b = has(i - 1, j);
      const bool c = has(i, j - 1);
      const bool d = has(i, j);
      if (a == d && b == c && a != b) return false;
      sum += (a || b || c || d ? 1 : 0) - (b || d ? 1 : 0) - (c || d ? 1 : 0) + (d ? 1 : 0);
    }
  }
  return sum == 1 && hangs_together();
}

std::vector<ParameterRegion::BorderSide> ParameterRegion::border() const {
  std::vector<BorderSide> result;
  for (int i = 0; i < rows(); ++i) {
    for (int j = 0; j < columns(); ++j) {
      if (!has(i, j)) continue;
      for (const Side side : all_sides) {
        const auto [di, dj] = step(side);
        if (!has(i + di, j + dj)) result.push_back({i, j, side});
      }
    }
  }
  return result;
}

/// At a corner of the grid.
int ParameterRegion::cells_at(int i, int j) const {
  return has(i - 1, j - 1) + has(i - 1, j) + has(i, j - 1) + has(i, j);
}

bool ParameterRegion::any_end_inwards(const std::vector<BorderSide>& sides) const {
  return std::any_of(sides.begin(), sides.end(), [&](const BorderSide& side) {
    const int across = at_upper_end(side.side) ? 1 : 0;
    return along_v(side.side) ? cells_at(side.i + across, side.j) == 3 ||
                                    cells_at(side.i + across, side.j + 1) == 3
                              : cells_at(side.i, side.j + across) == 3 ||
                                    cells_at(side.i + 1, side.j + across) == 3;
  });
}

std::optional<ParameterRegion::Cell> ParameterRegion::extend(const BorderSide& side) {
  const auto [di, dj] = step(side.side);
  const int i = side.i + di;
  const int j = side.j + dj;
  if (i < 0 || j < 0 || i >= rows() || j >= columns()) return std::nullopt;
  cells_[std::size_t(i * columns() + j)] = true;
  return cell(i, j);
}

}  // namespace taut
