#include "taut/hull/polytope_support.h"

#include <numeric>

namespace taut {

PolytopeSupport::PolytopeSupport(const PointHull& hull) : hull_(hull) {
  // Every edge is named by its two facets, once from either end.
  first_.assign(hull.points().size() + 1, 0);
  const auto for_each_edge = [&](auto visit) {
    for (const PointHull::Facet& f : hull.facets()) {
      if (!f.alive) continue;
      for (std::size_t k = 0; k < 3; ++k) visit(f.vertex[k], f.vertex[(k + 1) % 3]);
    }
  };
  for_each_edge([&](int from, int) {
    ++first_[std::size_t(from) + 1];
    start_ = from;
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  neighbors_.resize(std::size_t(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for_each_edge([&](int from, int to) { neighbors_[std::size_t(next[std::size_t(from)]++)] = to; });
}

int PolytopeSupport::operator()(const dvec3& n, int start) const {
  const dvec3 origin = hull_.point(start);
  int best = start;
  double h = 0;
  for (bool climbing = true; climbing;) {
    climbing = false;
    for_each_neighbor(best, [&](int other) {
      const double value = glm::dot(hull_.point(other) - origin, n);
      if (!(value > h)) return;
      h = value;
      start = other;
      climbing = true;
    });
    best = start;
  }
  return best;
}

}  // namespace taut
