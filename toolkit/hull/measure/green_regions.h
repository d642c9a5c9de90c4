#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// A region of a patch, with the choice of the line integrals around it by which Green's theorem
/// gives an integral over it: of inner integrals along the one parameter, from a base on.
struct GreenRegion {
  const PatchRegion* region = nullptr;
  /// The parameter that inner integrals run along, 0: u, 1: v, and where they begin.
  int inner = 0;
  double base = 0;

  Contact contact(double u, double v) const {
    return {region->instance, SourceKind::face, region->patch, u, v};
  }
};

/// A stretch of a region's outline along a piece of an arc.
struct ArcTrace {
  int region = -1;       ///< of GreenRegions::all()
  int contact = 0;       ///< of the piece's rulings
  double direction = 1;  ///< -1: against the arc
};

/// All regions of a boundary, and how their outlines run along its arcs.
class GreenRegions {
 public:
  /// The boundary must outlive this.
  GreenRegions(const ContactGeometry& geometry, const HullBoundary& boundary);

  const std::vector<GreenRegion>& all() const { return regions_; }
  /// Along a piece of an arc.
  const std::vector<ArcTrace>& traces(std::size_t arc, std::size_t piece) const {
    return traces_[arc][piece];
  }

 private:
  void add(const ContactGeometry& geometry, const HullBoundary& boundary,
           const PatchRegion& region);

  std::vector<GreenRegion> regions_;
  std::vector<std::vector<std::vector<ArcTrace>>> traces_;
};

}  // namespace taut
