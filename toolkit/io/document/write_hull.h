#pragma once

#include <filesystem>
#include <string>

#include "taut/hull/result/hull_document.h"
#include "taut/io/document/document_encoding.h"

namespace taut {

/// The document in one of its encodings; numbers round-trip. @pre all numbers are finite
std::string to_document(const HullDocument& hull, DocumentEncoding encoding);

/// Writes the document, the encoding by the path's extension. The file appears whole or not at all.
/// @throws IoError if the extension is neither .hull.json nor .hull.cbor or the file cannot be
/// written
void write_hull(const std::filesystem::path& path, const HullDocument& hull);

}  // namespace taut
