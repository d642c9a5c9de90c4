#pragma once

#include <vector>

#include "taut/hull/polytope/point_hull.h"

namespace taut {

/// The facets about the vertices of a polytope that grows.
class VertexFacets {
 public:
  /// The polytope must outlive it.
  explicit VertexFacets(const PointHull& polytope);

  /// Takes note of the last point that was inserted: of each one before the next.
  void update();

  /// In order about it; none if it is no vertex of the boundary.
  std::vector<int> about(int vertex) const;
  /// An edge of the boundary joins the two.
  bool joined(int a, int b) const;
  /// A facet that the point is above, sought from those about a vertex on; -1 if there seems to be
  /// none or that is no vertex of the boundary.
  ///
  /// The facet that the ray from inside to the point leaves through is the highest vertex of the
  /// polar polytope in the point's direction: from any other, some neighbour is higher.
  int below(const dvec3& point, int vertex) const;

 private:
  bool has(int facet, int vertex) const;
  double polar_height(int facet, const dvec3& point) const;

  const PointHull& polytope_;
  dvec3 inside_ = dvec3(0.0);
  std::vector<int> some_facet_;  ///< per point; of points that are no vertices one that is no more
};

}  // namespace taut
