#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// A side collapsed to a point at which the surface is smooth.
bool is_pole(const ContactGeometry& geometry, const Contact& c, Side side);

/// The collapsed side, be it a pole, a tip or a corner, on which a contact lies, up to rounding.
std::optional<Side> collapsed_side(const ContactGeometry& geometry, const Contact& c);

/// The side at whose pole the contact lies, if it does; parameters fail there.
std::optional<Side> pole_side(const ContactGeometry& geometry, const Contact& c);

/// A contact whose parameter is so near to a collapsed side is at the pole.
inline constexpr double pole_parameter = 1e-9;

/// The outward normal in the direction of Su x Sv at the contact, in the scene's frame; at a pole
/// the limit. Zero where there is none.
dvec3 unit_normal(const ContactGeometry& geometry, const Contact& c);

/// How far the rounding of coordinates may have turned the normal at a pole, in radians.
/// @pre the contact lies at a pole
double pole_turn(const ContactGeometry& geometry, const Contact& pole);

/// The pole as a place of another contact's patch, with that one's parameter along it; none if it
/// is not about the pole. @pre the contact lies at a pole
std::optional<Contact> pole_in(const ContactGeometry& geometry, const Contact& pole,
                               const Contact& other);

}  // namespace taut
