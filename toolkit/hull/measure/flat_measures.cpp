#include "taut/hull/measure/flat_measures.h"

#include <algorithm>
#include <array>

#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/measure/facet_integrals.h"

namespace taut {
namespace {

/// Where a curve turns around it slows down: its speed, a root, is singular beside the curve's
/// parameters as near to them as it is slow. Parts over which the speed varies no more than by the
/// factor, and that turn by no more than the angle, are as long as they are far from there.
constexpr double most_speed_ratio = 4;
constexpr double least_turn_cosine = 0.5;
constexpr int most_length_halvings = 50;

/// Whether the speed is smooth between two parameters.
bool is_even(const ContactGeometry& geometry, const EdgeStretch& side, const Interval& t) {
  const auto velocity = [&](double s) { return geometry.jet(side.at(t.at(s))).dx[0]; };
  const std::array<dvec3, 3> v = {velocity(0), velocity(0.5), velocity(1)};
  double slowest = infinity;
  double fastest = 0;
  double cosine = 1;
  for (const dvec3& own : v) {
    slowest = std::min(slowest, glm::length(own));
    fastest = std::max(fastest, glm::length(own));
    for (const dvec3& other : v) cosine = std::min(cosine, glm::dot(unit(own), unit(other)));
  }
  return fastest <= most_speed_ratio * slowest && cosine >= least_turn_cosine;
}

void add_length(const ContactGeometry& geometry, const EdgeStretch& side, const Interval& t,
                int halvings, Sums& sums) {
  if (halvings > 0 && !is_even(geometry, side, t)) {
    add_length(geometry, side, {t.lower, t.at(0.5)}, halvings - 1, sums);
    add_length(geometry, side, {t.at(0.5), t.upper}, halvings - 1, sums);
    return;
  }
  const auto speed = [&](double s, double, Quantities& sample) {
    sample[curvature] += glm::length(geometry.jet(side.at(s)).dx[0]);
  };
  integrate<16>(speed, tolerances, t.lower, t.upper, sums);
}

/// The perimeter of a facet, in place of its curvature.
void add_perimeter(const ContactGeometry& geometry, const HullFace& face, Sums& sums) {
  for (std::size_t k = 0; k < face.points.size(); ++k) {
    if (face.sides.empty() || face.sides[k].piece < 0) {
      const dvec3& to = face.points[(k + 1) % face.points.size()];
      sums.value[curvature] += glm::distance(face.points[k], to);
      continue;
    }
    const EdgeStretch& side = face.sides[k];
    const auto [from, to] = std::minmax(side.from, side.to);
    add_length(geometry, side, {from, to}, most_length_halvings, sums);
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
