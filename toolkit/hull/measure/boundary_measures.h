#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/core/progress.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/measures.h"

namespace taut {

/// By how much measures of a boundary may differ from those of the true hull, at most.
struct MeasureBounds {
  /// Relative to what they bound; of no volume 1.
  double volume = 0;
  double area = 0;        ///< likewise
  double mean_width = 0;  ///< likewise
  /// Relative to the diagonal of the scene's box.
  double centroid = 0;
  /// Of each entry, relative to the largest one on the diagonal; of no volume 1.
  double inertia = 0;

  /// The largest of all.
  double largest() const;
};

/// Measures of a convex hull, integrated over the exact faces of its boundary, in model units.
struct BoundaryMeasures : Measures {
  /// Mean over all directions n of h(n) + h(-n): of a sphere its diameter.
  double mean_width = 0;
  /// Estimated relative accuracy of volume, area and mean width. It is the largest of the
  /// quadratures' estimated errors relative to the three, and of |integral of n dA| over the area,
  /// which is zero for a closed surface and tells of faces that are missing or do not meet.
  double accuracy = 0;
  /// The accuracy, and what places that are below supporting planes (HullFace::tolerant) and what
  /// the true hull may have beyond the faces (HullBoundary::gap) make of it.
  MeasureBounds bounds;
};

/// Measures of the hull with this boundary.
///
/// Patches by Green's theorem in their parameters, scrolls along their rulings, facets as polygons;
/// creases, needed for the mean width, from the normals that bound them: from separating curves
/// with a contact on an edge or two at vertices, and from patches' borders on edges and joins,
/// which have kinks where they are rounded. Of a polyhedron, which has no separating curves, from
/// its curves. Where neighbouring rulings are not joined by exact ones, as beside such kinks and
/// planes that are known to the resolution, those between are led to them or interpolated.
///
/// Of a complete boundary whose rulings are exact to rounding, errors are about 1e-13, however far
/// apart the rulings are; where a piece ends in a free end, below 1e-10 if the whole piece has but
/// five rulings, and soon as small with more. Time is 30 to 60 microseconds for each pair of
/// neighbouring rulings and each side of it on a patch.
///
/// Volume, centroid and inertia of a boundary without volume are as in Measures; planar hulls are
/// measured as in flat_measures.h.
/// @throws Cancelled, LimitMet
BoundaryMeasures measure(const Scene& scene, const ContactGeometry& geometry,
                         const HullBoundary& boundary, const Progress& progress = {});

}  // namespace taut
