#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact_system.h"

namespace taut {

/// Values of two contacts that differ by no more than this, in the scene's frame, are one: ten
/// times what a support query may miss (support_slack).
inline constexpr double support_tie = 1e-12;

/// Contacts nearer than this, in the scene's frame, are one. Two contacts of one direction that are
/// so near are about to merge in a free end; they differ in height by the fourth power of it.
inline constexpr double same_contact = 1e-7;

/// Three contacts that support at a common direction, to within support_tie: that of `s` where two
/// are given, and the one by which `winner` surpasses them nearby. None if Newton's method leads
/// nowhere. `s` is a start near the solution.
std::optional<CommonSupport> common_plane(const ContactSystem& system, SupportQuery& query,
                                          const CommonSupport& s, Contact winner);

/// The contacts of a plane that make the corners of its contact set's convex hull.
struct FacetContacts {
  std::vector<Contact> contacts;  ///< counter-clockwise from outside
  std::vector<dvec3> points;
};

/// All contacts of a direction: the corners of the convex hull of its contact set, found by support
/// queries in directions turned a little all around and towards each of its sides. Begins with the
/// contacts known, none or more. One or two contacts are no facet. None where there are more than
/// facet_corner_limit (contact along a curve).
std::optional<FacetContacts> facet_contacts(const ContactGeometry& geometry, SupportQuery& query,
                                            const dvec3& n, const std::vector<Contact>& known);
inline constexpr std::size_t facet_corner_limit = 24;

}  // namespace taut
