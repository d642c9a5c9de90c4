#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "taut/core/error.h"
#include "taut/hull/polytope/certificate.h"
#include "taut/hull/polytope/outline.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Refines the outline of a scene in a plane as sampled_hull() refines a polytope, or measures one
/// on a line or in a point.
class FlatSampler {
 public:
  FlatSampler(const Scene& scene, const HullOptions& options, double tolerance, SampledStart start,
              SupportQuery& query)
      : scene_(scene),
        options_(options),
        tolerance_(tolerance * scene.frame().scale),
        start_(std::move(start)),
        query_(query) {
    constexpr int planar = 2;
    if (options.vertex_budget && start_.span.dimension == planar) keep_triangle();
  }

  Hull run();

 private:
  Hull checked(Hull hull) const;
  struct Side {
    dvec3 n;
    Support support;
  };

  double gap(const Support& s, const dvec3& n, int sample) const {
    return s.h_bound - glm::dot(n, start_.frame_points[std::size_t(sample)]) + gap_rounding;
  }
  int add(const dvec3& n, const Support& s);
  const Side& side(int from, int to);
  std::vector<int> line_ends();
  std::vector<int> outline(const PlaneView& view) const {
    return convex_outline(start_.points, view);
  }
  void keep_triangle();
  /// Bound of the distance in the directions in which a corner is highest.
  double arc_bound(int corner, const Side& in, const Side& out);
  void certify(const std::vector<int>& corners);
  std::size_t most_samples() const;
  std::vector<Side> wanted_sides(const std::vector<int>& corners);
  double across_bound(int sample);
  Hull make_hull(HullKind kind, const std::vector<int>& corners);
  Hull refine();

  const Scene& scene_;
  const HullOptions& options_;
  double tolerance_;  ///< in the scene's frame
  SampledStart start_;
  SupportQuery& query_;
  std::map<std::pair<int, int>, Side> sides_;  ///< by their ends' samples
  std::vector<double> bounds_;                 ///< per corner of the outline
  double bound_ = 0;
  std::vector<int> certified_;  ///< corners of the outline that the bounds are of
};

int FlatSampler::add(const dvec3& n, const Support& s) {
  start_.samples.push_back({n, s.contact});
  start_.points.push_back(flat_point(scene_, start_, s.point));
  start_.frame_points.push_back(scene_.frame().to_frame(start_.points.back()));
  return int(start_.points.size()) - 1;
}

/// The supporting line along a side of the outline, in the span's plane.
const FlatSampler::Side& FlatSampler::side(int from, int to) {
  const auto [found, is_new] = sides_.try_emplace({from, to});
  if (is_new) {
    const dvec3 along =
        start_.frame_points[std::size_t(to)] - start_.frame_points[std::size_t(from)];
    found->second.n = unit(glm::cross(along, start_.span.normal));
    found->second.support = query_(found->second.n, start_.samples[std::size_t(from)].contact);
  }
  return found->second;
}

/// How far apart the scene and the mesh may be across the span's line or plane, or from its point,
/// in the frame.
double FlatSampler::across_bound(int sample) {
  double bound = 0;
  for (const dvec3& n : directions_across(start_.span)) {
    bound = std::max(bound, gap(query_(n), n, sample));
  }
  // Every direction across lies in a cone of neighbouring ones of at least this depth.
  constexpr std::array depth = {0.8, 0.9, 1.0};
  // The mesh's other corners may lie on the far side of the sample.
  const int sides = start_.span.dimension == 0 ? 1 : 2;
  return sides * bound / depth[std::size_t(start_.span.dimension)];
}

/// Three samples that span the plane.
void FlatSampler::keep_triangle() {
  constexpr std::size_t corners = 3;
  const SampledStart all = std::exchange(start_, {});
  start_.span = all.span;
  start_.middle = all.middle;
  start_.half_width = all.half_width;
  for (std::size_t k = 0; k < corners; ++k) {
    const auto own = std::size_t(all.span.witnesses[k]);
    start_.samples.push_back(all.samples[own]);
    start_.points.push_back(all.points[own]);
    start_.frame_points.push_back(all.frame_points[own]);
    start_.span.witnesses[k] = int(k);
  }
}

/// Of a budget the arc is seen in steps so short that the bound is nearly what is seen.
double FlatSampler::arc_bound(int corner, const Side& in, const Side& out) {
  constexpr double step = 0.1;  // radians: a bound by its ends is high by an eighth of a percent
  const double angle = std::acos(std::clamp(glm::dot(in.n, out.n), -1.0, 1.0));
  const int steps = options_.vertex_budget ? std::max(1, int(std::ceil(angle / step))) : 1;
  double bound = 0;
  Side first = in;
  for (int k = 1; k <= steps; ++k) {
    Side last = out;
    if (k < steps) {
      const double t = double(k) / steps;
      last.n = unit((1 - t) * in.n + t * out.n);
      last.support = query_(last.n, first.support.contact);
    }
    const double highest =
        std::max(gap(first.support, first.n, corner), gap(last.support, last.n, corner));
    bound = std::max(bound, distance_bound(highest, cone_depth(std::array{first.n, last.n})));
    first = last;
  }
  return bound;
}

/// The certificate of certificate.h, in the plane.
void FlatSampler::certify(const std::vector<int>& corners) {
  const std::size_t count = corners.size();
  double largest = 0;
  std::vector<double> bounds(count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const Side in = side(corners[(k + count - 1) % count], corners[k]);
    const Side out = side(corners[k], corners[(k + 1) % count]);
    bounds[k] = arc_bound(corners[k], in, out);
    largest = std::max(largest, bounds[k]);
  }
  bounds_ = std::move(bounds);
  // The outline only grows.
  bound_ = certified_.empty() ? largest : std::min(bound_, largest);
  certified_ = corners;
}

std::vector<int> FlatSampler::line_ends() {
  std::vector<int> ends;
  for (const dvec3& n : {-start_.span.line, start_.span.line}) {
    const Support s = query_(n);
    ends.push_back(add(n, s));
    bounds_.push_back(gap(s, n, ends.back()));
    bound_ = std::max(bound_, bounds_.back());
  }
  return ends;
}

Hull FlatSampler::make_hull(HullKind kind, const std::vector<int>& corners) {
  const double across = across_bound(corners.front());
  Hull hull;
  hull.kind = kind;
  std::vector<dvec3> points;
  points.reserve(corners.size());
  std::vector<int> loop(corners.size());
  std::iota(loop.begin(), loop.end(), 0);
  for (const int c : corners) points.push_back(start_.points[std::size_t(c)]);
  std::vector<std::vector<int>> polygons;
  if (kind == HullKind::planar) polygons = {loop, {loop.rbegin(), loop.rend()}};
  hull.mesh = make_hull_mesh(points, polygons);
  const auto bound_in_model = [&](double bound) {
    const double in_model = scene_.frame().length_to_model(bound + across);
    return std::max(std::min(in_model, scene_.diagonal()), vertex_rounding(scene_));
  };
  for (const auto v : hull.mesh.vertices()) {
    const auto k = std::size_t(v.idx());
    const Sample& sample = start_.samples[std::size_t(corners[k])];
    const SourceContact contact = scene_.source(sample.contact);
    auto& data = hull.mesh.data(v);
    data.source = contact.source;
    data.u = contact.u;
    data.v = contact.v;
    data.quality = float_above(bound_in_model(bounds_.empty() ? 0 : bounds_[k]));
    const dvec3& n = kind == HullKind::planar ? start_.span.normal : sample.n;
    hull.mesh.set_normal(v, {n.x, n.y, n.z});
  }
  for (const auto f : hull.mesh.faces()) hull.mesh.data(f).hull_face = 0;
  for (const auto e : hull.mesh.edges()) hull.mesh.data(e).feature = true;
  hull.distance_bound = bound_in_model(bound_);
  hull.resolution = resolution_for(options_, scene_.model(), scene_.diagonal());
  return hull;
}

/// What is thin within the resolution may be farther off than the tolerance.
Hull FlatSampler::checked(Hull hull) const {
  const bool is_off = scene_.frame().length_to_frame(hull.distance_bound) > tolerance_;
  const bool is_thin = hull.distance_bound > vertex_rounding(scene_);
  if (tolerance_ > 0 && is_off && is_thin) {
    throw HullNotConverged(flat_within_more, std::move(hull));
  }
  return hull;
}

Hull FlatSampler::run() {
  if (start_.span.dimension == 0) return checked(make_hull(HullKind::point, {0}));
  if (start_.span.dimension == 1) return checked(make_hull(HullKind::segment, line_ends()));
  try {
    return refine();
  } catch (const LimitMet& met) {
    if (certified_.empty()) throw;
    options_.progress.stop.lift_limits();
    throw HullLimitExceeded(met.what(), make_hull(HullKind::planar, certified_));
  }
}

/// How many samples a round may leave; of a budget so few more that the farthest come first.
std::size_t FlatSampler::most_samples() const {
  if (!options_.vertex_budget) return std::size_t(options_.max_vertices);
  constexpr std::size_t batch_share = 16;
  const std::size_t count = start_.points.size();
  return std::min(count + std::max<std::size_t>(count / batch_share, 1),
                  std::size_t(*options_.vertex_budget));
}

/// The sides beyond which a sample keeps corners from the tolerance; of a budget the farthest
/// first.
std::vector<FlatSampler::Side> FlatSampler::wanted_sides(const std::vector<int>& corners) {
  std::vector<std::pair<double, Side>> wanted;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t next = (k + 1) % corners.size();
    if (bounds_[k] <= tolerance_ && bounds_[next] <= tolerance_) continue;
    const Side s = side(corners[k], corners[next]);
    const dvec3 up = s.support.point - start_.frame_points[std::size_t(corners[k])];
    const double height = glm::dot(s.n, up);
    if (height > gap_rounding) wanted.emplace_back(height, s);
  }
  if (options_.vertex_budget) {
    std::stable_sort(wanted.begin(), wanted.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
  }
  std::vector<Side> sides;
  sides.reserve(wanted.size());
  for (const auto& [height, s] : wanted) sides.push_back(s);
  return sides;
}

Hull FlatSampler::refine() {
  // What the mesh is off by across its plane is part of the tolerance.
  const double across = start_.half_width > 0 ? across_bound(0) : 0;
  const bool is_within = across < tolerance_ || across == 0;
  tolerance_ = is_within ? tolerance_ - across : 0.5 * tolerance_;
  const auto& w = start_.span.witnesses;
  const auto witness = [&](std::size_t k) { return start_.points[std::size_t(w[k])]; };
  const PlaneView view(witness(0), witness(1), witness(2));
  for (;;) {
    const std::vector<int> corners = outline(view);
    certify(corners);
    options_.progress.update("sample", std::clamp(std::log(bound_) / std::log(tolerance_), 0., 1.));
    if (bound_ <= tolerance_ && is_within) return make_hull(HullKind::planar, corners);
    if (bound_ <= tolerance_) {
      throw HullNotConverged(flat_within_more, make_hull(HullKind::planar, corners));
    }

    const std::size_t before = start_.points.size();
    const std::size_t most = most_samples();
    const bool full = before >= most;
    for (const Side& s : wanted_sides(corners)) {
      if (start_.points.size() < most) add(s.n, s.support);
    }
    // Samples that do not change the outline bring nothing more.
    if (full || start_.points.size() == before || outline(view) == corners) {
      if (tolerance_ == 0) return make_hull(HullKind::planar, corners);
      throw HullNotConverged(full ? vertex_limit_met(most) : tolerance_too_fine,
                             make_hull(HullKind::planar, corners));
    }
  }
}

}  // namespace

Hull flat_sampled_hull(const Scene& scene, const HullOptions& options, double tolerance,
                       SampledStart start, SupportQuery& query) {
  return FlatSampler(scene, options, tolerance, std::move(start), query).run();
}

}  // namespace taut
