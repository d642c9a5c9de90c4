#pragma once

#include <array>

#include "taut/envelope/envelope_map.h"
#include "taut/envelope/image_grid.h"

namespace taut {

/// Fills the map's regions, in the order of their first pixels, and its pixels' numbers of them.
/// @pre the map's size is that of the images
void find_regions(const EnvelopeContent& content, const std::array<ImageGrid, 2>& grids,
                  EnvelopeMap& map);

}  // namespace taut
