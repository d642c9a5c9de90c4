#pragma once

#include <vector>

#include "taut/hull/polytope/point_hull.h"

namespace taut {

/// The support function of a point hull, by climbing along its edges.
class PolytopeSupport {
 public:
  /// The hull must outlive it and not change. @pre hull.dimension() == 3
  explicit PolytopeSupport(const PointHull& hull);

  /// A point of the hull, by number, at which p . n is largest to within rounding. `start`: a
  /// vertex near it; makes the climb short.
  int operator()(const dvec3& n, int start) const;
  /// The same from a vertex of its own choice.
  int operator()(const dvec3& n) const { return (*this)(n, start_); }

  /// Calls visit with every vertex that an edge joins with this one.
  template <class Visit>
  void for_each_neighbor(int vertex, Visit visit) const {
    const auto v = std::size_t(vertex);
    for (int k = first_[v]; k < first_[v + 1]; ++k) visit(neighbors_[std::size_t(k)]);
  }

 private:
  int climbed(const dvec3& n, const dvec3& origin, int vertex) const;
  int way_up(const dvec3& n, int top) const;

  const PointHull& hull_;
  std::vector<int> first_, neighbors_;  // per vertex, its neighbours
  int start_ = 0;
  double extent_ = 0;
};

}  // namespace taut
