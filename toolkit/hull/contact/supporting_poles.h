#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/facet_contacts.h"

namespace taut {

/// A pole, of a patch with a collapsed side, that supports the model in the direction of its
/// normal.
struct SupportingPole {
  dvec3 n = dvec3(0.0);
  Contact contact;
  double turn = 0;  ///< to within which the normal is known (pole_turn)
};

/// The supporting poles of all patches: where several meet, each of them. Repeated patches are left
/// out.
std::vector<SupportingPole> supporting_poles(const ContactGeometry& geometry, SupportQuery& query);

/// A direction that is known to have three contacts or more, some of them at poles.
struct Landmark {
  dvec3 n = dvec3(0.0);
  FacetContacts facet;
};

/// Whether n is the direction of one of the landmarks.
bool is_landmark(std::span<const Landmark> landmarks, const dvec3& n);

/// The facet at whose corner the pole lies, with two other contacts or more: Newton's method does
/// not find it. Where the pole's normal is not known to within rounding, its plane is that of the
/// contacts. None if there is none.
std::optional<Landmark> facet_at_pole(const ContactGeometry& geometry, SupportQuery& query,
                                      const SupportingPole& pole);

}  // namespace taut
