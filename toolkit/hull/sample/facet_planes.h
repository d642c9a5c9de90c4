#pragma once

#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/hull_statistics.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// The supporting planes of a scene for the facets of a polytope that grows. A sliver, whose normal
/// is rounding, takes the direction of a neighbour, unless all are to count.
class FacetPlanes {
 public:
  /// What is known of a facet: its supporting plane.
  struct Plane {
    bool known = false;
    dvec3 n;
    int facet = -1;  ///< of which n is the normal
    double h_bound = 0;
    dvec3 point;  ///< the support point, in model coordinates
    Contact contact;
  };

  /// All must outlive it.
  FacetPlanes(const Scene& scene, const HullOptions& options, const PointHull& hull)
      : scene_(scene), options_(options), hull_(hull) {}

  /// Queries the plane of every facet that has none yet. `samples`: per point of the polytope.
  void find(const std::vector<Sample>& samples, HullStatistics& statistics);
  /// Lets slivers have their own directions from now on. False if that changes nothing.
  bool take_slivers_seriously();
  /// The facet of which the plane has its direction is no more.
  bool has_lost_facet(const Plane& plane) const;

  /// Makes room for facets that have come since.
  void fit() { planes_.resize(hull_.facets().size()); }
  std::size_t size() const { return planes_.size(); }
  Plane& operator[](std::size_t facet) { return planes_[facet]; }
  const Plane& operator[](std::size_t facet) const { return planes_[facet]; }

 private:
  /// A facet and its normal.
  struct Facing {
    int facet;
    dvec3 n;
  };
  Facing facing(int facet) const;

  const Scene& scene_;
  const HullOptions& options_;
  const PointHull& hull_;
  bool slivers_count_ = false;  ///< since nothing else helped
  std::vector<Plane> planes_;   ///< per facet
};

}  // namespace taut
