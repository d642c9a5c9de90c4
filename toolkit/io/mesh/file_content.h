#pragma once

#include <optional>

#include "taut/surface/control_cage.h"
#include "taut/surface/model.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// What a file of one part holds. Points and polygons stand apart, so that the file's text can go
/// before they are copied.
struct FileContent {
  Part part;         ///< surfaces and curves
  PolygonMesh mesh;  ///< polygons and points
  std::optional<ControlCage> cage;
};

}  // namespace taut
