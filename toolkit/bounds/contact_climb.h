#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"
#include "taut/core/geometry.h"

namespace taut {

/// A contact and the value x . n that was climbed.
struct ClimbedContact {
  Contact contact;
  dvec3 x = dvec3(0.0);
  double h = -infinity;  ///< x . n
};

/// The local maximum of x . n that a climb from the contact leads to, over smooth joins, onto and
/// off edges and vertices. None where the climb gets lost.
std::optional<Contact> climbed(const ContactGeometry& geometry, const Contact& c, const dvec3& n);

/// The highest contact that this climb has been at, to within rounding: the local maximum, or where
/// the climb gets lost the best that it has met. In the lowest kind that it lies on
/// (ContactGeometry::canonical).
ClimbedContact climb(const ContactGeometry& geometry, const Contact& c, const dvec3& n);

}  // namespace taut
