#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact_geometry.h"
#include "taut/hull/culling.h"
#include "taut/hull/supporting_poles.h"

namespace taut {

/// Planes that touch a face all along a straight edge of it, where the face has one normal: as
/// cages have beside creases next to which their points are in one plane. Turned on about the edge
/// by d, such a plane is surpassed by the face beside a place p of the edge by f(p) d^2, or by f(p)
/// d^(3/2) where the face has no curvature there. Where f is its own concave hull the face's
/// contacts begin along the edge itself; where it is below a chord of the hull, a separating curve
/// begins, of the contacts that do so in the chord's ends.
///
/// The facets have no area. Their corners, in line, are the edge's ends and the ends of chords;
/// along the rest of the edge they have it for sides. None where there are no chords, which the
/// ends of edges tell, nor where a chord leads from the one end to the other, or has none of them
/// for an end. Each supports the model to within tie(), by a support query.
std::vector<Landmark> edge_stretches(const ContactGeometry& geometry, SupportQuery& query,
                                     const std::vector<CulledCell>& cells);

}  // namespace taut
