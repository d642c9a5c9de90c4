#pragma once

#include <optional>

#include "taut/bounds/contact_exits.h"

namespace taut {

/// @name Contacts at sides across which their patches are level
/// x . n has neither slope nor second derivative there: the direction hardly tells how far inside a
/// contact is.
/// @{

/// A patch's contact lies on the side, and x . n has no second derivative across it but rounding.
bool is_level_across(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& n);

/// A contact on one side of its patch, no corner, moved along the side by Newton's step to where
/// x . n has its maximum near by.
Contact highest_along(const ContactGeometry& geometry, Contact c, const dvec3& n);

/// The contact on a side or at an end of its element near by, if the slope of x . n there is less
/// than tie(), or than `slope`: the direction does not tell the two places apart. None if there is
/// none.
std::optional<Contact> at_level_border(const ContactGeometry& geometry, const Contact& c,
                                       const dvec3& n, double slope = 0);

/// The contact of a patch on the side, if that is an edge or a seam and the patch is level across
/// it, or so near to it that the direction does not tell, as a contact on the edge or seam: nothing
/// else holds it there. None elsewhere.
std::optional<Contact> on_level_edge(const ContactGeometry& geometry, const Contact& c, Side side,
                                     const dvec3& n);

/// A patch's contact on a side across which it is level, to within rounding: its curvature tells no
/// place. Where the third derivative tells it, that place. None elsewhere.
std::optional<Contact> inside_level(const ContactGeometry& geometry, Contact c, const dvec3& n);

/// A contact on an edge of a patch, beyond one of the patch's sides, or at a vertex at its end.
struct EdgeBeside {
  ContactExit exit;
  Contact edge;
};

/// The contact on an edge of the patch of a face's contact, or at a vertex at the edge's end,
/// another local maximum of x . n than the face's contact, as high as that to within tie(): beside
/// edges across which the patch is level. None elsewhere.
std::optional<EdgeBeside> tied_edge(const ContactGeometry& geometry, const Contact& c,
                                    const dvec3& n);

/// Where a contact slides from an edge over the exit into a face that is level across it: the local
/// maximum of x . n inside that is as high as the contact to within tie(). None elsewhere.
std::optional<Contact> tied_inside(const ContactGeometry& geometry, const Contact& edge,
                                   const ContactExit& exit, const dvec3& n);

/// A contact on an edge or a seam: x . n rises with the third power from there into a patch that is
/// level across it. The contact has left the edge, into the patch.
bool swells_beside(const ContactGeometry& geometry, const Contact& edge, const dvec3& n);

/// Where x . n stops swelling, n the normal of a patch that is level across a whole side: from the
/// contact on the side along it, to where the third derivative vanishes. To one hand of that point
/// patches have their contacts inside, to the other on the side. None if the point is not on the
/// side.
std::optional<Contact> swell_end(const ContactGeometry& geometry, Contact c, Side side,
                                 const dvec3& n);
/// @}

}  // namespace taut
