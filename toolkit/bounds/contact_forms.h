#pragma once

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The contact with its parameters moved into [0, 1], where they have left that.
Contact clamped(Contact c);

/// The contact in its canonical form where it supports in the direction n; inside of a straight
/// edge or of a ruled patch, which support only together with the ends of the segments in them, the
/// higher of these ends.
Contact at_rest(const ContactGeometry& geometry, const Contact& c, const dvec3& n);

/// The contact on those borders and ends of its element from which it is no farther than this.
Contact moved_to_border(const ContactGeometry& geometry, Contact c, double distance);

/// The contact of a patch on those of its sides no farther away beyond which a ruled patch is bent
/// (ContactGeometry::is_beside_bent).
Contact moved_to_bent(const ContactGeometry& geometry, Contact c, double distance);

/// The contact in its canonical form where it lies within rounding of a border, an end or a pole:
/// no farther than `distance`.
Contact snapped(const ContactGeometry& geometry, const Contact& c, double distance);

/// The normal form of a contact on a collapsed side, where the parameter along the side is any: at
/// that of a contact of the same element beside it, from which a curve comes. Other contacts
/// stay as they are.
Contact turned_to(const ContactGeometry& geometry, Contact c, const Contact& beside);

}  // namespace taut
