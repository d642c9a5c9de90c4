#pragma once

#include <array>
#include <optional>

#include "taut/surface/model.h"

namespace taut {

/// The ends, on the patch's border, of the straight segment that runs through the point; at a point
/// of the border one of them may be that point. None where there is no single segment: at a tip.
/// @pre the patch is developable, and immersed but for its border (is_developable)
std::optional<std::array<dvec2, 2>> ruling_ends(const BezierPatch& patch, const dvec2& uv);

/// The direction, or its opposite, of the straight segment through the point of a patch that has
/// one family of them. None elsewhere, as on a plane.
std::optional<dvec3> ruling_direction(const Patch& patch, const dvec2& uv);

}  // namespace taut
