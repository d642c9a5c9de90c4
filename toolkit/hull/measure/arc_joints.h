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

/// How much total mean curvature may be off because pieces do not share n and points where they
/// meet, or arcs not n with the facets in which they end. A turn of n that is left out counts with
/// half the ruling's length, and a step of a contact, where it is more than the boundary's gap and
/// than what contacts that are one may differ by, as half a crease of that length and of any angle.
double open_joints(const HullBoundary& boundary);

}  // namespace taut
