#pragma once

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// A local maximum of x . n on the model.
struct ClimbedContact {
  Contact contact;  ///< in the lowest kind it lies on (ContactGeometry::canonical)
  Contact place;    ///< the same on the element where it was reached: to climb on from
  dvec3 x = dvec3(0.0);
  double h = 0;  ///< x . n
};

/// The local maximum to which climbed() leads from the start; the start where the climb gets lost
/// or leads no higher. Lengths in the scene's frame.
/// @pre n is unit
ClimbedContact climb(const ContactGeometry& geometry, const Contact& start, const dvec3& n);

}  // namespace taut
