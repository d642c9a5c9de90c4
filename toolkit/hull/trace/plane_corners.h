#pragma once

#include <array>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// @name Corners in which patches are plane
/// In vertices about which a cage is plane the surface is plane to second order: the direction of
/// contacts beside them turns with the square of their distance.
/// @{

/// The four corners of a contact's patch. @pre kind face
std::array<Contact, 4> corners_of(Contact c);

/// The patch has a normal in its corner, and no curvature; no edge is there.
bool is_plane_corner(const ContactGeometry& geometry, const Contact& corner);

/// The support with its contacts in such corners that are so near that support values do not tell
/// the two places apart, in the direction in which the corner supports; as it is where it does not.
CommonSupport settled_in_plane_corners(const ContactGeometry& geometry, SupportQuery& query,
                                       const CommonSupport& s);
/// @}

}  // namespace taut
