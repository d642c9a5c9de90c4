#pragma once

#include <filesystem>
#include <string>

#include "taut/io/document/document_encoding.h"
#include "taut/surface/model.h"

namespace taut {

/// The model as a document. Reading it gives the same model: the same surfaces, curves, points,
/// names and instances, to the last bit, connected by the angle that the reader is given.
///
/// - A face of several patches is one B-spline surface, whose inner knots have multiplicity degree
///   where the patches' control points agree and degree + 1 where they do not.
/// - Where no Euclidean coordinate times its weight rounds to a homogeneous one, the key "ulps" of
///   its surface or curve says by how many doubles the product is off: [index of the point, along v
///   within u, and one integer for each coordinate]. A reader that does not know it loses a bit.
///   (Coordinates that underflow are not kept so.)
/// - Control cages are written as such, not as patches; polygons as a bilinear cage, with all
///   points of their part. Border edges are not written.
/// - The unit is the model's, left out where none is known; names that are no UTF-8 have what is
///   none replaced; zeros lose their signs.
/// @throws InvalidInput if a trim loop's Euclidean coordinate overflows
std::string to_document(const Model& model, DocumentEncoding encoding);

/// Writes the model as a document, the encoding by the path's extension. The file appears whole or
/// not at all.
/// @throws IoError if the extension is neither .taut.json nor .taut.cbor or the file cannot be
/// written, InvalidInput as to_document() does
void write_model(const std::filesystem::path& path, const Model& model);

}  // namespace taut
