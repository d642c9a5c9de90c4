#pragma once

#include <array>
#include <vector>

#include "taut/envelope/envelope_map.h"
#include "taut/envelope/image_grid.h"

namespace taut {

/// The separating curves of both images (EnvelopeMap::curves), chain by chain.
std::vector<EnvelopeCurve> chain_curves(const EnvelopeContent& content,
                                        const std::array<ImageGrid, 2>& grids);

}  // namespace taut
