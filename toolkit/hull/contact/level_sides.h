#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// @name Contacts at sides across which their patches are level
/// x . n has neither slope nor second derivative there: the direction hardly tells how far inside a
/// contact is.
/// @{

/// A patch's contact lies on the side, and x . n has no second derivative across it but rounding.
bool is_level_across(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& n);

/// The contact on a side or at an end of its element near by, if the slope of x . n there is less
/// than tie(), or than `slope`: the direction does not tell the two places apart. None if there is
/// none.
std::optional<Contact> at_level_border(const ContactGeometry& geometry, const Contact& c,
                                       const dvec3& n, double slope = 0);

/// @}

}  // namespace taut
