#pragma once

#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// The exact boundary of a polyhedral model's solid hull, of which `mesh` is the mesh with
/// sources and hull faces: facets with vertices as contacts, and rulings between them.
///
/// The separating curves are the great arcs across the edges, from the normal of the facet to the
/// left of an edge's contacts 0 and 1 to that of the one to the right. As arcs they would hold
/// nothing that faces and rulings do not tell; there are none.
HullBoundary polyhedral_boundary(const Model& model, const HullMesh& mesh);

}  // namespace taut
