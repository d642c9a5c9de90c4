#pragma once

#include <string>
#include <string_view>

#include "taut/io/text/read_options.h"
#include "taut/surface/model.h"

namespace taut {

/// Reads a MeshLab project (`.mlp`, the XML form): each `MLMesh` names a file, relative to the
/// project's folder, and perhaps an `MLMatrix44` that it stands under.
///
/// Layers of one file under rigid matrices are instances of one part; a matrix that scales, shears
/// or mirrors makes a part of its own. Layers that are not visible are left out with a warning, and
/// so are rasters. A layer can be anything but another project.
///
/// `data` is the whole file; `file` its name for messages, and its folder is that of the name.
/// @throws as read_model(), errors of a layer's file with the place in the project before them;
/// also LimitExceeded for a project above 64 MiB, or for more than 2^26 control points of files
/// that are repeated under matrices which are not rigid. The model is then unchanged.
void read_project(const std::string& file, std::string_view data, Model& model,
                  const ReadOptions& options);

}  // namespace taut
