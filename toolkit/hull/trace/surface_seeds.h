#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/cull/culling.h"

namespace taut {

/// The side of a cell from a corner that supports the model, in the direction of its normal, to one
/// that does not: a separating curve crosses it.
struct SupportChange {
  Contact on;
  Contact off;     ///< of the same patch, with u or v the same
  int sign = 1;    ///< the outward normal is sign * (Su x Sv)
  dvec3 n;         ///< normal at `off`
  Contact winner;  ///< supports in n
};

/// All of them at the mixed cells' sides, none twice. @pre the cells of a patch follow each other
std::vector<SupportChange> support_changes(const ContactGeometry& geometry, SupportQuery& query,
                                           std::span<const CulledCell> cells);

/// A point on the separating curve, where the side crosses it. None if it is about to end there
/// (merge_distance), or cannot be found.
std::optional<CommonSupport> separating_seed(const ContactSystem& system, SupportQuery& query,
                                             const SupportChange& change);

}  // namespace taut
