#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// A supporting plane that contains whole curves of the model.
struct ContactPlane {
  dvec3 n = dvec3(0.0);  ///< unit, outward
  double offset = 0;
  /// The pieces of edges that lie in it, straight ones apart; with parameter 0.
  std::vector<Contact> pieces;
};

/// All planes that support the scene and contain plane pieces of edges that are not straight, to
/// within ContactGeometry::tie(): in their directions the whole curve supports. The samples change
/// nothing but the time: of planes that are below a sample the query is not asked.
std::vector<ContactPlane> contact_planes(const ContactGeometry& geometry, SupportQuery& query,
                                         const std::vector<Sample>& samples = {});

}  // namespace taut
