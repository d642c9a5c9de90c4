#include "taut/hull/measure/flat_measures.h"

#include <algorithm>

#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/measure/facet_integrals.h"

namespace taut {
namespace {

/// The perimeter of a facet, in place of its curvature.
void add_perimeter(const ContactGeometry& geometry, const HullFace& face, Sums& sums) {
  for (std::size_t k = 0; k < face.points.size(); ++k) {
    if (face.sides.empty() || face.sides[k].piece < 0) {
      const dvec3& to = face.points[(k + 1) % face.points.size()];
      sums.value[curvature] += glm::distance(face.points[k], to);
      continue;
    }
    const EdgeStretch& side = face.sides[k];
    const auto speed = [&](double t, double, Quantities& sample) {
      sample[curvature] += glm::length(geometry.jet(side.at(t)).dx[0]);
    };
    const auto [from, to] = std::minmax(side.from, side.to);
    integrate<16>(speed, tolerances, from, to, sums);
  }
}

}  // namespace

BoundaryMeasures flat_measures(const ContactGeometry& geometry, const HullBoundary& boundary) {
  const HullFace& face = boundary.faces.front();
  const dvec3 origin = face.points.front();
  Sums of_area;
  add_facet(geometry, face, origin, CreaseOrigins(geometry, boundary, origin), of_area);
  Sums of_outline;
  add_perimeter(geometry, face, of_outline);
  const double size = double(of_area.value[area]);
  const double perimeter = double(of_outline.value[curvature]);
  BoundaryMeasures result;
  if (!(size > 0) || !(perimeter > 0)) return result;
  const SceneFrame& frame = boundary.frame;
  const double unit_length = 1 / frame.scale;
  result.area = size * unit_length * unit_length;
  result.mean_width = 0.25 * perimeter * unit_length;
  dvec3 center(0.0);
  for (int i = 0; i < 3; ++i) {
    center[i] = double(of_area.value[surface_moment + std::size_t(i)]) / size;
  }
  result.centroid = frame.to_model(origin + center);
  result.accuracy = std::max(of_area.error[area] / size, of_outline.error[curvature] / perimeter);
  const double accuracy = result.accuracy;
  // The outline may lie farther out by the gap.
  result.bounds.area = accuracy + boundary.gap * perimeter / size;
  result.bounds.mean_width = accuracy + 8 * boundary.gap / perimeter;
  result.bounds.centroid = accuracy + boundary.gap * perimeter / size;
  return result;
}

}  // namespace taut
