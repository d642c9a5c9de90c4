#pragma once

#include <array>
#include <optional>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/contact/sign_changes.h"

namespace taut {

/// The side's point with the free parameter t.
Contact on_side_of(Contact patch, Side side, double t);

/// The piece of a straight edge that is the patch's side; none if it is no straight edge.
std::optional<Contact> straight_piece(const ContactGeometry& geometry, const Contact& patch,
                                      Side side);
/// The piece of a straight edge or seam that is the patch's side; none if it is no straight one.
std::optional<Contact> straight_piece_or_seam(const ContactGeometry& geometry, const Contact& patch,
                                              Side side);

/// The two vertices that a straight edge is between, for all its pieces in one order.
/// @pre a piece of it
std::array<Contact, 2> segment_ends(const ContactGeometry& geometry, const Contact& piece);

/// A function of the side's free parameter in [0, 1] that has the sign of the surface's curvature
/// there. But where the patch is level across all of it, the curvature is minus the square of the
/// twist, which nowhere is positive: the parabolic curve touches the side, as the end of two
/// separating curves, where the twist changes sign; that is the function then.
///
/// Level are Catmull-Clark surfaces across boundaries: in a direction of their lattice, or in its
/// image in a tapered piece, which is linear along the side.
SideFunction parabolic_along(const ContactGeometry& geometry, const Contact& patch, Side side);

}  // namespace taut
