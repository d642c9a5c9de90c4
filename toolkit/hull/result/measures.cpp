#include "taut/hull/result/measures.h"

#include <cmath>

namespace taut {
namespace {

/// Volumes of thin solids are small differences of large terms; the longer mantissa, where the
/// machine has one, keeps their sign.
using Real = long double;
using RealVector = glm::vec<3, Real>;

}  // namespace

Measures measure(const PolygonMesh& mesh) {
  Box box;
  for (const dvec3& p : mesh.points) box.include(p);
  if (box.empty()) return {};
  const dvec3 origin = box.center();
  // Units of the box's size keep products of three or five lengths in range.
  const double size = diagonal(box);
  if (size == 0) return {0, 0, origin, dmat3(0.0)};
  const auto at = [&](int v) {
    return (RealVector(mesh.points[std::size_t(v)]) - RealVector(origin)) / Real(size);
  };

  Real volume = 0, area = 0;
  RealVector moment(0), surface_moment(0), squares(0), products(0);
  for (const std::vector<int>& polygon : mesh.polygons) {
    // Triangles of the fan count with the sign that they have in the polygon's plane, so that the
    // polygon need not be convex.
    const RealVector a = at(polygon[0]);
    RealVector vector_area(0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      vector_area += Real(0.5) * glm::cross(at(polygon[k]) - a, at(polygon[k + 1]) - a);
    }
    const Real length = glm::length(vector_area);
    area += length;
    const RealVector n = length > 0 ? vector_area / length : RealVector(0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      const RealVector b = at(polygon[k]);
      const RealVector c = at(polygon[k + 1]);
      const RealVector sum = a + b + c;
      const Real det = glm::dot(a, glm::cross(b, c));  // six times the tetrahedron's volume
      volume += det / 6;
      surface_moment += glm::dot(glm::cross(b - a, c - a), n) / 6 * sum;
      moment += det / 24 * sum;
      // Integral of x y over the tetrahedron (0, a, b, c): det / 120 (sum x sum y + sum of x_i
      // y_i).
      squares += det / 120 * (sum * sum + a * a + b * b + c * c);
      const auto mixed = [&](int i, int j) {
        return sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
      };
      products += det / 120 * RealVector(mixed(1, 2), mixed(2, 0), mixed(0, 1));
    }
  }
  Measures result;
  result.volume = double(volume) * size * size * size;
  result.area = double(area) * size * size;
  if (volume > 0) {
    const RealVector c = moment / volume;
    result.centroid = origin + size * dvec3(c);
    // About the centroid, by the parallel axis theorem.
    const dvec3 s(squares - volume * c * c);
    const dvec3 p(products - volume * RealVector(c.y * c.z, c.z * c.x, c.x * c.y));
    const double unit = std::pow(size, 5);
    result.inertia = unit * dmat3(s.y + s.z, -p.z, -p.y,  //
                                  -p.z, s.z + s.x, -p.x,  //
                                  -p.y, -p.x, s.x + s.y);
  } else if (area > 0) {
    result.centroid = origin + size * dvec3(surface_moment / area);
  } else {
    result.centroid = origin;
  }
  return result;
}

}  // namespace taut
