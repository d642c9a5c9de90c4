#pragma once

#include "taut/io/region_outlines.h"

namespace taut {

/// What the faces of a hull document enclose, in model units.
struct DocumentMeasures {
  double volume = 0;
  double area = 0;
  /// Mean over all directions n of h(n) + h(-n).
  double mean_width = 0;
  /// Integral of the outward unit normal over all faces: zero if they make up a closed surface.
  dvec3 vector_area = dvec3(0.0);
  /// Estimated relative error from interpolating curves between their points.
  double interpolation = 0;
};

/// By integrals over all faces: patches by Green's theorem in their parameters and scrolls along
/// their rulings, to some 1e-12; facets along their curves, of which only points are known, and so
/// patches where no scroll is along them, by polynomials of degree five through these.
///
/// The mean width is total mean curvature over 2 pi. Creases have their share of it: the outline of
/// each face counts with the angle between the face's normal and the direction from a point inside
/// of the hull, whose differences are the creases' angles.
/// @pre hull of dimension 3, all contacts on their sources
DocumentMeasures measure(const DocumentGeometry& geometry, const DocumentOutlines& outlines);

}  // namespace taut
