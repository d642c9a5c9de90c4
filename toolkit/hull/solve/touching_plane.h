#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/support_query.h"

namespace taut {

/// A plane that several contacts touch. Lengths are in the scene's frame.
struct TouchingPlane {
  dvec3 n = dvec3(0.0);
  std::vector<ClimbedContact> contacts;  ///< local maxima of x . n, in the order asked for
  /// By how much the lowest of them is below the highest, and how much anything is above that.
  double spread = 0;
  double above = 0;
  bool in_line = false;  ///< the contacts tell the plane only up to turns about a line

  double off() const { return std::max(spread, above); }
};

/// The plane near n that all of the contacts touch, as well as that is possible: Gauss-Newton's
/// method on their heights as functions of n, which are the contacts' support functions, so that it
/// converges quadratically where they do have a common plane. Contacts in line leave n where it is
/// about the line.
/// @pre two contacts or more
TouchingPlane touching_plane(const ContactGeometry& geometry, SupportQuery& query, dvec3 n,
                             const std::vector<Contact>& contacts);

/// Of contacts in line, whose plane may turn about the line: the plane at which the first of them
/// leaves the line, between directions beside it; as it is if none does, or all have. The contacts
/// are those that the plane was asked for with; those in the line then are on borders that are
/// lower by no more than `depth`.
TouchingPlane turned_to_part(const ContactGeometry& geometry, SupportQuery& query,
                             const TouchingPlane& plane, const std::vector<Contact>& contacts,
                             const std::vector<dvec3>& beside, double depth);

}  // namespace taut
