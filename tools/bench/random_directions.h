#pragma once

#include <random>
#include <vector>

#include "taut/core/geometry.h"

/// Evenly distributed over the sphere.
inline std::vector<taut::dvec3> random_directions(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  std::vector<taut::dvec3> result;
  while (result.size() < count) {
    const double x = gaussian(random);
    const double y = gaussian(random);
    result.push_back(taut::unit({x, y, gaussian(random)}));
  }
  return result;
}
