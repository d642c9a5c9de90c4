#include "taut/hull/measures.h"

#include <cmath>

namespace taut {
namespace {

/// Kahan's compensated sum, by coordinates.
template <class T>
class Sum {
 public:
  void add(const T& value) {
    const T y = value - carry_;
    const T t = sum_ + y;
    carry_ = (t - sum_) - y;
    sum_ = t;
  }
  const T& value() const { return sum_; }

 private:
  T sum_ = T(0.0);
  T carry_ = T(0.0);
};

}  // namespace

Measures measure(const PolygonMesh& mesh) {
  Box box;
  for (const dvec3& p : mesh.points) box.include(p);
  if (box.empty()) return {};
  const dvec3 origin = box.center();
  // Units of the box's size keep products of three or five lengths in range.
  const double size = diagonal(box);
  if (size == 0) return {0, 0, origin, dmat3(0.0)};
  const auto at = [&](int v) { return (mesh.points[std::size_t(v)] - origin) / size; };

  Sum<double> volume, area;
  Sum<dvec3> moment, surface_moment, squares, products;
  for (const std::vector<int>& polygon : mesh.polygons) {
    // Triangles of the fan count with the sign that they have in the polygon's plane, so that the
    // polygon need not be convex.
    const dvec3 a = at(polygon[0]);
    dvec3 vector_area(0.0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      vector_area += 0.5 * glm::cross(at(polygon[k]) - a, at(polygon[k + 1]) - a);
    }
    area.add(glm::length(vector_area));
    const dvec3 n = unit(vector_area);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      const dvec3 b = at(polygon[k]);
      const dvec3 c = at(polygon[k + 1]);
      const dvec3 sum = a + b + c;
      const double det = glm::dot(a, glm::cross(b, c));  // six times the tetrahedron's volume
      volume.add(det / 6);
      surface_moment.add(glm::dot(glm::cross(b - a, c - a), n) / 6 * sum);
      moment.add(det / 24 * sum);
      // Integral of x y over the tetrahedron (0, a, b, c): det / 120 (sum x sum y + sum of x_i
      // y_i).
      squares.add(det / 120 * (sum * sum + a * a + b * b + c * c));
      const auto mixed = [&](int i, int j) {
        return sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
      };
      products.add(det / 120 * dvec3(mixed(1, 2), mixed(2, 0), mixed(0, 1)));
    }
  }
  Measures result;
  const double v = volume.value();
  result.volume = v * size * size * size;
  result.area = area.value() * size * size;
  if (v > 0) {
    const dvec3 c = moment.value() / v;
    result.centroid = origin + size * c;
    // About the centroid, by the parallel axis theorem.
    const dvec3 s = squares.value() - v * c * c;
    const dvec3 p = products.value() - v * dvec3(c.y * c.z, c.z * c.x, c.x * c.y);
    const double unit = std::pow(size, 5);
    result.inertia = unit * dmat3(s.y + s.z, -p.z, -p.y,  //
                                  -p.z, s.z + s.x, -p.x,  //
                                  -p.y, -p.x, s.x + s.y);
  } else {
    const double a = area.value();
    result.centroid = origin + (a > 0 ? size / a * surface_moment.value() : dvec3(0.0));
  }
  return result;
}

}  // namespace taut
