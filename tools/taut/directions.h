#pragma once

#include <string>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/stop.h"

namespace taut::tool {

/// Reads directions, one a line: three numbers, not all zero, not necessarily a unit vector. They
/// stand apart by blanks, commas or semicolons. Blank lines are passed over, and so is the rest of
/// a line from a '#'. "-" is standard input.
/// @throws IoError (FILE:LINE: ...) for a line that is not three numbers, InvalidInput (likewise)
/// for a zero vector and for numbers that are not finite, Cancelled
std::vector<dvec3> read_directions(const std::string& path, const Stop& stop);

/// The same of points, of which any that are finite will do.
std::vector<dvec3> read_points(const std::string& path, const Stop& stop);

}  // namespace taut::tool
