#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact_system.h"
#include "taut/hull/culling.h"

namespace taut {

/// Points on the separating curves that cross the sides of the mixed cells: between two corners,
/// one of which supports the model in the direction of its normal and the other does not, some
/// contact elsewhere takes over.
std::vector<CommonSupport> surface_seeds(const ContactSystem& system, SupportQuery& query,
                                         const std::vector<CulledCell>& cells);

}  // namespace taut
