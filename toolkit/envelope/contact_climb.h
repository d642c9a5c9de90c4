#pragma once

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// A local maximum of x . n on the model.
struct ClimbedContact {
  Contact contact;  ///< in the lowest kind it lies on (ContactGeometry::canonical)
  Contact place;    ///< the same on the patch or piece where it was reached: to climb on from
  dvec3 x = dvec3(0.0);
  double h = 0;  ///< x . n
};

/// Climbs from a contact to the local maximum of x . n, in double precision: on the contact's patch
/// by Newton steps kept in it, and on across borders as long as the value grows there; along edges
/// likewise, from piece to piece and onto their patches, and from vertices onto their edges. Stops
/// at patches that are ruled and at poles. The value is at least that of the start: unlike
/// climbed(), which tells of no place where it gets lost, this climb keeps what it has reached.
/// Lengths in the scene's frame.
/// @pre n is unit
ClimbedContact climb(const ContactGeometry& geometry, const Contact& start, const dvec3& n);

}  // namespace taut
