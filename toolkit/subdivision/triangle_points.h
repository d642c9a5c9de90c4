#pragma once

#include <cstddef>

namespace taut {

/// Where a triangular net of a degree has the point that counts i towards the second corner and j
/// towards the third one: (0,0) .. (n,0), (0,1) .. (n-1,1), .. (0,n).
constexpr std::size_t triangle_point(std::size_t degree, std::size_t i, std::size_t j) {
  return j * (2 * degree + 3 - j) / 2 + i;
}

/// The degree of a triangular net of so many points.
constexpr std::size_t triangle_degree_of(std::size_t points) {
  std::size_t degree = 0;
  while ((degree + 1) * (degree + 2) / 2 < points) ++degree;
  return degree;
}

}  // namespace taut
