#include "taut/io/mesh/rounded_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/hull/polytope/outline.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/sample/polytope_mesh.h"

namespace taut {
namespace {

dvec3 to_floats(const dvec3& p) {
  dvec3 rounded;
  for (int i = 0; i < 3; ++i) rounded[i] = nearest_float(p[i]);
  return rounded;
}

/// An upper bound of the length. Scaling by the largest component, a square, two sums, a root and
/// the product round the exact length by less than 8 units; what underflows is far below one.
double length_bound(const dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (largest == 0) return 0;
  const double length = largest * glm::length(v / largest) * (1 + 16 * rounding_unit);
  return std::nextafter(length, std::numeric_limits<double>::infinity());
}

HullMesh planar_mesh(const PointHull& hull) {
  const auto& witness = hull.simplex();
  const PlaneView view(hull.point(witness[0]), hull.point(witness[1]), hull.point(witness[2]));
  std::vector<dvec3> corners;
  for (const int i : convex_outline(hull.points(), view)) corners.push_back(hull.point(i));
  std::vector<int> loop(corners.size());
  std::iota(loop.begin(), loop.end(), 0);
  return make_hull_mesh(corners, {loop, {loop.rbegin(), loop.rend()}});
}

}  // namespace

RoundedHull rounded_hull(const HullMesh& mesh) {
  RoundedHull result;
  std::vector<dvec3> points;
  points.reserve(mesh.n_vertices());
  Box box;
  for (const auto vertex : mesh.vertices()) {
    const dvec3 p = position(mesh, vertex);
    const dvec3 size = glm::abs(p);
    if (!(std::max({size.x, size.y, size.z}) <= double{std::numeric_limits<float>::max()})) {
      throw InvalidInput("a coordinate of vertex " + std::to_string(vertex.idx()) +
                         " is beyond the floats");
    }
    points.push_back(to_floats(p));
    box.include(points.back());
    result.rounding = std::max(result.rounding, length_bound(p - points.back()));
  }
  if (points.empty()) return result;
  PointHull hull(box);
  hull.add(points);
  if (hull.dimension() == 3) {
    std::vector<int> point_of;
    result.mesh = bare_mesh(hull, 1, hull.merged_polygons(), point_of);
  } else if (hull.dimension() == 2) {
    result.mesh = planar_mesh(hull);
  } else {
    result.mesh = make_hull_mesh({points.begin(), points.begin() + hull.dimension() + 1}, {});
  }
  return result;
}

}  // namespace taut
