#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/progress.h"

namespace taut {

/// Whether files of the format (".xyz") hold points as text: .xyz, .csv, .txt and .pts do.
bool is_points_format(std::string_view format);

/// Reads points as text: a line each, x y z and any further columns (normals, colours, labels),
/// which are passed over. Blank lines and what follows '#' count for nothing.
///
/// Columns stand apart by blanks and tabs, by commas or by semicolons, the same way within a line;
/// two ways in one line are refused, since they may be decimal commas. A first line of one integer
/// is the number of points, which must then be right. (Files of molecules, in which a title and
/// then lines of names follow that number, are another format and are refused.)
///
/// A first line whose columns are names, x, y and z the first three of them in any case and with or
/// without quotation marks, is passed over.
///
/// `data` is the whole file, `file` its name for messages.
/// @throws IoError, InvalidInput with place; Cancelled
std::vector<dvec3> read_xyz(const std::string& file, std::string_view data,
                            const Progress& progress);

}  // namespace taut
