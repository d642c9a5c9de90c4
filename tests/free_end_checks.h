#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/solve/free_ends.h"

namespace taut_test {

/// The contact with its parameters moved by so much, towards the middle of its element.
inline taut::Contact moved_inwards(taut::Contact c, double by) {
  const auto move = [&](double& t) { t += t < 0.5 ? by : -by; };
  if (c.kind != taut::SourceKind::vertex) move(c.u);
  if (c.kind == taut::SourceKind::face) move(c.v);
  return c;
}

/// The rulings, of length zero, in which curves of the boundary end free.
inline std::vector<taut::Ruling> free_ends_of(const taut::HullBoundary& boundary) {
  std::vector<taut::Ruling> result;
  for (const taut::SeparatingArc& arc : boundary.arcs) {
    if (arc.closed) continue;
    if (arc.facet[0] < 0) result.push_back(arc.pieces.front().rulings.front());
    if (arc.facet[1] < 0) result.push_back(arc.pieces.back().rulings.back());
  }
  return result;
}

/// How far a point and direction are from a free end, in the scene's frame.
inline double distance_to(const taut::ContactGeometry& geometry, const taut::FreeEnd& end,
                          const taut::dvec3& x, const taut::dvec3& n) {
  return std::max(glm::distance(geometry.point(end.contact), x), glm::distance(end.n, n));
}

/// The free end nearest to that of a curve, of all kinds, each sought from beside it.
inline std::optional<taut::FreeEnd> sought_beside(const taut::ContactGeometry& geometry,
                                                  const taut::Ruling& end) {
  using Kind = taut::FreeEnd::Kind;
  std::optional<taut::FreeEnd> best;
  double least = std::numeric_limits<double>::infinity();
  const std::array<taut::Contact, 4> places = {end.contact[0], end.contact[1],
                                               geometry.canonical(end.contact[0]),
                                               geometry.canonical(end.contact[1])};
  for (const taut::Contact& place : places) {
    for (const Kind kind : {Kind::face, Kind::edge, Kind::border, Kind::end, Kind::corner}) {
      const auto found =
          polished(geometry, {end.n, moved_inwards(place, 1e-4), kind, taut::dvec3(0.0)});
      if (!found) continue;
      const double distance = distance_to(geometry, *found, end.point[0], end.n);
      if (distance >= least) continue;
      least = distance;
      best = found;
    }
  }
  return best;
}

/// A curve ends in a free end of the model, which its derivatives alone tell.
inline bool ends_in_free_end(const taut::ContactGeometry& geometry, const taut::Ruling& end) {
  const std::optional<taut::FreeEnd> found = sought_beside(geometry, end);
  return found && distance_to(geometry, *found, end.point[0], end.n) < 1e-12;
}

}  // namespace taut_test
