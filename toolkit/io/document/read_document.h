#pragma once

#include <string>
#include <string_view>

#include "taut/io/document/document_encoding.h"
#include "taut/io/text/read_options.h"
#include "taut/surface/model.h"

namespace taut {

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
/// - The unit becomes the model's; numbers are taken as they stand, with a warning where the model
///   has another unit already.
/// - Keys that are not known are passed over, with one warning for each kind.
///
/// `file` begins the messages. The model is unchanged if anything is wrong.
/// @throws IoError if the data is no model document (FILE:LINE: or FILE:byte N: for its syntax,
/// FILE: parts[0].surfaces[3].knots: for what it holds), InvalidInput (with the same places) if its
/// numbers are no valid geometry, LimitExceeded for surfaces and curves with more than 2^26 control
/// points once decomposed and as Model::add_instance() does, Cancelled
void read_document(const std::string& file, std::string_view data, DocumentEncoding encoding,
                   Model& model, const ReadOptions& options = {});

}  // namespace taut
