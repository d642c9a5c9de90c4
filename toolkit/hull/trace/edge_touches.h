#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/supporting_poles.h"
#include "taut/hull/cull/culling.h"

namespace taut {

/// Where a plane that turns about a straight edge first touches a face beside it: inside the edge,
/// where the face's tangent plane along the edge stops turning and its twist changes sign. Two
/// separating curves begin there, of the face's contact and each end of the edge, with one tangent:
/// Newton's method finds no plane of the three. The facets have no area: the edge's ends and the
/// face's contact, on its side, in line.
///
/// Of edges between vertices and faces with mixed cells. Each supports the model to within tie(),
/// by a support query. Edges along which the twist vanishes have none.
std::vector<Landmark> edge_touches(const ContactGeometry& geometry, SupportQuery& query,
                                   const std::vector<CulledCell>& cells);

}  // namespace taut
