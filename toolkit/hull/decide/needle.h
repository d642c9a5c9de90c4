#pragma once

#include <array>
#include <optional>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// Boxes of the two halves of points within half of the resolution of a straight segment, which is
/// longer than the resolution; none of others.
std::optional<std::array<Box, 2>> needle_halves(std::span<const dvec3> points, double resolution);

}  // namespace taut
