#pragma once

#include <string>
#include <string_view>

#include "taut/io/mesh/file_content.h"
#include "taut/io/text/read_options.h"

namespace taut {

/// Reads the polygons and points, free-form surfaces and curves of a Wavefront OBJ file: Bezier
/// (one or several pieces) and B-spline, rational or not, each over the range of parameters that
/// its statement names.
///
/// A surface is a face, a curve an edge, both named after the group or object that they stand in; a
/// polyline is a curve of degree 1. Vertices that no polygon, point or element uses count for
/// nothing. `trim` and `hole` become loops of the face; they are turned to run counter-clockwise
/// and clockwise, for which the format has no rule. Special curves and statements that are not
/// known are left out with a warning; other bases are refused. Polygons are a control cage if the
/// options say so, or the file's tags and no options.
///
/// `data` is the whole file, `name` its name for messages.
/// Source: Alias|Wavefront, "Advanced Visualizer", appendix B1 "Object files" (3.0).
/// @throws as read_model()
FileContent read_obj(const std::string& name, std::string_view data, const ReadOptions& options);

}  // namespace taut
