#pragma once

#include <array>
#include <vector>

#include "taut/envelope/envelope_map.h"
#include "taut/envelope/image_grid.h"

namespace taut {

/// The regions of both images (EnvelopeMap::regions), in the order of their first pixels.
std::vector<EnvelopeRegion> image_regions(const EnvelopeImages::Content& content,
                                          const std::array<ImageGrid, 2>& grids);

}  // namespace taut
