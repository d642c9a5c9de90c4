#pragma once

#include <string>
#include <string_view>

#include "taut/surface/polygon_mesh.h"

namespace taut {

/// @name The readers behind read_mesh(), one a format
/// `data` is the whole file, `file` its name for messages. They throw as read_mesh() does.
/// @{
PolygonMesh read_obj_polygons(const std::string& file, std::string_view data);
PolygonMesh read_off(const std::string& file, std::string_view data);
PolygonMesh read_ply(const std::string& file, std::string_view data);
PolygonMesh read_stl(const std::string& file, std::string_view data);
/// @}

}  // namespace taut
