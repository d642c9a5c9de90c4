#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"

namespace taut {

/// The plane across n at this height, x . n in the scene's frame, supports the model: nothing
/// reaches above it by more than tie() and `slack`. `hint`: a contact near the farthest one.
/// @pre n is unit @throws Cancelled
inline bool is_supporting(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
                          double height, const Contact& hint, double slack = 0) {
  return query(n, hint).h <= height + geometry.tie() + slack;
}

}  // namespace taut
