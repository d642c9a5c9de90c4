#pragma once

#include <vector>

#include "taut/surface/model.h"

namespace taut {

/// Which parts are exact copies: per part the first that is equal to it, or itself. Parts are equal
/// if their patches, edges, vertices and polygons are, number for number and in the same order, and
/// meet in the same way; names do not count.
/// @pre the parts are connected
std::vector<int> equal_parts(const std::vector<Part>& parts);

}  // namespace taut
