#pragma once

#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Directions spread evenly (spherical Fibonacci lattice: Swinbank and Purser 2006), turned at
/// random.
std::vector<dvec3> even_directions(int count, unsigned seed);

}  // namespace taut
