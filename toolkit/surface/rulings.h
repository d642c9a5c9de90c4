#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/surface/model.h"

namespace taut {

/// @name Straight segments of ruled patches
/// `bent`: and of those that miss being ruled by no more (Patch::lines).
/// @{

/// Of a developable patch, whatever its parameters, the ends of the segment through the point, on
/// the patch's border; at a point of the border one of them may be that point. None where there is
/// no single segment: at a tip.
/// @pre the patch is immersed but for its border (is_developable)
std::optional<std::array<dvec2, 2>> ruling_ends(const BezierPatch& patch, const dvec2& uv);

/// The ends of all segments through the point that the patch is known for: one, or of a patch that
/// is ruled in both parameters two, along v first.
std::vector<std::array<dvec2, 2>> rulings(const Patch& patch, const dvec2& uv, double bent = 0);

/// A unit direction, or its opposite, and the angle by which rounding may have turned it.
struct RulingDirection {
  dvec3 along = dvec3(0.0);
  double rounding = 0;
};

/// The direction of the segment through the point of a patch that has one family of them. None
/// elsewhere, as on a plane. Where the segments run across the parameter lines, it is found by the
/// curvature, and the less sure the less there is of that.
std::optional<RulingDirection> ruling_at(const Patch& patch, const dvec2& uv, double bent = 0);
std::optional<dvec3> ruling_direction(const Patch& patch, const dvec2& uv);

/// A point of a part, on a patch.
struct PatchPoint {
  int patch = -1;
  dvec2 uv = dvec2(0.0);
};

dvec3 point(const Part& part, const PatchPoint& at);

/// The straight line of ruled patches that leaves the point in a unit direction, over smooth joins
/// that are no seams: where it leaves each of the patches, the last of them its end. Empty where no
/// segment leads there.
std::vector<PatchPoint> ruling_path(const Part& part, const PatchPoint& from, const dvec3& along,
                                    double bent = 0);
/// @}

}  // namespace taut
