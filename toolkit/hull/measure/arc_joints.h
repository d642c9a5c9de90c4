#pragma once

#include <vector>

#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Whether pieces of arcs are parts of scrolls, by arc and piece. Others are creases: n turns about
/// a segment.
using ScrollPieces = std::vector<std::vector<bool>>;
ScrollPieces pieces_of_scrolls(const HullBoundary& boundary);

/// Adds the total mean curvature of an arc's creases. Where several follow each other their ends
/// are in line, to within the resolution, and support together: then it is one crease, of the
/// segment that spans them all.
void add_creases(const SeparatingArc& arc, const std::vector<bool>& in_scroll, Sums& sums);

/// Adds the total mean curvature of the creases along rulings at which pieces do not share n where
/// they meet, as where contacts pass over joins with kinks, or arcs not n with the facets in which
/// they end. A step of a contact there, where it is more than the boundary's gap and than what
/// contacts that are one may differ by, counts as an error: as half a crease of that length and of
/// any angle.
void add_joints(const HullBoundary& boundary, const ScrollPieces& in_scroll, Sums& sums);

}  // namespace taut
