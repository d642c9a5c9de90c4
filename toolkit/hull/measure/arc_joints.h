#pragma once

#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Both contacts are vertices.
bool is_crease(const ArcPiece& piece);

/// Adds the total mean curvature of an arc's creases between vertices. Where several follow each
/// other their vertices are in line, to within the resolution, and support together: then it is one
/// crease, of the segment that spans them all.
void add_vertex_creases(const SeparatingArc& arc, Sums& sums);

/// Adds the total mean curvature of the creases along rulings at which pieces do not share n where
/// they meet, as where contacts pass over joins with kinks, or arcs not n with the facets in which
/// they end. A step of a contact there, where it is more than the boundary's gap and than what
/// contacts that are one may differ by, counts as an error: as half a crease of that length and of
/// any angle.
void add_joints(const HullBoundary& boundary, Sums& sums);

}  // namespace taut
