#pragma once

#include "taut/bounds/scene.h"
#include "taut/bounds/support_query.h"

namespace taut {

/// Support value in model coordinates, with the contact in the model's terms.
struct ModelSupport {
  double h = 0;        ///< value of the contact that was found, to within a few rounding units
  double h_bound = 0;  ///< proven upper bound, rounding included
  dvec3 point = dvec3(0.0);  ///< the contact's
  SourceContact contact;     ///< where it is attained
};

/// max x . n over the model for the unit vector along `direction`, in model coordinates.
/// @throws InvalidInput if the direction is zero or not finite
ModelSupport support(SupportQuery& query, const Scene& scene, const dvec3& direction);

}  // namespace taut
