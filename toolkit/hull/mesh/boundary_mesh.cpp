#include "taut/hull/mesh/boundary_mesh.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "taut/core/stopwatch.h"
#include "taut/hull/mesh/boundary_samples.h"
#include "taut/hull/mesh/constrained_edges.h"
#include "taut/hull/mesh/contact_faces.h"
#include "taut/hull/mesh/reached_heights.h"
#include "taut/hull/sample/polytope_mesh.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Share of the tolerance within which samples on curves are one.
constexpr double width_share = 1.0 / 32;

/// Finds the hull face in which a face of the mesh lies.
class BoundaryLabels {
 public:
  BoundaryLabels(const HullBoundary& boundary, std::vector<TouchedFaces> touched)
      : boundary_(boundary), touched_(std::move(touched)), beside_(boundary.faces.size()) {
    for (int f = 0; f < int(boundary.faces.size()); ++f) {
      for (const std::size_t i : {0, 1}) {
        for (const int curve : boundary.faces[std::size_t(f)].scroll_curves[i]) {
          for (const int other : boundary.curves[std::size_t(curve)].faces) {
            if (other >= 0 && other != f) touch(beside_[std::size_t(other)], {f, 1U << i});
          }
        }
      }
    }
  }

  std::optional<FaceLabel> operator()(std::span<const int> corners,
                                      const std::function<bool()>& bridges) const {
    std::vector<Candidate> candidates;
    for (const int corner : corners) count(touched_[std::size_t(corner)], candidates);
    const auto all = int(corners.size());
    const Candidate* best = highest(candidates, all);
    if (best == nullptr) return std::nullopt;
    if (best->corners < all) {
      if (!boundary_.unresolved.empty()) return std::nullopt;
      const std::vector<Candidate> scrolls = bridging(corners);
      if (!scrolls.empty() && bridges()) {
        candidates = scrolls;
        best = highest(candidates, all);
      }
    }
    const HullFace& face = boundary_.faces[std::size_t(best->face)];
    return FaceLabel{face.kind, face.source, best->face};
  }

 private:
  static constexpr unsigned both_sides = 3;

  struct Candidate {
    int face;
    int corners;
    unsigned sides;
  };

  bool is_scroll(int face) const {
    return boundary_.faces[std::size_t(face)].kind == FaceKind::scroll;
  }

  /// One more corner of all these.
  static void count(const TouchedFaces& faces, std::vector<Candidate>& candidates) {
    for (const TouchedFace& f : faces) {
      const auto same = [&](const Candidate& c) { return c.face == f.face; };
      auto c = std::find_if(candidates.begin(), candidates.end(), same);
      if (c == candidates.end()) c = candidates.insert(c, {f.face, 0, 0});
      ++c->corners;
      c->sides |= f.sides;
    }
  }

  /// Scrolls both sides of which corners touch, or touch what is beside them.
  std::vector<Candidate> bridging(std::span<const int> corners) const {
    std::vector<Candidate> candidates;
    for (const int corner : corners) {
      TouchedFaces scrolls;
      for (const TouchedFace& f : touched_[std::size_t(corner)]) {
        if (is_scroll(f.face)) touch(scrolls, f);
        for (const TouchedFace& scroll : beside_[std::size_t(f.face)]) touch(scrolls, scroll);
      }
      count(scrolls, candidates);
    }
    std::erase_if(candidates, [](const Candidate& c) { return c.sides != both_sides; });
    return candidates;
  }

  const Candidate* highest(const std::vector<Candidate>& candidates, int all) const {
    const auto best = std::max_element(
        candidates.begin(), candidates.end(),
        [&](const Candidate& a, const Candidate& b) { return rank(a, all) < rank(b, all); });
    return best == candidates.end() ? nullptr : &*best;
  }

  /// Corners all along one side of a scroll lie in the patch beside it; if one of several corners
  /// is farther inside the patch beyond, they span the scroll. What has a corner off the plane of a
  /// facet is no part of it.
  std::tuple<int, int, int> rank(const Candidate& c, int count) const {
    const FaceKind kind = boundary_.faces[std::size_t(c.face)].kind;
    int preference = 1;
    if (kind == FaceKind::facet) preference = c.corners < count ? 0 : 3;
    if (kind == FaceKind::scroll) {
      preference = c.sides == both_sides || c.corners < count ? 2 : 0;
    }
    return {c.corners, preference, -c.face};
  }

  const HullBoundary& boundary_;
  std::vector<TouchedFaces> touched_;  // per sample
  std::vector<TouchedFaces> beside_;   // per face: the scrolls beside it
};

/// Takes out those that the boundary reaches within the resolution, elsewhere.
void drop_reached(const ReachedHeights& boundary, const ContactGeometry& geometry,
                  const HullOptions& options, std::vector<Sample>& samples) {
  const Scene& scene = geometry.scene();
  const double rho =
      scene.frame().length_to_frame(resolution_for(options, scene.model(), scene.diagonal()).rho);
  std::erase_if(samples, [&](const Sample& s) {
    const dvec3 x = geometry.point(s.contact);
    return boundary.reaches(s.n, glm::dot(x, s.n) - rho, x);
  });
}

/// Samples of the boundary; of a budget of vertices four, and no chords that are to stay.
BoundarySamples start_of(const ContactGeometry& geometry, const HullBoundary& boundary,
                         const ContactFaces& faces, const SampleSpacing& sampling,
                         SupportQuery& query, const HullOptions& options) {
  const Scene& scene = geometry.scene();
  BoundarySamples start;
  const auto add = [&](const SampledStart& apart) {
    for (std::size_t k = 0; k < apart.samples.size(); ++k) {
      start.samples.push_back(apart.samples[k]);
      start.points.push_back(apart.points[k]);
      start.faces.push_back(faces.touched(apart.samples[k].contact));
    }
  };
  if (options.vertex_budget) {
    add(spanning(sampled_start(scene, query), meaningful_width(scene)));
    return start;
  }
  start = boundary_samples(geometry, boundary, faces, sampling, query);
  std::vector<dvec3> in_frame;
  for (const dvec3& p : start.points) in_frame.push_back(scene.frame().to_frame(p));
  if (in_frame.empty() || affine_span(in_frame, meaningful_width(scene)).dimension < 3) {
    add(sampled_start(scene, query));
  }
  return start;
}

}  // namespace

Hull boundary_mesh(const Scene& scene, const ContactGeometry& geometry,
                   std::shared_ptr<const HullBoundary> boundary, const HullOptions& options,
                   std::vector<Sample>* uncovered_samples) {
  const Stopwatch time;
  options.progress.update("sample", 0);
  const double tolerance = tolerance_for(options, scene.diagonal());
  const ContactFaces faces(geometry, *boundary);
  const double width =
      std::max(width_share * tolerance, scene.frame().length_to_model(meaningful_width(scene)));
  const SampleSpacing spacing = {tolerance, width};
  SupportQuery query(scene, options.progress.stop);
  BoundarySamples start = start_of(geometry, *boundary, faces, spacing, query, options);
  ConstrainedEdges chords(geometry, *boundary, faces, start.chords, spacing);
  SampledPolytope polytope =
      sampled_polytope(scene, options, tolerance, std::move(start.samples), start.points, &chords);
  if (polytope.limit) options.progress.stop.lift_limits();
  polytope.statistics.support_queries += query.queries();
  polytope.statistics.newton_iterations += query.newton_iterations();
  for (std::size_t k = start.faces.size(); k < polytope.samples.size(); ++k) {
    options.progress.check();
    Sample& sample = polytope.samples[k];
    sample.contact = geometry.canonical(sample.contact);
    start.faces.push_back(faces.touched(sample.contact));
    const auto on_curve = chords.inserted().find(int(k));
    if (on_curve == chords.inserted().end()) {
      if (uncovered_samples != nullptr && faces.surely_uncovered(sample.contact)) {
        uncovered_samples->push_back(sample);
      }
      continue;
    }
    for (const TouchedFace& f : on_curve->second) touch(start.faces.back(), f);
  }
  if (uncovered_samples != nullptr && !uncovered_samples->empty()) {
    drop_reached(ReachedHeights(geometry, *boundary, faces), geometry, options, *uncovered_samples);
  }
  const BoundaryLabels labels(*boundary, std::move(start.faces));
  polytope.statistics.seconds_sample = 0;
  const std::optional<std::string> failure = std::exchange(polytope.failure, std::nullopt);
  const std::optional<std::string> limit = std::exchange(polytope.limit, std::nullopt);
  Hull hull = polytope_hull(scene, options, polytope, {labels, int(boundary->faces.size())});
  hull.boundary = std::move(boundary);
  hull.statistics.seconds_mesh = time.seconds();
  throw_if_failed(hull, failure, limit);
  return hull;
}

}  // namespace taut
