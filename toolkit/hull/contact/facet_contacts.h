#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// The convex hull of a plane's contact set, by its corners and sides.
struct FacetContacts {
  std::vector<Contact> contacts;  ///< counter-clockwise from outside
  std::vector<dvec3> points;
  /// As in HullFace.
  std::vector<EdgeStretch> sides;

  /// The side from corner k to the next one runs along an edge.
  bool is_curved(std::size_t k) const { return !sides.empty() && sides[k].piece >= 0; }
  bool is_curved() const;
  /// The contacts span a face with an inside.
  bool is_facet() const { return contacts.size() >= 3 || is_curved(); }
};

/// All contacts of a direction: its contact set is that of `pieces`, one at least, which lie in the
/// supporting plane as a whole (level_pieces), and of contacts found by support queries in
/// directions turned a little towards each of its sides. Begins with the contacts
/// known, none or more. One or two contacts are no facet. None where there are more than
/// facet_corner_limit contacts beside the pieces (contact along another curve), or where the
/// outline is not certain: uncertain are those no wider than same_contact, as of copies that are
/// nearly in one place. Contacts lower than others by no more than `slack`, beside tie(), count
/// too.
std::optional<FacetContacts> facet_contacts(const ContactGeometry& geometry, SupportQuery& query,
                                            const dvec3& n, const std::vector<Contact>& known,
                                            const std::vector<Contact>& pieces, double slack = 0);
inline constexpr std::size_t facet_corner_limit = 256;

}  // namespace taut
