#pragma once

#include <optional>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// Contacts within this distance, in the scene's frame, are of one branch of the support function.
inline constexpr double same_branch_distance = 1e-6;
/// Or, far from the origin, within the distance over which heights tie.
double branch_distance(const ContactGeometry& geometry);

/// A direction and its support contact.
struct SupportSample {
  dvec3 n;
  Contact contact;
  dvec3 x;
};

SupportSample seen(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
                   const Contact& hint);

/// Whether the contact's motion is, to first order, that to the other: then they are joined without
/// a climb.
bool is_near(const ContactGeometry& geometry, const SupportSample& from, const SupportSample& to);

/// Whether climbs lead from the one contact to the other and back: no separating curve that the
/// great arc between them crosses is known by them.
bool same_branch(const ContactGeometry& geometry, const SupportSample& a, const SupportSample& b);

/// The direction on the great arc between the two at which their contacts' branches tie, whether
/// they support there or not. None if they do not, or a branch ends before.
std::optional<CommonSupport> parting(const ContactGeometry& geometry, const SupportSample& a,
                                     const SupportSample& b);

}  // namespace taut
