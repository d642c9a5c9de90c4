#pragma once

#include <filesystem>

#include "taut/hull/hull_mesh.h"

namespace taut {

/// Writes a hull mesh by the file name's extension: `.ply` (binary, doubles, with the origin of
/// every vertex and face and colours), `.obj` (grouped by hull face, with an .mtl beside it),
/// `.off`, `.stl` (binary, float).
///
/// The file appears whole or not at all: it is written under a temporary name beside the target
/// and renamed. Polygons of more than 255 vertices are split.
/// @throws IoError if it cannot be written or the extension is not known
void write_mesh(const std::filesystem::path& path, const HullMesh& mesh);

}  // namespace taut
