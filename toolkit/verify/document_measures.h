#pragma once

#include <algorithm>

#include "taut/core/progress.h"
#include "taut/verify/region_outlines.h"
#include "taut/verify/verify.h"

namespace taut {

/// What the faces of a hull document enclose, in model units.
struct DocumentMeasures {
  double volume = 0;
  double area = 0;  ///< of a planar hull, of its one face
  /// Mean over all directions n of h(n) + h(-n).
  double mean_width = 0;
  /// Integral of the outward unit normal over all faces: zero if they make up a closed surface.
  dvec3 vector_area = dvec3(0.0);
  /// How large that may be, since outlines of facets are off their planes by what is stated, and
  /// how far off the volume, since facets and scrolls are off by it.
  double vector_area_bound = 0;
  double volume_bound = 0;
  /// Estimated relative errors: of the quadrature, and of curves that are interpolated, twice what
  /// worse polynomials would change. That of the vector area is a share of the area.
  double volume_error = 0;
  double area_error = 0;
  double mean_width_error = 0;
  double vector_area_error = 0;

  /// The largest of volume, area and mean width.
  double error() const { return std::max({volume_error, area_error, mean_width_error}); }
};

/// By integrals over all faces: patches by Green's theorem in their parameters, scrolls along their
/// rulings and facets along their edges, bisected until they are known to some 1e-13. Of other
/// curves about facets only points are known: these, and patches along them, are by polynomials of
/// degree five through the points.
///
/// The mean width is total mean curvature over 2 pi. Creases have their share of it: the outline of
/// each face counts with the angle between the face's normal and the direction from a point inside
/// of the hull, whose differences are the creases' angles.
/// Meaningless where faces are missing or contacts off their sources. @pre hull of dimension 2 or 3
/// @throws Cancelled
DocumentMeasures measure(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                         const VerifyOptions& options = {});

}  // namespace taut
