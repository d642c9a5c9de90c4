#include "taut/hull/sample/sampled_start.h"

#include <algorithm>
#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

void add(const Scene& scene, SupportQuery& query, const std::vector<dvec3>& directions,
         double width, SampledStart& start) {
  for (const dvec3& n : directions) {
    const Support s = query(n);
    const dvec3 point = scene.frame().to_model(s.point);
    const dvec3 frame_point = scene.frame().to_frame(point);
    const bool near_another =
        std::any_of(start.frame_points.begin(), start.frame_points.end(),
                    [&](const dvec3& other) { return glm::distance(other, frame_point) < width; });
    if (near_another) continue;
    start.samples.push_back({n, s.contact});
    start.points.push_back(point);
    start.frame_points.push_back(frame_point);
  }
}

}  // namespace

double meaningful_width(const Scene& scene) {
  const dvec3 reach = glm::max(glm::abs(scene.box().lower), glm::abs(scene.box().upper));
  const double noise = flat_coordinate_width * (reach.x + reach.y + reach.z);
  if (scene.diagonal() <= noise) return std::numeric_limits<double>::infinity();
  return std::max(flat_width, std::min(noise * scene.frame().scale, flat_width_limit));
}

SampledStart sampled_start(const Scene& scene, SupportQuery& query) {
  const double width = meaningful_width(scene);
  SampledStart start;
  add(scene, query, directions_across({}), width, start);
  start.span = affine_span(start.frame_points, width);
  while (start.span.dimension < 3) {
    const int dimension = start.span.dimension;
    add(scene, query, directions_across(start.span), width, start);
    start.span = affine_span(start.frame_points, width);
    if (start.span.dimension == dimension) break;
  }
  return start;
}

SampledStart spanning(const SampledStart& start, double width) {
  SampledStart few;
  const auto take = [&](std::size_t k) {
    few.samples.push_back(start.samples[k]);
    few.points.push_back(start.points[k]);
    few.frame_points.push_back(start.frame_points[k]);
  };
  const auto rise = [&](std::size_t k) {
    double highest = -std::numeric_limits<double>::infinity();
    const dvec3& n = start.samples[k].n;
    for (const dvec3& x : few.frame_points) highest = std::max(highest, glm::dot(n, x));
    return glm::dot(n, start.frame_points[k]) - highest;
  };
  const auto spans_more = [&](std::size_t k) {
    std::vector<dvec3> points = few.frame_points;
    points.push_back(start.frame_points[k]);
    return affine_span(points, width).dimension == int(few.frame_points.size());
  };
  take(std::size_t(start.span.witnesses[0]));
  while (few.samples.size() < start.span.witnesses.size()) {
    std::pair<double, std::size_t> best = {0, start.samples.size()};
    for (std::size_t k = 0; k < start.samples.size(); ++k) {
      const double own = rise(k);
      if (own > best.first && spans_more(k)) best = {own, k};
    }
    if (best.second == start.samples.size()) break;
    take(best.second);
  }
  if (few.samples.size() < start.span.witnesses.size()) {
    few = {};
    for (const int k : start.span.witnesses) take(std::size_t(k));
  }
  few.span = affine_span(few.frame_points, width);
  return few;
}

double vertex_rounding(const Scene& scene) {
  const dvec3 largest = glm::max(glm::abs(scene.box().lower), glm::abs(scene.box().upper));
  return rounding_unit * (largest.x + largest.y + largest.z) +
         scene.frame().length_to_model(gap_rounding);
}

}  // namespace taut
