#pragma once

#include <string>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_document.h"
#include "taut/hull/result/hull_mesh.h"
#include "taut/surface/model.h"

namespace taut {

/// The document of a hull whose mesh is its boundary, a polyhedral one or a segment or a point:
/// facets, and rulings between them.
/// A planar hull has one facet, a segment one curve without faces, a point nothing but a source.
/// @pre model.polyhedral(), and the mesh's vertices have sources
HullDocument hull_document(const Model& model, const HullMesh& mesh,
                           const std::vector<std::string>& files = {});
/// The same of any model. @pre the mesh is a segment or a point
HullDocument hull_document(const Scene& scene, const HullMesh& mesh,
                           const std::vector<std::string>& files = {});

}  // namespace taut
