#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "taut/io/read_model.h"
#include "taut/surface/model.h"

namespace taut {

/// The two encodings of a model document: `.taut.json` and `.taut.cbor` (RFC 8949).
enum class DocumentEncoding { json, cbor };

/// Adds the parts and instances of a model document to the model; without "instances" each part
/// stands once, at rest.
///
/// - Surfaces and free curves are taken as they are, also where their knots are not clamped.
/// - Edges that name "faces" are borders of surfaces, which Taut finds by itself: they are checked
///   and left out. Edges without are free curves, "vertices" free points.
/// - Cages of the schemes "catmark" and "loop" are control cages (ControlCage): "creases" are
/// [vertex,
///   vertex, sharpness], "corners" [vertex, sharpness], "holes" faces; "boundary" is as name_of()
///   has it, "crease_method" "uniform" or "chaikin", "triangle_rule" "catmark" or "smooth"; the
///   first of each where the key is absent. Those of the scheme "bilinear" are polygons, in which
///   tags change nothing.
/// - A model has no unit: the numbers are taken as they stand, with a warning where the unit is
///   not "mm".
/// - Keys that are not known are passed over, with one warning for each kind.
///
/// `file` begins the messages. The model is unchanged if anything is wrong.
/// @throws IoError if the data is no model document (FILE:LINE: or FILE:byte N: for its syntax,
/// FILE: parts[0].surfaces[3].knots: for what it holds), InvalidInput (with the same places) if its
/// numbers are no valid geometry, LimitExceeded for surfaces and curves with more than 2^26 control
/// points once decomposed and as Model::add_instance() does, Cancelled
void read_document(const std::string& file, std::string_view data, DocumentEncoding encoding,
                   Model& model, const ReadOptions& options = {});

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
/// - The unit is "mm", the format's; names that are no UTF-8 have what is none replaced; zeros lose
///   their signs.
/// @throws InvalidInput if a trim loop's Euclidean coordinate overflows
std::string to_document(const Model& model, DocumentEncoding encoding);

/// Writes the model as a document, the encoding by the path's extension. The file appears whole or
/// not at all.
/// @throws IoError if the extension is neither .taut.json nor .taut.cbor or the file cannot be
/// written, InvalidInput as to_document() does
void write_model(const std::filesystem::path& path, const Model& model);

}  // namespace taut
