#include "taut/hull/sample/sampled_polytope.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "taut/core/stopwatch.h"
#include "taut/hull/polytope/certificate.h"
#include "taut/hull/sample/facet_planes.h"
#include "taut/hull/sample/farthest_support.h"
#include "taut/hull/sample/narrow_cones.h"
#include "taut/hull/sample/sampled_start.h"
#include "taut/hull/sample/vertex_facets.h"

namespace taut {
namespace {

/// Of a budget of vertices, so much of what there is is inserted at once: nearly as good as one by
/// one, the farthest first.
constexpr std::size_t batch_share = 16;

/// Refines a polytope of support points until its distance from the hull is certified.
class Sampler {
 public:
  Sampler(const Scene& scene, const HullOptions& options, double tolerance,
          EdgeConstraints* constraints)
      : scene_(scene),
        options_(options),
        constraints_(constraints),
        hull_(inflated(scene)),
        planes_(scene, options, hull_),
        narrow_(scene.content(), hull_, options.progress.stop),
        tolerance_(tolerance * scene.frame().scale) {}

  SampledPolytope run(std::vector<Sample> samples, const std::vector<dvec3>& points);

 private:
  static Box inflated(const Scene& scene) {
    const double scale = scene.frame().scale;
    const dvec3 margin(1e-3 * scale * scene.diagonal());
    return {scale * scene.box().lower - margin, scale * scene.box().upper + margin};
  }
  /// The point as the point hull has it.
  dvec3 scaled(const dvec3& point) const { return scene_.frame().scale * point; }

  void begin(std::vector<Sample> samples, const std::vector<dvec3>& points);
  void bound_vertices();
  void look_closer();
  bool insert_farthest();
  std::size_t most_points() const;
  double share_done() const;
  void bound_narrow(int vertex, int facet, const std::vector<dvec3>& normals);
  bool refine();
  bool refine_narrow(std::size_t most);
  bool repeats_vertex(const dvec3& point, int facet);
  bool insert(const Sample& sample, const dvec3& point, int facet);
  InsertMiddle inserter() {
    return [this](const EdgeConstraints::Middle& middle, int facet) {
      return insert(middle.sample, middle.point, facet);
    };
  }
  bool bisect_hidden(const dvec3& point, int facet);
  bool restore_edges();
  double gap(const dvec3& n, double h_bound, int vertex) const {
    return h_bound - glm::dot(n, frame_points_[std::size_t(vertex)]) + gap_rounding;
  }
  double gap(const FacetPlanes::Plane& plane, int vertex) const {
    return gap(plane.n, plane.h_bound, vertex);
  }
  /// What a gap at a vertex means for the distance.
  double distance_bound(double gap, int vertex) const {
    return taut::distance_bound(gap, vertex_depths_[std::size_t(vertex)]);
  }
  std::optional<std::string> refine_to_tolerance();
  SampledPolytope result();
  SampledPolytope unfinished_result();

  const Scene& scene_;
  const HullOptions& options_;
  EdgeConstraints* constraints_;
  PointHull hull_;
  FacetPlanes planes_;
  NarrowCones narrow_;
  /// Of the vertices whose cones are narrow.
  std::vector<std::pair<int, NarrowCones::Certificate>> narrow_vertices_;
  std::vector<Sample> samples_;        // per vertex
  std::vector<dvec3> frame_points_;    // per vertex
  std::vector<double> vertex_gaps_;    // per vertex: the largest gap of its facets
  std::vector<double> vertex_depths_;  // per vertex: of the cones of its directions
  double tolerance_;                   // in the scene's frame
  double bound_ = 0;
  FarthestSupport farthest_;         ///< of a budget
  std::optional<double> certified_;  ///< the least of the bounds until now: the polytope only grows
  HullStatistics statistics_;
};

void Sampler::begin(std::vector<Sample> samples, const std::vector<dvec3>& points) {
  samples_ = std::move(samples);
  std::vector<dvec3> all;
  all.reserve(points.size());
  for (const dvec3& p : points) {
    frame_points_.push_back(scene_.frame().to_frame(p));
    all.push_back(scaled(p));
  }
  hull_.add(all, options_.progress);
  restore_edges();
}

/// Certifies, vertex by vertex, how far the true hull may lie outside (certificate.h).
void Sampler::bound_vertices() {
  const std::size_t count = hull_.points().size();
  std::vector<int> first(count + 1, 0);
  for (std::size_t f = 0; f < hull_.facets().size(); ++f) {
    options_.progress.check_rarely(f);
    const PointHull::Facet& facet = hull_.facets()[f];
    if (!facet.alive) continue;
    for (const int v : facet.vertex) ++first[std::size_t(v) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<dvec3> normals(std::size_t(first.back()));
  std::vector<dvec3> facet_normals(planes_.size());
  std::vector<int> facet_at(count, -1);
  std::vector<int> next(first.begin(), first.end() - 1);
  vertex_gaps_.assign(count, 0);
  vertex_depths_.assign(count, 1);
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    options_.progress.check_rarely(f);
    if (!hull_.facets()[f].alive) continue;
    facet_normals[f] = planes_[f].n;
    for (const int v : hull_.facets()[f].vertex) {
      facet_at[std::size_t(v)] = int(f);
      normals[std::size_t(next[std::size_t(v)]++)] = planes_[f].n;
      double& largest = vertex_gaps_[std::size_t(v)];
      largest = std::max(largest, gap(planes_[f], v));
    }
  }
  bound_ = 0;
  narrow_vertices_.clear();
  for (std::size_t v = 0; v < count; ++v) {
    options_.progress.check_rarely(v);
    const std::span<const dvec3> own(normals.data() + first[v], normals.data() + first[v + 1]);
    if (own.empty()) continue;  // no vertex of the boundary any more
    vertex_depths_[v] = cone_depth(own);
    const bool is_narrow = vertex_depths_[v] < narrow_depth;
    if (is_narrow && distance_bound(vertex_gaps_[v], int(v)) > tolerance_) {
      bound_narrow(int(v), facet_at[v], facet_normals);
    }
    bound_ = std::max(bound_, distance_bound(vertex_gaps_[v], int(v)));
  }
  // Where nothing is certified, everything lies within the diagonal all the same.
  bound_ = std::min(bound_, scene_.frame().scale * scene_.diagonal());
  certified_ = std::min(bound_, certified_.value_or(bound_));
}

/// The distance as well as queries tell it, and where it is largest.
void Sampler::look_closer() {
  SupportQuery query(scene_, options_.progress.stop);
  const auto plane_of = [&](int facet) {
    const FacetPlanes::Plane& plane = planes_[std::size_t(facet)];
    return SeenPlane{plane.n, plane.h_bound, scene_.frame().to_frame(plane.point), plane.contact};
  };
  farthest_ = farthest_support(query, hull_, frame_points_, plane_of, options_.progress);
  bound_ = std::min(bound_, farthest_.bound);
  certified_ = std::min(bound_, *certified_);
  statistics_.support_queries += query.queries();
  statistics_.newton_iterations += query.newton_iterations();
}

/// False if it is not above the polytope.
bool Sampler::insert_farthest() {
  if (farthest_.vertex < 0) return false;
  const dvec3 point = scene_.frame().to_model(farthest_.plane.point);
  for (const int f : VertexFacets(hull_).about(farthest_.vertex)) {
    if (insert({farthest_.plane.n, farthest_.plane.contact, true}, point, f)) return true;
  }
  return false;
}

/// Up to which a round inserts.
std::size_t Sampler::most_points() const {
  if (!options_.vertex_budget) return std::size_t(options_.max_vertices);
  const std::size_t count = hull_.points().size();
  return std::min(count + std::max<std::size_t>(count / batch_share, 1),
                  std::size_t(*options_.vertex_budget));
}

/// Vertices grow as the inverse of the distance: the orders of magnitude done tell the rounds.
double Sampler::share_done() const {
  if (options_.vertex_budget) {
    return double(hull_.points().size()) / double(*options_.vertex_budget);
  }
  return std::clamp(std::log(bound_) / std::log(tolerance_), 0., 1.);
}

/// By more directions than those of its facets.
void Sampler::bound_narrow(int vertex, int facet, const std::vector<dvec3>& normals) {
  const auto v = std::size_t(vertex);
  NarrowCones::Certificate known = narrow_.certify(vertex, facet, normals, samples_[v].contact);
  if (!(known.depth > vertex_depths_[v])) return;
  vertex_depths_[v] = known.depth;
  for (const NarrowCones::Asked& asked : known.asked) {
    vertex_gaps_[v] = std::max(vertex_gaps_[v], gap(asked.n, asked.support.h_bound, vertex));
  }
  narrow_vertices_.emplace_back(vertex, std::move(known));
}

/// Whether the point is a vertex once more, but for rounding: it would make slivers, whose normals
/// mean nothing.
bool Sampler::repeats_vertex(const dvec3& point, int facet) {
  const double rounding = scene_.frame().length_to_frame(8 * vertex_rounding(scene_));
  const dvec3 x = scaled(point);
  const std::vector<int>& visible = hull_.visible(x, facet);
  return std::any_of(visible.begin(), visible.end(), [&](int f) {
    const std::array<int, 3>& own = hull_.facet(f).vertex;
    return std::any_of(own.begin(), own.end(), [&](int v) {
      return glm::distance(hull_.points()[std::size_t(v)], x) <= rounding;
    });
  });
}

bool Sampler::insert(const Sample& sample, const dvec3& point, int facet) {
  if (repeats_vertex(point, facet)) return false;
  if (!hull_.insert(scaled(point), facet)) return false;
  samples_.push_back(sample);
  frame_points_.push_back(scene_.frame().to_frame(point));
  planes_.fit();
  for (const int f : hull_.replaced()) planes_[std::size_t(f)].known = false;
  for (const int f : hull_.created()) planes_[std::size_t(f)].known = false;
  return true;
}

/// Bisects an edge that is to stay and that the point would hide. False if there is none.
bool Sampler::bisect_hidden(const dvec3& point, int facet) {
  if (constraints_ == nullptr) return false;
  return bisect_between(hull_, hull_.visible(scaled(point), facet), *constraints_, inserter());
}

/// Bisects edges that are wanted and hidden. False if there are none.
bool Sampler::restore_edges() {
  if (constraints_ == nullptr) return false;
  return restore_wanted(hull_, *constraints_, scene_.frame().scale, most_points(), inserter(),
                        options_.progress);
}

/// Inserts the support points of directions in narrow cones that keep a vertex from its tolerance,
/// up to so many points. False if none could be inserted.
bool Sampler::refine_narrow(std::size_t most) {
  bool inserted = false;
  for (const auto& [v, known] : narrow_vertices_) {
    for (const NarrowCones::Asked& asked : known.asked) {
      options_.progress.check();
      if (hull_.points().size() >= most) return inserted;
      if (!(distance_bound(gap(asked.n, asked.support.h_bound, v), v) > tolerance_)) continue;
      const dvec3 point = scene_.frame().to_model(asked.support.point);
      // Earlier ones may have replaced facets.
      const auto facet = std::find_if(known.facets.begin(), known.facets.end(), [&](int f) {
        return hull_.facet(f).alive && !hull_.visible(scaled(point), f).empty();
      });
      if (facet == known.facets.end()) continue;
      const bool bisected = bisect_hidden(point, *facet);
      if (bisected || insert({asked.n, asked.support.contact, true}, point, *facet))
        inserted = true;
    }
  }
  return inserted;
}

/// Inserts the support points of all facets that keep a vertex from its tolerance, the largest
/// gap first. False if none could be inserted.
bool Sampler::refine() {
  struct Candidate {
    double gap;
    int facet;
    dvec3 n;
  };
  std::vector<Candidate> candidates;
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    options_.progress.check_rarely(f);
    const PointHull::Facet& facet = hull_.facets()[f];
    if (!facet.alive) continue;
    double largest = 0;
    bool wanted = false;
    for (const int v : facet.vertex) {
      const double g = gap(planes_[f], v);
      largest = std::max(largest, g);
      wanted = wanted || distance_bound(g, v) > tolerance_;
    }
    if (wanted) candidates.push_back({largest, int(f), planes_[f].n});
  }
  std::size_t compared = 0;
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    options_.progress.check_rarely(++compared);
    return a.gap != b.gap ? a.gap > b.gap : a.facet < b.facet;
  });
  const std::size_t most = most_points();
  bool inserted = options_.vertex_budget && insert_farthest();
  inserted = refine_narrow(most) || inserted;
  for (const Candidate& c : candidates) {
    options_.progress.check();
    if (hull_.points().size() >= most) break;
    // A facet that an earlier insertion replaced has lost its plane.
    const FacetPlanes::Plane plane = planes_[std::size_t(c.facet)];
    if (!plane.known || plane.n != c.n) continue;
    // No point is beyond a sliver.
    const int facet = planes_.has_lost_facet(plane) ? c.facet : plane.facet;
    const bool bisected = bisect_hidden(plane.point, facet);
    if (bisected || insert({plane.n, plane.contact, true}, plane.point, facet)) inserted = true;
  }
  return inserted;
}

SampledPolytope Sampler::result() {
  std::vector<double> gaps(planes_.size(), 0);
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (!hull_.facets()[f].alive) continue;
    for (const int v : hull_.facets()[f].vertex) gaps[f] = std::max(gaps[f], gap(planes_[f], v));
  }
  std::vector<double> bounds;
  bounds.reserve(vertex_gaps_.size());
  for (std::size_t v = 0; v < vertex_gaps_.size(); ++v) {
    const double bound = scene_.frame().length_to_model(distance_bound(vertex_gaps_[v], int(v)));
    bounds.push_back(std::min(bound, scene_.diagonal()));
  }
  const double bound =
      std::max(scene_.frame().length_to_model(*certified_), vertex_rounding(scene_));
  statistics_.support_queries += narrow_.query().queries();
  statistics_.newton_iterations += narrow_.query().newton_iterations();
  return {std::move(hull_), std::move(samples_), std::move(gaps), std::move(bounds), bound,
          std::nullopt,     std::nullopt,        statistics_};
}

/// The polytope as it stands somewhere in a round: planes and bounds are not those of all of it,
/// but the bound of each round before holds.
SampledPolytope Sampler::unfinished_result() {
  planes_.fit();
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (!planes_[f].known) planes_[f].h_bound = infinity;
  }
  bound_ = *certified_;
  vertex_gaps_.assign(hull_.points().size(), bound_);
  vertex_depths_.assign(hull_.points().size(), 1);
  return result();
}

/// Why the tolerance is not reached, none if it is, or there is none but a budget.
std::optional<std::string> Sampler::refine_to_tolerance() {
  const auto failure = [&](std::string reason) {
    return tolerance_ > 0 ? std::optional(std::move(reason)) : std::nullopt;
  };
  const auto most = std::size_t(options_.vertex_budget.value_or(options_.max_vertices));
  for (;;) {
    planes_.find(samples_, statistics_);
    bound_vertices();
    if (options_.vertex_budget) look_closer();
    options_.progress.update("sample", share_done());
    if (bound_ <= tolerance_ && !restore_edges()) return std::nullopt;
    if (bound_ <= tolerance_) continue;
    if (hull_.points().size() >= most) return failure(vertex_limit_met(most));
    if (!refine() && !planes_.take_slivers_seriously()) return failure(tolerance_too_fine);
  }
}

SampledPolytope Sampler::run(std::vector<Sample> samples, const std::vector<dvec3>& points) {
  const Stopwatch start_time;
  options_.progress.update("sample", 0);
  begin(std::move(samples), points);
  SampledPolytope polytope = [&] {
    try {
      std::optional<std::string> failure = refine_to_tolerance();
      SampledPolytope whole = result();
      whole.failure = std::move(failure);
      return whole;
    } catch (const LimitMet& met) {
      if (!certified_) throw;
      SampledPolytope unfinished = unfinished_result();
      unfinished.limit = met.what();
      return unfinished;
    }
  }();
  polytope.statistics.seconds_sample = start_time.seconds();
  return polytope;
}

}  // namespace

SampledPolytope sampled_polytope(const Scene& scene, const HullOptions& options, double tolerance,
                                 std::vector<Sample> samples, const std::vector<dvec3>& points,
                                 EdgeConstraints* constraints) {
  return Sampler(scene, options, tolerance, constraints).run(std::move(samples), points);
}

}  // namespace taut
