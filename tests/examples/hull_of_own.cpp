#include <cstdio>
#include <utility>
#include <vector>

#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/result/measures.h"

int main() {
  taut::Part part;
  part.add_points(std::vector<taut::dvec3>{{0, 0, 3}, {1, 0, 3}});
  // Control points are homogeneous: (w x, w y, w z, w). A quarter of a circle, then a flat sheet.
  const double w = 0.7071067811865476;
  part.add_curve({2, {0, 0, 0, 1, 1, 1}, {{2, 0, 1, 1}, {2 * w, 2 * w, w, w}, {0, 2, 1, 1}}},
                 "arc");
  part.add_surface(
      {1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {{0, 0, 0, 1}, {0, 2, 0, 1}, {2, 0, 0, 1}, {2, 2, 0, 1}}},
      "sheet");
  taut::Model model;
  model.add_part(std::move(part), taut::smooth_join_angle);
  const taut::Hull hull = taut::convex_hull(model);
  const double volume = taut::measure(taut::polygons(hull.mesh)).volume;
  std::printf("%zu exact faces, volume %.3f\n", hull.boundary->faces.size(), volume);
  return hull.kind == taut::HullKind::solid ? 0 : 1;
}
