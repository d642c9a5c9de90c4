#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The contact, and the same point in all other elements of its kind of which it is on a border,
/// as far as one goes on smoothly into the next.
std::vector<Contact> about(const ContactGeometry& geometry, const Contact& c);

/// The point of `c` as a contact of the element of `other`, in whose border it lies, turned to
/// `other`. None if it does not lie there.
std::optional<Contact> expressed_in(const ContactGeometry& geometry, const Contact& c,
                                    const Contact& other);

/// The same of a contact that may lie at a pole, on all patches about it.
std::optional<Contact> in_element(const ContactGeometry& geometry, const Contact& c,
                                  const Contact& other);

/// Both lie on one smooth surface or curve: in one element, in two that go on smoothly into each
/// other, or about a smooth corner.
bool continues(const ContactGeometry& geometry, const Contact& a, const Contact& b);

/// Two neighbouring elements' contacts that are about to merge, moved onto the border, or to the
/// corner or the vertex, between them; as they are where there is none.
void move_together(const ContactGeometry& geometry, Contact& a, Contact& b);

}  // namespace taut
