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

/// A contact on an edge of a patch, beyond one of the patch's sides, or at a vertex at its end.
struct EdgeBeside {
  ContactExit exit;
  Contact edge;
};

/// @}

}  // namespace taut
