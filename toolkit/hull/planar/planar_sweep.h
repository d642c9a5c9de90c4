#pragma once

#include <vector>

#include "taut/hull/planar/planar_arcs.h"

namespace taut {

/// Points of different elements as near to each other are one corner of the outline.
inline constexpr double same_corner = 1e-10;

/// Where the outline touches the supporting line of a direction.
struct Touch {
  double angle = 0;
  ArcPoint at;
  bool jump = false;  ///< a straight side, or a joint, leads here from the touch before
};

/// Sweeps a supporting line around all arcs, and finds where it goes from one element to another:
/// the touches counter-clockwise, at the given angles, where it goes over, and where between them
/// something is found farther out than the rest. The last is the first one again, a turn later.
/// @pre there are arcs; the angles ascend within one turn, three or more
std::vector<Touch> swept_touches(const PlanarArcs& arcs, const std::vector<double>& angles);

}  // namespace taut
