#include "taut/hull/decide/beacon_envelope.h"

#include <algorithm>
#include <numeric>

namespace taut {

void BeaconEnvelope::find(std::span<const Corners> points) {
  vertices_ = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  known_.clear();
  highest_.assign(points.size(), true);
  rivals_.resize(points.size());
  std::iota(rivals_.begin(), rivals_.end(), std::size_t(0));
  const auto middle = [](const Corners& y) { return y[1] + y[2]; };
  std::size_t first = 0;
  // The highest ones at the corners and in the middle leave nothing of most others.
  const auto put_first = [&](const auto& height) {
    if (points.empty()) return;
    const auto best = std::max_element(
        rivals_.begin(), rivals_.end(),
        [&](std::size_t a, std::size_t b) { return height(points[a]) < height(points[b]); });
    if (std::size_t(best - rivals_.begin()) < first) return;
    std::swap(rivals_[first++], *best);
  };
  for (std::size_t c = 0; c < 4; ++c) {
    put_first([c](const Corners& y) { return y[c]; });
    vertices_[c].height = -infinity;
    for (const Corners& y : points) vertices_[c].height = std::max(vertices_[c].height, y[c]);
  }
  put_first(middle);
  for (std::size_t i = 0; i < points.size(); ++i) {
    polygon_ = {{0, 0, -1}, {1, 0, -2}, {1, 1, -3}, {0, 1, -4}};
    bool is_left = true;
    for (std::size_t k = 0; k < rivals_.size() && is_left; ++k) {
      const std::size_t j = rivals_[k];
      if (j == i || !highest_[j]) continue;
      Corners above;
      for (std::size_t c = 0; c < 4; ++c) above[c] = points[i][c] - points[j][c];
      const bool equal = std::all_of(above.begin(), above.end(), [](double x) { return x == 0; });
      is_left = equal ? i < j : clip(above, int(j));
    }
    highest_[i] = is_left;
    if (is_left) add_vertices(int(i), points[i]);
  }
}

/// Leaves what of the polygon is above; false if nothing is.
bool BeaconEnvelope::clip(const Corners& above, int line) {
  const auto at = [&](const PolygonCorner& p) { return height_at(above, p.s, p.t); };
  over_.clear();
  for (const PolygonCorner& p : polygon_) over_.push_back(at(p));
  if (std::all_of(over_.begin(), over_.end(), [](double x) { return x >= 0; })) return true;
  clipped_.clear();
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const std::size_t next = k + 1 < polygon_.size() ? k + 1 : 0;
    const PolygonCorner& p = polygon_[k];
    const PolygonCorner& q = polygon_[next];
    if (over_[k] >= 0) clipped_.push_back(p);
    if ((over_[k] >= 0) == (over_[next] >= 0)) continue;
    const double share = over_[k] / (over_[k] - over_[next]);
    clipped_.push_back(
        {p.s + share * (q.s - p.s), p.t + share * (q.t - p.t), over_[k] >= 0 ? line : p.line});
  }
  polygon_.swap(clipped_);
  return polygon_.size() > 2;
}

void BeaconEnvelope::add_vertices(int point, const Corners& heights) {
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const PolygonCorner& p = polygon_[k];
    const int before = polygon_[k > 0 ? k - 1 : polygon_.size() - 1].line;
    if (p.line < 0 && before < 0) continue;  // a corner of the cell
    std::array<int, 3> meeting = {point, p.line, before};
    std::sort(meeting.begin(), meeting.end());
    if (std::find(known_.begin(), known_.end(), meeting) != known_.end()) continue;
    known_.push_back(meeting);
    vertices_.push_back({p.s, p.t, height_at(heights, p.s, p.t)});
  }
}

}  // namespace taut
