#pragma once

#include <array>
#include <vector>

#include "taut/hull/contact_geometry.h"

namespace taut {

/// The ends of the straight segments of a ruled patch that run through the contact, on the patch's
/// borders: one, or of a patch that is ruled in both parameters two. @pre kind face
std::vector<std::array<Contact, 2>> rulings(const ContactGeometry& geometry, const Contact& c);

/// The straight line of ruled patches that leaves the contact in a unit direction, over smooth
/// joins that are no seams: where it leaves each of the patches, the last of them its end. Empty
/// where no segment leads there. @pre kind face
std::vector<Contact> ruling_path(const ContactGeometry& geometry, const Contact& c,
                                 const dvec3& along);

}  // namespace taut
