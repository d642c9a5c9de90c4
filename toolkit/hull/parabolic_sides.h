#pragma once

#include "taut/hull/contact_geometry.h"
#include "taut/hull/sign_changes.h"

namespace taut {

/// The side's point with the free parameter t.
Contact on_side_of(Contact patch, Side side, double t);

/// A function of the side's free parameter in [0, 1] that has the sign of the surface's curvature
/// there. But where the patch is level across all of it, the curvature is minus the square of the
/// twist, which nowhere is positive: the parabolic curve touches the side, as the end of two
/// separating curves, where the twist changes sign; that is the function then.
///
/// Level are Catmull-Clark surfaces across boundaries: in a direction of their lattice, or in its
/// image in a tapered piece, which is linear along the side.
SideFunction parabolic_along(const ContactGeometry& geometry, const Contact& patch, Side side);

}  // namespace taut
