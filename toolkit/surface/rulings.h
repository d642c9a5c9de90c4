#pragma once

#include <array>
#include <optional>

#include "taut/surface/bezier.h"

namespace taut {

/// The ends, on the patch's border, of the straight segment of a developable patch that runs
/// through a point of it; at a point of the border one of them may be that point. None where the
/// patch has no single segment: at a tip, and about a point where it is flat.
/// @pre the patch is developable, and immersed but for its border (is_developable)
std::optional<std::array<dvec2, 2>> ruling_ends(const BezierPatch& patch, const dvec2& uv);

}  // namespace taut
