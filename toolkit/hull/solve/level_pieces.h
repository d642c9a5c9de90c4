#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"

namespace taut {

/// Pieces of edges that touch a plane along their whole length.
struct LevelPieces {
  dvec3 n = dvec3(0.0);         ///< of the plane through them, near the one asked for
  std::vector<Contact> pieces;  ///< straight ones apart; with parameter 0
  double off = 0;               ///< how far control points are below the supporting plane, at most
};

/// Those that are nowhere farther below the supporting plane across a direction than so much. The
/// points are to lie in the plane as well.
LevelPieces level_pieces(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
                         double depth, const std::vector<dvec3>& more = {});

}  // namespace taut
