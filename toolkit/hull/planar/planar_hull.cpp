#include "taut/hull/planar/planar_hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/hull/planar/outline_chain.h"
#include "taut/hull/planar/planar_arcs.h"
#include "taut/hull/planar/planar_sweep.h"

namespace taut {
namespace {

constexpr int first_directions = 192;
constexpr int most_rounds = 4;

/// Irregular, so that symmetric models have no ties there.
std::vector<double> regular_angles(int count) {
  constexpr double offset = 0.3711;
  std::vector<double> angles;
  angles.reserve(std::size_t(count));
  for (int k = 0; k < count; ++k) angles.push_back(2 * std::numbers::pi * (k + offset) / count);
  return angles;
}

void leave_out_inside(PlanarArcs& arcs) {
  constexpr int corners = 32;
  std::vector<dvec2> polygon;
  polygon.reserve(corners);
  int preferred = -1;
  for (const double angle : regular_angles(corners)) {
    const ArcPoint p = arcs.support(direction_at(angle), preferred);
    preferred = p.arc;
    if (polygon.empty() || p.x != polygon.back()) polygon.push_back(p.x);
  }
  while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  arcs.leave_out_inside(polygon);
}

}  // namespace

PlanarHull planar_hull(std::span<const dvec2> points, std::span<const std::vector<dvec3>> curves,
                       const Stop& stop) {
  PlanarArcs arcs(points, curves, stop);
  PlanarHull hull;
  if (arcs.empty()) return hull;
  leave_out_inside(arcs);
  std::vector<double> more;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> angles = regular_angles(first_directions << round);
    angles.insert(angles.end(), more.begin(), more.end());
    std::sort(angles.begin(), angles.end());
    OutlineChain chain(arcs, points, swept_touches(arcs, angles));
    const std::vector<dvec2> failures = chain.failures();
    chain.drop_collinear();
    hull.sides = chain.sides();
    hull.verified = failures.empty();
    if (hull.verified) break;
    for (const dvec2& n : failures) {
      const double angle = std::atan2(n.y, n.x);
      more.push_back(angle < 0 ? angle + 2 * std::numbers::pi : angle);
    }
  }
  return hull;
}

}  // namespace taut
