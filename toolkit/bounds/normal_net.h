#pragma once

#include <vector>

#include "taut/bounds/scalar_net.h"
#include "taut/surface/bezier.h"

namespace taut {

/// The normals of a patch as a tensor-product Bernstein net of vectors: a positive factor times
/// Su x Sv at every (u, v), so that the normals lie in the cone of the vectors (Sederberg and
/// Meyers 1988).
struct NormalNet {
  NetShape shape;
  std::vector<dvec3> vectors;  ///< v within u
  /// No vector is farther than this from the exact one, also where control points are off by the
  /// rounding of a motion.
  double rounding_bound = 0;
};

/// Degrees (2p - 1, 2q - 1) for a polynomial patch of degrees (p, q), (3p - 2, 3q - 2) for a
/// rational one.
///
/// Where a side is collapsed the vectors along it are zero, or no longer than rounding_bound; a
/// patch that is a curve or a point has no others.
/// @pre degrees are at least 1, weights positive
NormalNet normal_net(const BezierPatch& patch);

}  // namespace taut
