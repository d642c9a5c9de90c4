#include "taut/hull/sample/sampled_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "taut/core/tolerances.h"
#include "taut/hull/polytope/outline.h"

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
    start.samples.push_back({n, s.contact, true});
    start.points.push_back(point);
    start.frame_points.push_back(frame_point);
  }
}

/// The unit normal of the points' outline, as a vector area, seen along another.
dvec3 outline_normal(const std::vector<dvec3>& points, const AffineSpan& span) {
  const auto witness = [&](std::size_t k) { return points[std::size_t(span.witnesses[k])]; };
  const std::vector<int> outline =
      convex_outline(points, PlaneView(witness(0), witness(1), witness(2)));
  dvec3 area(0.0);
  const auto at = [&](std::size_t k) {
    return points[std::size_t(outline[k % outline.size()])] - points[std::size_t(outline[0])];
  };
  for (std::size_t k = 1; k < outline.size(); ++k) area += glm::cross(at(k), at(k + 1));
  return unit(area);
}

/// The span of less than space, across which the scene reaches no farther than the width; none if
/// there is no such.
std::optional<AffineSpan> thin_span(SupportQuery& query, double width, const SampledStart& start) {
  AffineSpan span = affine_span(start.frame_points, 2 * width);
  if (span.dimension != 1 && span.dimension != 2) return std::nullopt;
  if (span.dimension == 2) span.normal = outline_normal(start.frame_points, span);
  const std::vector<dvec3> across = directions_across(span);
  // Neighbours among eight directions are an eighth of a turn apart.
  const double share = span.dimension == 1 ? std::cos(std::numbers::pi / 8) : 1;
  for (std::size_t k = 0; k + 1 < across.size(); k += 2) {
    if (query(across[k]).h_bound + query(across[k + 1]).h_bound > share * width) {
      return std::nullopt;
    }
  }
  return span;
}

/// How far the scene reaches across its plane.
void measure_width(SupportQuery& query, SampledStart& start) {
  const double upper = query(start.span.normal).h_bound;
  const double lower = -query(-start.span.normal).h_bound;
  start.middle = 0.5 * (upper + lower);
  start.half_width = 0.5 * (upper - lower);
}

/// Moves the samples into the middle of what a plane's scene reaches. Those that are no farther
/// from others than it reaches would make sides that mean nothing.
void flatten(const Scene& scene, SampledStart& start) {
  SampledStart flat;
  for (std::size_t k = 0; k < start.points.size(); ++k) {
    const dvec3 point = flat_point(scene, start, start.frame_points[k]);
    const dvec3 frame_point = scene.frame().to_frame(point);
    const bool near_another = std::any_of(
        flat.frame_points.begin(), flat.frame_points.end(),
        [&](const dvec3& other) { return glm::distance(other, frame_point) <= start.half_width; });
    if (near_another) continue;
    flat.samples.push_back(start.samples[k]);
    flat.points.push_back(point);
    flat.frame_points.push_back(frame_point);
  }
  const dvec3 n = start.span.normal;
  flat.span = affine_span(flat.frame_points, start.half_width);
  const bool turned = glm::dot(flat.span.normal, n) < 0;
  flat.span.normal = turned ? -n : n;
  flat.middle = turned ? -start.middle : start.middle;
  flat.half_width = start.half_width;
  start = std::move(flat);
}

}  // namespace

dvec3 flat_point(const Scene& scene, const SampledStart& start, const dvec3& x) {
  if (start.half_width == 0) return scene.frame().to_model(x);
  const dvec3& n = start.span.normal;
  return scene.frame().to_model(x + (start.middle - glm::dot(x, n)) * n);
}

double meaningful_width(const Scene& scene) {
  const dvec3 reach = glm::max(glm::abs(scene.box().lower), glm::abs(scene.box().upper));
  const double noise = flat_coordinate_width * (reach.x + reach.y + reach.z);
  if (scene.diagonal() <= noise) return std::numeric_limits<double>::infinity();
  return std::max(flat_width, std::min(noise * scene.frame().scale, flat_width_limit));
}

SampledStart sampled_start(const Scene& scene, SupportQuery& query, double thin) {
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
  std::optional<AffineSpan> thinner;
  if (start.span.dimension >= 2 && thin > width) thinner = thin_span(query, thin, start);
  const bool is_thinner = thinner && thinner->dimension < start.span.dimension;
  if (is_thinner) start.span = *thinner;
  if (start.span.dimension != 2) return start;
  measure_width(query, start);
  if (is_thinner) {
    flatten(scene, start);
  } else {
    start.half_width = 0;
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

std::string vertex_limit_met(std::size_t vertices) {
  return "the tolerance was not reached with " + std::to_string(vertices) + " vertices";
}

}  // namespace taut
