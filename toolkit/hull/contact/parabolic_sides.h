#pragma once

#include <functional>
#include <optional>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The side's point with the free parameter t.
Contact on_side_of(Contact patch, Side side, double t);

/// The piece of a straight edge that is the patch's side; none if it is no straight edge.
std::optional<Contact> straight_piece(const ContactGeometry& geometry, const Contact& patch,
                                      Side side);

/// A function of the free parameter along the side of a patch.
using SideFunction = std::function<double(double)>;

/// A function of the side's free parameter in [0, 1] that has the sign of the surface's curvature
/// there. But where the patch is level across all of it, the curvature is minus the square of the
/// twist, which nowhere is positive: the parabolic curve touches the side, as the end of two
/// separating curves, where the twist changes sign; that is the function then.
///
/// Level are Catmull-Clark surfaces across boundaries: in a direction of their lattice, or in its
/// image in a tapered piece, which is linear along the side.
SideFunction parabolic_along(const ContactGeometry& geometry, const Contact& patch, Side side);

}  // namespace taut
