#pragma once

#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Polygons over shared vertices, as files hold them: nothing is promised about their topology.
struct PolygonMesh {
  std::vector<dvec3> points;  ///< of the vertices, in model units
  /// Vertex indices, in range, at least three a polygon.
  std::vector<std::vector<int>> polygons;
};

}  // namespace taut
