#pragma once

#include <string>

#include "taut/surface/model.h"

namespace taut {

/// Why the model bounds no volume: where its surface is open, or more than two faces meet, for the
/// first such place; empty if every surface of it is closed. Curves and points do not count, but a
/// model of them alone bounds nothing. Polygons are closed if every side has exactly two of them,
/// and must be planar but for rounding.
std::string why_not_closed(const Model& model);

/// Proven bound of how far the two sides of any join of the part's patches are apart, in model
/// units. At most join_distance of the part's diagonal, within which Part::connect has joined them.
double largest_crack(const Part& part);

}  // namespace taut
