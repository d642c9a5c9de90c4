#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

using Triangle = std::array<int, 3>;

/// Triangles in Embree's bounding volume hierarchy, normalised to a box of size one about the
/// origin. Embree works in floats: what it finds proposes, and is to be decided in double
/// precision.
///
/// Immutable, safe to query concurrently.
class TriangleRays {
 public:
  /// @pre triangles not empty, coordinates finite @throws BackendError or LimitExceeded if Embree
  /// fails
  TriangleRays(std::span<const dvec3> points, std::span<const Triangle> triangles);
  ~TriangleRays();
  TriangleRays(TriangleRays&&) noexcept;
  TriangleRays& operator=(TriangleRays&&) noexcept;

  /// The first triangle that the ray meets, -1 if it meets none.
  int first_hit(const dvec3& origin, const dvec3& direction) const;

  /// What all_hits() found.
  struct Hits {
    std::vector<int> triangles;  ///< ascending, none twice
    /// A triangle was met so near to a side that floats may have missed its neighbour, or it stands
    /// nearly along the ray.
    bool doubtful = false;
  };
  /// All triangles that the ray meets, into `hits`. @pre |direction| = 1 within rounding
  void all_hits(const dvec3& origin, const dvec3& direction, Hits& hits) const;

  /// The distance of the triangle nearest to x that is nearer than `radius`, else `radius`.
  /// `distance` gives that of a triangle, by number, in double precision.
  double nearest(const dvec3& x, double radius,
                 const std::function<double(int triangle)>& distance) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace taut
