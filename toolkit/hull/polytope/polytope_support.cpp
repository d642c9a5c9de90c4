#include "taut/hull/polytope/polytope_support.h"

#include <algorithm>
#include <numeric>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Vertices that are looked at for a way up.
constexpr std::size_t plateau_limit = 64;

}  // namespace

PolytopeSupport::PolytopeSupport(const PointHull& hull) : hull_(hull) {
  // Every edge is named by its two facets, once from either end.
  first_.assign(hull.points().size() + 1, 0);
  const auto for_each_edge = [&](auto visit) {
    for (const PointHull::Facet& f : hull.facets()) {
      if (!f.alive) continue;
      for (std::size_t k = 0; k < 3; ++k) visit(f.vertex[k], f.vertex[(k + 1) % 3]);
    }
  };
  Box box;
  for_each_edge([&](int from, int) {
    ++first_[std::size_t(from) + 1];
    box.include(hull.point(from));
    start_ = from;
  });
  extent_ = diagonal(box);
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  neighbors_.resize(std::size_t(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for_each_edge([&](int from, int to) { neighbors_[std::size_t(next[std::size_t(from)]++)] = to; });
}

/// To the highest neighbour while there is a higher one, measured from the start.
int PolytopeSupport::climbed(const dvec3& n, const dvec3& origin, int vertex) const {
  double h = glm::dot(hull_.point(vertex) - origin, n);
  for (int next = vertex;; vertex = next) {
    for_each_neighbor(vertex, [&](int other) {
      const double value = glm::dot(hull_.point(other) - origin, n);
      if (!(value > h)) return;
      h = value;
      next = other;
    });
    if (next == vertex) return vertex;
  }
}

/// A way up from a top that is one by rounding only: over vertices as high up to rounding, of which
/// a cluster of nearly equal points has a few. The top itself if there is none.
int PolytopeSupport::way_up(const dvec3& n, int top) const {
  const dvec3 origin = hull_.point(top);
  const double rounding = 8 * rounding_unit * extent_;
  std::vector<int> seen = {top};
  for (std::size_t k = 0; k < seen.size() && seen.size() < plateau_limit; ++k) {
    int higher = -1;
    for_each_neighbor(seen[k], [&](int other) {
      const double value = glm::dot(hull_.point(other) - origin, n);
      if (value > rounding) {
        higher = other;
      } else if (value > -rounding && seen.size() < plateau_limit &&
                 std::find(seen.begin(), seen.end(), other) == seen.end()) {
        seen.push_back(other);
      }
    });
    if (higher >= 0) return higher;
  }
  return top;
}

int PolytopeSupport::operator()(const dvec3& n, int start) const {
  const dvec3 origin = hull_.point(start);
  for (;;) {
    const int top = climbed(n, origin, start);
    start = way_up(n, top);
    if (start == top) return top;
  }
}

}  // namespace taut
