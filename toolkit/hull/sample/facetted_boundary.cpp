#include "taut/hull/sample/facetted_boundary.h"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace taut {
namespace {

/// A side of a polygon, with the polygon to its left; `falls`: from the higher to the lower end.
struct PolygonSide {
  int low, high;
  bool falls;
  int left;
};

void sort(std::vector<PolygonSide>& sides, const Progress& progress) {
  std::size_t compared = 0;
  std::sort(sides.begin(), sides.end(), [&](const PolygonSide& a, const PolygonSide& b) {
    progress.check_rarely(++compared);
    return std::tie(a.low, a.high, a.falls) < std::tie(b.low, b.high, b.falls);
  });
}

}  // namespace

HullBoundary facetted_boundary(const Scene& scene, SupportQuery& query,
                               const SampledPolytope& polytope, const Progress& progress) {
  HullBoundary boundary;
  boundary.frame = scene.frame();
  boundary.gap = boundary.frame.length_to_frame(polytope.distance_bound);
  const auto point = [&](int p) {
    return boundary.frame.to_frame(polytope.hull.point(p) / boundary.frame.scale);
  };
  std::vector<PolygonSide> sides;
  for (const std::vector<int>& loop : polytope.hull.merged_polygons(progress).loops) {
    progress.check();
    HullFace facet;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      facet.contacts.push_back(polytope.samples[std::size_t(loop[k])].contact);
      facet.points.push_back(point(loop[k]));
      const auto [low, high] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
      sides.push_back({low, high, loop[k] == high, int(boundary.faces.size())});
    }
    facet.n = polygon_normal(facet.points);
    const Support top = query(facet.n, facet.contacts[0]);
    facet.offset = -infinity;
    double lowest = infinity;
    for (const dvec3& x : facet.points) {
      facet.offset = std::max(facet.offset, glm::dot(x, facet.n));
      lowest = std::min(lowest, glm::dot(x, facet.n));
    }
    facet.tolerant = std::max(0.0, top.h_bound - lowest);
    boundary.faces.push_back(std::move(facet));
  }
  sort(sides, progress);
  for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
    progress.check();
    const PolygonSide& rising = sides[k];
    assert(rising.low == sides[k + 1].low && rising.high == sides[k + 1].high && !rising.falls &&
           sides[k + 1].falls);
    HullCurve curve;
    curve.faces = {rising.left, sides[k + 1].left};
    curve.points = {point(rising.low), point(rising.high)};
    boundary.curves.push_back(std::move(curve));
  }
  return boundary;
}

}  // namespace taut
