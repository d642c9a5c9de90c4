#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "taut/surface/polygon_mesh.h"

namespace taut {

/// Reads the polygons of a mesh file, positions in full double precision where the file holds
/// them: `.ply` (ascii and both binary orders), `.obj`, `.off`, `.stl` (ascii and binary; equal
/// corners become one vertex). Everything else in the file is passed over.
/// @throws IoError (FILE:LINE: or FILE:byte N: ...), InvalidInput for numbers that are not finite,
/// LimitExceeded for files above 2 GiB
PolygonMesh read_mesh(const std::filesystem::path& path);

/// Reads what a file of the format (".ply") holds; the name stands in messages.
PolygonMesh read_mesh(std::string_view data, const std::string& name, const std::string& format);

}  // namespace taut
