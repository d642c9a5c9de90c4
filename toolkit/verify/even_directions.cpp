#include "taut/verify/even_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "taut/core/integers.h"

namespace taut {

std::vector<dvec3> even_directions(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  const auto vector = [&] {
    const double x = gaussian(random);
    const double y = gaussian(random);
    return dvec3(x, y, gaussian(random));
  };
  const dvec3 z = unit(vector());
  const dvec3 x = unit(glm::cross(z, vector()));
  const dvec3 y = glm::cross(z, x);
  std::vector<dvec3> directions;
  directions.reserve(to_size(std::max(count, 0)));
  for (int k = 0; k < count; ++k) {
    const double height = 1 - (2 * k + 1.0) / count;
    const double radius = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * std::fmod(k * std::numbers::phi, 1.0);
    directions.push_back(unit(radius * (std::cos(angle) * x + std::sin(angle) * y) + height * z));
  }
  return directions;
}

}  // namespace taut
