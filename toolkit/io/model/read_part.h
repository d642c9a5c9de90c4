#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "taut/io/read_model.h"
#include "taut/surface/control_cage.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// What a file of one part holds. Points and polygons stand apart, so that the file's text can go
/// before they are copied.
struct FileContent {
  Part part;         ///< surfaces and curves
  PolygonMesh mesh;  ///< polygons and points
  std::optional<ControlCage> cage;
};

/// Whether files of the format (".ply") hold one part.
bool is_part_format(std::string_view format);

/// @pre is_part_format(format) @throws as read_model()
FileContent read_content(std::string_view data, const std::string& name, std::string_view format,
                         const ReadOptions& options);

/// The part of a file, not connected yet; the name stands in messages.
/// @throws InvalidInput if there is nothing or its extent overflows, or the cage is not valid;
/// BackendError if OpenSubdiv does not take it
Part as_part(FileContent content, const std::string& name, const ReadOptions& options);

}  // namespace taut
