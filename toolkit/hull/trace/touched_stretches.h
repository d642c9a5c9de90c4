#pragma once

#include <algorithm>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Part of a facet's side: a stretch of an edge or a seam, or a chord of it.
struct SidePart {
  Contact begin;
  EdgeStretch stretch = {};  ///< of no piece: a chord
};

/// What leads along a straight edge: the parts, and the end of the last one.
struct SideParts {
  std::vector<SidePart> parts;
  Contact end;

  bool has_chords() const {
    return std::any_of(parts.begin(), parts.end(),
                       [](const SidePart& part) { return part.stretch.piece < 0; });
  }
};

/// A straight edge or seam, or a stretch of it, all along which a face has one normal.
struct TouchedStretch {
  dvec3 n = dvec3(0.0);
  /// With the face to the right, seen from outside.
  SideParts side;
  bool is_whole = false;  ///< from one end of the edge to the other
};

/// Planes that touch a face all along a straight edge of it, where the face has one normal: as
/// cages have beside creases and smooth joins next to which their points are in one plane. Turned
/// on about the edge by d, such a plane is surpassed by the face beside a place p of the edge by
/// f(p) d^2, or by f(p) d^(3/2) where the face has no curvature there. Where f is its own concave
/// hull the face's contacts begin along the edge itself; where it is below a chord of the hull, a
/// separating curve begins, of the contacts that do so in the chord's ends.
///
/// None where a chord has none of the stretch's ends for an end, and where the face does not leave
/// the plane. All support the model to within tie(), by support queries.
std::vector<TouchedStretch> touched_stretches(const ContactGeometry& geometry, SupportQuery& query,
                                              const std::vector<CulledCell>& cells);

}  // namespace taut
