#pragma once

#include <string>
#include <string_view>

#include "taut/io/read_model.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// What a file of one part holds. Points and polygons stand apart, so that the file's text can go
/// before they are copied.
struct FileContent {
  Part part;         ///< surfaces and curves
  PolygonMesh mesh;  ///< polygons and points
};

/// Says that a cage was met, or asked for.
inline constexpr std::string_view cages_are_not_evaluated =
    "subdivision cages are not evaluated yet: --scheme bilinear takes the polygons themselves";

/// Whether the scheme asks for more than the polygons themselves.
inline bool asks_for_cage(const ReadOptions& options) {
  return options.scheme && *options.scheme != Scheme::bilinear;
}

/// Whether files of the format (".ply") hold one part.
bool is_part_format(std::string_view format);

/// @pre is_part_format(format) @throws as read_model()
FileContent read_content(std::string_view data, const std::string& name, std::string_view format,
                         const ReadOptions& options);

/// The part of a file, not connected yet; the name stands in messages.
/// @throws InvalidInput if there is nothing or its extent overflows
Part as_part(FileContent content, const std::string& name);

}  // namespace taut
