#include "taut/hull/result/region_outline.h"

#include <algorithm>

#include "taut/core/geometry.h"

namespace taut {
namespace {

/// Adds the corners of a stretch.
void add(const HullBoundary& boundary, const PatchRegion& region, const TrimStretch& stretch,
         std::vector<dvec2>& outline) {
  if (stretch.arc < 0) {
    outline.push_back(on_side(stretch.side, stretch.from));
    outline.push_back(on_side(stretch.side, stretch.to));
    return;
  }
  const SeparatingArc& arc = boundary.arcs[std::size_t(stretch.arc)];
  const std::vector<Ruling>& rulings = arc.pieces[std::size_t(stretch.piece)].rulings;
  for (std::size_t k = 0; k < rulings.size(); ++k) {
    const Ruling& r = rulings[stretch.reversed ? rulings.size() - 1 - k : k];
    const Contact& c = r.contact[std::size_t(stretch.contact)];
    if (c.kind == SourceKind::face && c.element == region.patch) outline.emplace_back(c.u, c.v);
  }
}

double distance_to_segment(const dvec2& x, const dvec2& a, const dvec2& b) {
  const dvec2 edge = b - a;
  const double square = glm::dot(edge, edge);
  const double t = square > 0 ? std::clamp(glm::dot(x - a, edge) / square, 0.0, 1.0) : 0;
  return glm::distance(x, a + t * edge);
}

}  // namespace

RegionOutline outline_of(const HullBoundary& boundary, const PatchRegion& region) {
  RegionOutline outline;
  for (const std::vector<TrimStretch>& loop : region.loops) {
    outline.emplace_back();
    for (const TrimStretch& stretch : loop) add(boundary, region, stretch, outline.back());
  }
  return outline;
}

/// Where an odd number of sides crosses the ray towards growing v, it is inside.
double depth_in(const RegionOutline& outline, const dvec2& x) {
  bool inside = false;
  double distance = infinity;
  for (const std::vector<dvec2>& loop : outline) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const dvec2& a = loop[k];
      const dvec2& b = loop[(k + 1) % loop.size()];
      distance = std::min(distance, distance_to_segment(x, a, b));
      if ((a.x > x.x) == (b.x > x.x)) continue;
      const double v = a.y + (x.x - a.x) / (b.x - a.x) * (b.y - a.y);
      if (v > x.y) inside = !inside;
    }
  }
  return inside ? distance : -distance;
}

}  // namespace taut
