#include "taut/hull/sample/facet_planes.h"

#include <algorithm>
#include <array>
#include <utility>

#include "taut/core/parallel.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Neighbours of slivers that are asked for a direction, one after the other.
constexpr std::size_t sliver_limit = 8;

}  // namespace

/// The facet itself; of a sliver, with corners in line but for rounding, the nearest
/// other facet, first across its longest side. A certificate needs no more than directions about
/// each vertex, and a sliver's own means nothing.
FacetPlanes::Facing FacetPlanes::facing(int facet) const {
  const double rounding = scene_.frame().length_to_frame(8 * vertex_rounding(scene_));
  std::vector<int> reached = {facet};
  for (std::size_t k = 0; k < reached.size() && k < sliver_limit && !slivers_count_; ++k) {
    const PointHull::Facet& own = hull_.facet(reached[k]);
    std::array<std::pair<double, int>, 3> sides;
    for (std::size_t side = 0; side < 3; ++side) {
      const dvec3& a = hull_.points()[std::size_t(own.vertex[side])];
      const dvec3& b = hull_.points()[std::size_t(own.vertex[(side + 1) % 3])];
      sides[side] = {-glm::distance(a, b), own.neighbor[side]};
    }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const dvec3 normal = own.side.normal();
    if (glm::length(normal) > -rounding * sides[0].first) return {reached[k], unit(normal)};
    for (const auto& [length, neighbor] : sides) {
      if (std::find(reached.begin(), reached.end(), neighbor) == reached.end()) {
        reached.push_back(neighbor);
      }
    }
  }
  return {facet, unit(hull_.facet(facet).side.normal())};
}

bool FacetPlanes::take_slivers_seriously() {
  if (slivers_count_) return false;
  slivers_count_ = true;
  bool changes = false;
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    options_.progress.check_rarely(f);
    if (!hull_.facets()[f].alive || planes_[f].n == facing(int(f)).n) continue;
    planes_[f].known = false;
    changes = true;
  }
  return changes;
}

bool FacetPlanes::has_lost_facet(const Plane& plane) const {
  const PointHull::Facet& facet = hull_.facet(plane.facet);
  return !facet.alive || unit(facet.side.normal()) != plane.n;
}

/// In parallel; each query starts from the contact of the vertex whose own direction is closest.
void FacetPlanes::find(const std::vector<Sample>& samples, HullStatistics& statistics) {
  fit();
  std::vector<int> wanted;
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    options_.progress.check_rarely(f);
    if (!hull_.facets()[f].alive) continue;
    if (!planes_[f].known || has_lost_facet(planes_[f])) wanted.push_back(int(f));
  }
  constexpr std::size_t grain = 64;
  std::vector<std::pair<long, long>> counts((wanted.size() + grain - 1) / grain);
  parallel_for(wanted.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    SupportQuery query(scene_, options_.progress.stop);
    for (std::size_t k = begin; k < end; ++k) {
      options_.progress.check();
      const PointHull::Facet& facet = hull_.facet(wanted[k]);
      Plane& plane = planes_[std::size_t(wanted[k])];
      plane.known = false;
      const Facing seen = facing(wanted[k]);
      plane.n = seen.n;
      plane.facet = seen.facet;
      const Sample* nearest = nullptr;
      for (const int v : facet.vertex) {
        const Sample& s = samples[std::size_t(v)];
        if (nearest == nullptr || glm::dot(s.n, plane.n) > glm::dot(nearest->n, plane.n)) {
          nearest = &s;
        }
      }
      const Support s = query(plane.n, nearest->contact);
      plane.h_bound = s.h_bound;
      plane.contact = s.contact;
      plane.point = scene_.frame().to_model(s.point);
      plane.known = true;
    }
    counts[begin / grain] = {query.queries(), query.newton_iterations()};
  });
  for (const auto& [queries, newton] : counts) {
    statistics.support_queries += queries;
    statistics.newton_iterations += newton;
  }
}

}  // namespace taut
