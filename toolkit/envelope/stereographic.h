#pragma once

#include "taut/core/geometry.h"

namespace taut {

/// Which half of the sphere of directions an image is about.
enum class Hemisphere {
  north,  ///< n.z >= 0, projected from the south pole (0, 0, -1)
  south,  ///< n.z <= 0, projected from the north pole (0, 0, 1)
};
inline constexpr std::array<Hemisphere, 2> hemispheres = {Hemisphere::north, Hemisphere::south};

/// A square image of the sphere of directions by stereographic projection on the plane z = 0.
///
/// The direction n is at (x, y) = (n.x, n.y) / (1 + pole n.z) with pole = 1 in the north image and
/// -1 in the south one, +x to the right and +y up in both. The image shows -1 <= x, y <= 1: its
/// hemisphere in the inscribed circle, and some of the other one in the corners. Pixel (0, 0) is at
/// the top left, and the pixel (column, row) stands for the direction at its centre:
///     column = size / 2 - 1/2 + size / 2 * n.x / (1 + pole n.z),
///     row    = size / 2 - 1/2 - size / 2 * n.y / (1 + pole n.z).
struct StereographicView {
  Hemisphere hemisphere = Hemisphere::north;  ///< that the inscribed circle shows
  int size = 1;                               ///< width and height, in pixels

  /// 1 in the north image, -1 in the south one.
  double pole() const { return hemisphere == Hemisphere::north ? 1 : -1; }
  /// The direction's place in the plane. @pre n is not the pole from which is projected
  dvec2 plane(const dvec3& n) const { return dvec2(n.x, n.y) / (1 + pole() * n.z); }
  /// The unit direction of a place in the plane.
  dvec3 direction(const dvec2& p) const {
    const double r2 = glm::dot(p, p);
    return dvec3(2.0 * p, pole() * (1 - r2)) / (1 + r2);
  }
  /// (column, row) of a direction; pixels' centres are at integers.
  dvec2 pixel(const dvec3& n) const {
    const dvec2 p = plane(n);
    const double half = 0.5 * size;
    return {half - 0.5 + half * p.x, half - 0.5 - half * p.y};
  }
  /// The unit direction of a place given in pixels.
  dvec3 direction_at(double column, double row) const {
    return direction(dvec2(2 * (column + 0.5) / size - 1, 1 - 2 * (row + 0.5) / size));
  }
};

/// The image in whose inscribed circle the direction is.
inline Hemisphere hemisphere_of(const dvec3& n) {
  return n.z >= 0 ? Hemisphere::north : Hemisphere::south;
}

}  // namespace taut
