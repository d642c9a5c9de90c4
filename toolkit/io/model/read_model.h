#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "taut/io/text/read_options.h"
#include "taut/surface/model.h"

namespace taut {

/// Reads a file into the model as one more part, by the file name's extension: `.bpt` (Bezier
/// patches), `.obj` (free-form statements, polygons and points), `.off`, `.ply`, `.stl` (polygons)
/// or `.xyz` (points), or the parts and instances of a model document, `.taut.json` or
/// `.taut.cbor`; of a project, `.mlp`, the visible layers become instances. A part is named after
/// its file.
///
/// Nothing that a file says is trusted: counts, indices and numbers are checked before memory is
/// taken, and the model is unchanged if anything is wrong.
/// @throws IoError (FILE:LINE: ... or FILE:byte N: ...) if the file cannot be read or is not what
/// its format says; InvalidInput (likewise with place) if its numbers are no valid geometry or
/// there is none; BackendError for cages that OpenSubdiv does not take; LimitExceeded for files
/// above 2 GiB, surfaces with more than 2^26 control points once decomposed or trimming loops that
/// name curves far more often than their file is large, and as Model::add_instance() does;
/// Cancelled
void read_model(const std::filesystem::path& path, Model& model, const ReadOptions& options = {});

/// Reads what a file of the format (".obj") holds; the name stands in messages and names the part.
/// The files of a project are sought beside `name`.
void read_model(std::string_view data, const std::string& name, const std::string& format,
                Model& model, const ReadOptions& options = {});

}  // namespace taut
