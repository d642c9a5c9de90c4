#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// @name Contacts in line
/// Where models repeat or mirror their elements, three and more contacts of one direction may lie
/// in line, all along a separating curve: corners on one straight line, curves that are moved along
/// it. Rulings lead from the first to the last of them; those between lie on the ruling.
/// @{

/// The point is no farther than same_contact from the line through a and b.
bool is_in_line(const dvec3& a, const dvec3& b, const dvec3& x);

/// Contacts in line that support at n, in their order around the facet of no area that they make:
/// from the first to the last by those that support in directions turned to the one side of the
/// line, and back by those that do to the other side; these bound the regions that meet in n. The
/// first and the last alone, where nothing between them counts.
/// @pre three or more, as points all in line
std::vector<Contact> around_line(const ContactGeometry& geometry,
                                 const std::vector<Contact>& contacts, const dvec3& n);
/// @}

}  // namespace taut
