#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The local maximum of x . n that a climb from the contact leads to, over smooth joins, onto and
/// off edges and vertices. None where the climb gets lost.
std::optional<Contact> climbed(const ContactGeometry& geometry, const Contact& c, const dvec3& n);

/// The contact about the pole, in whichever patch, that supports locally in a direction near the
/// pole's normal. @pre the contact lies at a pole
std::optional<Contact> beside_pole(const ContactGeometry& geometry, const Contact& pole,
                                   const dvec3& n);

}  // namespace taut
