#pragma once

#include <string>
#include <string_view>

#include "taut/core/progress.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// @name The readers of polygons, one a format
/// `data` is the whole file, `file` its name for messages. They throw as read_mesh() does, and
/// Cancelled.
/// @{
PolygonMesh read_obj_polygons(const std::string& file, std::string_view data,
                              const Progress& progress);
PolygonMesh read_off(const std::string& file, std::string_view data, const Progress& progress);
PolygonMesh read_ply(const std::string& file, std::string_view data, const Progress& progress);
PolygonMesh read_stl(const std::string& file, std::string_view data, const Progress& progress);
/// @}

}  // namespace taut
