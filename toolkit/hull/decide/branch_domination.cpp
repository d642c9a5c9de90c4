#include "taut/hull/decide/branch_domination.h"

#include <algorithm>

namespace taut {
namespace {

/// Branches beyond which none is dropped.
constexpr std::size_t dominated_limit = 12;

}  // namespace

void BranchPoints::find(const CellView& view, const Branches& branches) {
  points_.resize(branches.all().size());
  heights_.resize(branches.all().size());
  for (std::size_t b = 0; b < points_.size(); ++b) {
    Corners highest;
    highest.fill(-infinity);
    for (const int chart : branches.all()[b].charts) {
      for (const int k : branches.chart(chart).pieces) {
        const SeenPiece& seen = view.seen()[std::size_t(k)];
        const StoredNet& net = seen.piece->net;
        const int p = net.shape.p;
        const int q = net.shape.q;
        for (const int corner : {0, q, p * (q + 1), p * (q + 1) + q}) {
          const dvec4& x = net.points[corner];
          Corners y = view.values(seen)[corner];
          for (double& h : y) h /= x.w;
          for (std::size_t c = 0; c < 4; ++c) {
            if (y[c] <= highest[c]) continue;
            highest[c] = y[c];
            points_[b][c] = euclidean(x);
            heights_[b][c] = y;
          }
        }
      }
    }
  }
}

namespace {

Corners tops(const CellView& view, const Branches& branches, std::size_t branch) {
  Corners result;
  result.fill(-infinity);
  for (const int chart : branches.all()[branch].charts) {
    for (const int k : branches.chart(chart).pieces) {
      const Corners& top = view.seen()[std::size_t(k)].top;
      for (std::size_t c = 0; c < 4; ++c) result[c] = std::max(result[c], top[c]);
    }
  }
  return result;
}

}  // namespace

/// By the point of the branch that is the highest over them at the lowest.
bool stands_out(const CellView& view, const BranchPoints& points, const Branches& branches,
                std::size_t branch, std::size_t first, std::size_t second) {
  const auto middle = [&](std::size_t b) {
    const Branch& own = branches.all()[b];
    return 0.5 * (own.lower + own.upper);
  };
  const dvec3 way = middle(second) - middle(first);
  const double share =
      std::clamp(glm::dot(middle(branch) - middle(first), way) / glm::dot(way, way), 0.0, 1.0);
  const Corners a = tops(view, branches, first);
  const Corners b = tops(view, branches, second);
  const auto& heights = points.heights(branch);
  return std::any_of(heights.begin(), heights.end(), [&](const Corners& own) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(own[c] - (1 - share) * a[c] - share * b[c] > view.noise())) return false;
    }
    return true;
  });
}

std::vector<bool> BranchDomination::left(const CellView& view, const BranchPoints& points,
                                         const Branches& branches) {
  std::vector<bool> left(branches.all().size(), true);
  if (left.size() > dominated_limit) return left;
  std::size_t count = left.size();
  for (std::size_t b = left.size(); b-- > 0 && count > 1;) {
    others_.clear();
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (k == b || !left[k]) continue;
      const auto& heights = points.heights(k);
      others_.insert(others_.end(), heights.begin(), heights.end());
    }
    envelope_.find(others_);
    left[b] = !is_dominated(view, branches, b);
    count -= left[b] ? 0 : 1;
  }
  return left;
}

bool BranchDomination::is_dominated(const CellView& view, const Branches& branches,
                                    std::size_t branch) const {
  const auto& vertices = envelope_.vertices();
  const auto is_below = [&](const SeenPiece& seen) {
    const StoredNet& net = seen.piece->net;
    const dvec4* p = net.points;
    const Corners* y = view.values(seen);
    return std::all_of(vertices.begin(), vertices.end(), [&](const BeaconEnvelope::Vertex& v) {
      const double highest = v.height + budget_ - view.noise();
      for (int k = 0; k < net.shape.size(); ++k) {
        if (!(height_at(y[k], v.s, v.t) <= highest * p[k].w)) return false;
      }
      return true;
    });
  };
  const std::vector<int>& charts = branches.all()[branch].charts;
  return std::all_of(charts.begin(), charts.end(), [&](int chart) {
    const std::vector<int>& own = branches.chart(chart).pieces;
    return std::all_of(own.begin(), own.end(),
                       [&](int k) { return is_below(view.seen()[std::size_t(k)]); });
  });
}

}  // namespace taut
