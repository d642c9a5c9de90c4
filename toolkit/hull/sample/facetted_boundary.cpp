#include "taut/hull/sample/facetted_boundary.h"

#include <algorithm>
#include <map>
#include <utility>

namespace taut {
namespace {

/// A normal of a polygon's plane, by Newell's method. @pre it has an area
dvec3 normal_of(const std::vector<dvec3>& points) {
  dvec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    sum += glm::cross(points[k] - points[0], points[k + 1] - points[0]);
  }
  return unit(sum);
}

}  // namespace

HullBoundary facetted_boundary(const Scene& scene, SupportQuery& query,
                               const SampledPolytope& polytope, const Progress& progress) {
  HullBoundary boundary;
  boundary.frame = scene.frame();
  const auto point = [&](int p) {
    return boundary.frame.to_frame(polytope.hull.point(p) / boundary.frame.scale);
  };
  std::map<std::pair<int, int>, int> left_of;  // by the ends of an edge
  for (const std::vector<int>& loop : polytope.hull.merged_polygons(progress).loops) {
    progress.check();
    HullFace facet;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      facet.contacts.push_back(polytope.samples[std::size_t(loop[k])].contact);
      facet.points.push_back(point(loop[k]));
      left_of[{loop[k], loop[(k + 1) % loop.size()]}] = int(boundary.faces.size());
    }
    facet.n = normal_of(facet.points);
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
  for (const auto& [ends, left] : left_of) {
    if (ends.second < ends.first) continue;
    HullCurve curve;
    curve.faces = {left, left_of.at({ends.second, ends.first})};
    curve.points = {point(ends.first), point(ends.second)};
    boundary.curves.push_back(std::move(curve));
  }
  return boundary;
}

}  // namespace taut
