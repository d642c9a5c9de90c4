#pragma once

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/region_outline.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/solve/depth_bounds.h"

namespace taut {

/// How far patches' regions are below the supporting planes with their own normals, by support
/// queries at places inside of them and by how they bend at their outlines.
class RegionDepths {
 public:
  /// All must outlive it.
  RegionDepths(const ContactSystem& system, SupportQuery& query, const DepthBounds& bounds)
      : system_(system), geometry_(system.geometry()), query_(query), bounds_(bounds) {}

  /// Places as near to the outline as that may be off are as deep as the arcs there.
  double of(const HullBoundary& boundary, const PatchRegion& region);

 private:
  double deepest_in(const RegionOutline& outline, const PatchRegion& region, bool closer);
  double deepest_bend(const RegionOutline& outline, const PatchRegion& region) const;
  double bend_length(const PatchRegion& region, const dvec2& from, const dvec2& to) const;
  double upward_curvature(const PatchRegion& region, const dvec2& uv) const;
  double own_depth(const PatchRegion& region, const dvec2& uv, double least);
  dvec3 point(const PatchRegion& region, const dvec2& uv) const;

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DepthBounds& bounds_;
};

}  // namespace taut
