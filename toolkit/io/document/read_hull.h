#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "taut/core/progress.h"
#include "taut/hull/result/hull_document.h"
#include "taut/io/document/document_encoding.h"

namespace taut {

/// Reads a hull document. Ids of faces and curves become places in the lists. What it says is
/// consistent as far as one can tell without geometry: references exist, contacts have the
/// parameters that their sources have, Bezier patches have valid degrees and weights.
///
/// `name` begins the messages.
/// @throws IoError if the file cannot be read or is no hull document (NAME:LINE: or NAME:byte N:
/// for its syntax, NAME: faces[3].rulings[0].n: for what it holds), InvalidInput (with the same
/// places) if its numbers are no valid geometry, Cancelled
HullDocument read_hull(std::string_view data, const std::string& name, DocumentEncoding encoding,
                       const Progress& progress = {});
HullDocument read_hull(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace taut
