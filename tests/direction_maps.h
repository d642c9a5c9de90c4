#pragma once

#include "taut/hull/exact_boundary.h"

namespace taut_test {

/// The map of directions as hulls have it.
inline taut::DirectionMap directions_of(const taut::ContactGeometry& geometry) {
  taut::HullStatistics statistics;
  return taut::directions_of(geometry, {}, statistics);
}

}  // namespace taut_test
