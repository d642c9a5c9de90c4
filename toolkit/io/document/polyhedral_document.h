#pragma once

#include <string>
#include <vector>

#include "taut/hull/result/hull_document.h"
#include "taut/hull/result/hull_mesh.h"
#include "taut/surface/model.h"

namespace taut {

/// The document of a polyhedral hull, whose mesh is its boundary: facets, and rulings between them.
/// A planar hull has two facets, a segment one curve without faces, a point nothing but a source.
/// @pre model.polyhedral(), and the mesh's vertices have sources
HullDocument hull_document(const Model& model, const HullMesh& mesh,
                           const std::vector<std::string>& files = {});

}  // namespace taut
