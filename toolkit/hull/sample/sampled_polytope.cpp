#include "taut/hull/sample/sampled_polytope.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "taut/core/parallel.h"
#include "taut/core/stopwatch.h"
#include "taut/hull/polytope/certificate.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Neighbours of slivers that are asked for a direction, one after the other.
constexpr std::size_t sliver_limit = 8;

/// Refines a polytope of support points until its distance from the hull is certified.
class Sampler {
 public:
  Sampler(const Scene& scene, const HullOptions& options, double tolerance,
          EdgeConstraints* constraints)
      : scene_(scene),
        options_(options),
        constraints_(constraints),
        hull_(inflated(scene)),
        tolerance_(tolerance * scene.frame().scale) {}

  SampledPolytope run(std::vector<Sample> samples, const std::vector<dvec3>& points);

 private:
  /// What is known of a facet: its supporting plane.
  struct Plane {
    bool known = false;
    dvec3 n;
    int facet = -1;  ///< of which n is the normal
    double h_bound = 0;
    dvec3 point;  ///< the support point, in model coordinates
    Contact contact;
  };

  static Box inflated(const Scene& scene) {
    const double scale = scene.frame().scale;
    const dvec3 margin(1e-3 * scale * scene.diagonal());
    return {scale * scene.box().lower - margin, scale * scene.box().upper + margin};
  }
  /// The point as the point hull has it.
  dvec3 scaled(const dvec3& point) const { return scene_.frame().scale * point; }

  void begin(std::vector<Sample> samples, const std::vector<dvec3>& points);
  /// A facet and its normal.
  struct Facing {
    int facet;
    dvec3 n;
  };
  Facing facing(int facet) const;
  bool has_lost_facet(const Plane& plane) const;
  bool take_slivers_seriously();
  void find_planes();
  void bound_vertices();
  bool refine();
  bool repeats_vertex(const dvec3& point, int facet);
  bool insert(const Sample& sample, const dvec3& point, int facet);
  bool bisect_hidden(const dvec3& point, int facet);
  double gap(const Plane& plane, int vertex) const {
    return plane.h_bound - glm::dot(plane.n, frame_points_[std::size_t(vertex)]) + gap_rounding;
  }
  /// What a gap at a vertex means for the distance.
  double distance_bound(double gap, int vertex) const {
    return taut::distance_bound(gap, vertex_depths_[std::size_t(vertex)]);
  }
  const char* refine_to_tolerance();
  SampledPolytope result();
  SampledPolytope unfinished_result();

  const Scene& scene_;
  const HullOptions& options_;
  EdgeConstraints* constraints_;
  PointHull hull_;
  std::vector<Sample> samples_;        // per vertex
  std::vector<dvec3> frame_points_;    // per vertex
  std::vector<double> vertex_gaps_;    // per vertex: the largest gap of its facets
  std::vector<double> vertex_depths_;  // per vertex: cone_depth() of its facets' normals
  bool slivers_count_ = false;         // slivers' own directions do, since nothing else helped
  std::vector<Plane> planes_;          // per facet
  double tolerance_;                   // in the scene's frame
  double bound_ = 0;
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
}

/// The facet itself; of a sliver, with corners in line but for rounding, the nearest
/// other facet, first across its longest side. A certificate needs no more than directions about
/// each vertex, and a sliver's own means nothing.
Sampler::Facing Sampler::facing(int facet) const {
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

/// Lets slivers have their own directions from now on. False if that changes nothing.
bool Sampler::take_slivers_seriously() {
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

/// The facet of which the plane has its direction is no more.
bool Sampler::has_lost_facet(const Plane& plane) const {
  const PointHull::Facet& facet = hull_.facet(plane.facet);
  return !facet.alive || unit(facet.side.normal()) != plane.n;
}

/// Queries the supporting plane of every facet that has none yet, in parallel; each query starts
/// from the contact of the vertex whose own direction is closest.
void Sampler::find_planes() {
  planes_.resize(hull_.facets().size());
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
        const Sample& s = samples_[std::size_t(v)];
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
    statistics_.support_queries += queries;
    statistics_.newton_iterations += newton;
  }
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
  std::vector<int> next(first.begin(), first.end() - 1);
  vertex_gaps_.assign(count, 0);
  vertex_depths_.assign(count, 1);
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    options_.progress.check_rarely(f);
    if (!hull_.facets()[f].alive) continue;
    for (const int v : hull_.facets()[f].vertex) {
      normals[std::size_t(next[std::size_t(v)]++)] = planes_[f].n;
      double& largest = vertex_gaps_[std::size_t(v)];
      largest = std::max(largest, gap(planes_[f], v));
    }
  }
  bound_ = 0;
  for (std::size_t v = 0; v < count; ++v) {
    options_.progress.check_rarely(v);
    const std::span<const dvec3> own(normals.data() + first[v], normals.data() + first[v + 1]);
    if (own.empty()) continue;  // no vertex of the boundary any more
    vertex_depths_[v] = cone_depth(own);
    bound_ = std::max(bound_, distance_bound(vertex_gaps_[v], int(v)));
  }
  // Where nothing is certified, everything lies within the diagonal all the same.
  bound_ = std::min(bound_, scene_.frame().scale * scene_.diagonal());
  certified_ = std::min(bound_, certified_.value_or(bound_));
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
  planes_.resize(hull_.facets().size());
  for (const int f : hull_.replaced()) planes_[std::size_t(f)].known = false;
  for (const int f : hull_.created()) planes_[std::size_t(f)].known = false;
  return true;
}

/// Bisects an edge that is to stay and that the point would hide. False if there is none.
bool Sampler::bisect_hidden(const dvec3& point, int facet) {
  const std::vector<int>& visible = hull_.visible(scaled(point), facet);
  for (const int f : visible) {
    const PointHull::Facet& own = hull_.facet(f);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = own.vertex[k];
      const int b = own.vertex[(k + 1) % 3];
      const int other = own.neighbor[k];
      if (a > b || std::find(visible.begin(), visible.end(), other) == visible.end()) continue;
      const std::optional<EdgeConstraints::Middle> middle = constraints_->middle(a, b);
      if (!middle) continue;
      const auto number = int(hull_.points().size());
      if (!insert(middle->sample, middle->point, f) &&
          !insert(middle->sample, middle->point, other)) {
        return false;
      }
      constraints_->bisect(a, b, number);
      return true;
    }
  }
  return false;
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
  bool inserted = false;
  for (const Candidate& c : candidates) {
    options_.progress.check();
    if (int(hull_.points().size()) >= options_.max_vertices) break;
    // A facet that an earlier insertion replaced has lost its plane.
    const Plane plane = planes_[std::size_t(c.facet)];
    if (!plane.known || plane.n != c.n) continue;
    // No point is beyond a sliver.
    const int facet = has_lost_facet(plane) ? c.facet : plane.facet;
    const bool bisected = constraints_ != nullptr && bisect_hidden(plane.point, facet);
    if (bisected || insert({plane.n, plane.contact}, plane.point, facet)) inserted = true;
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
  const double bound = std::max(scene_.frame().length_to_model(bound_), vertex_rounding(scene_));
  return {std::move(hull_), std::move(samples_), std::move(gaps), std::move(bounds), bound,
          nullptr,          std::nullopt,        statistics_};
}

/// The polytope as it stands somewhere in a round: planes and bounds are not those of all of it,
/// but the bound of each round before holds.
SampledPolytope Sampler::unfinished_result() {
  planes_.resize(hull_.facets().size());
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (!planes_[f].known) planes_[f].h_bound = infinity;
  }
  bound_ = *certified_;
  vertex_gaps_.assign(hull_.points().size(), bound_);
  vertex_depths_.assign(hull_.points().size(), 1);
  return result();
}

/// Why the tolerance is not reached, none if it is.
const char* Sampler::refine_to_tolerance() {
  for (;;) {
    find_planes();
    bound_vertices();
    // Vertices grow as the inverse of the distance: the orders of magnitude done tell the rounds.
    options_.progress.update("sample", std::clamp(std::log(bound_) / std::log(tolerance_), 0., 1.));
    if (bound_ <= tolerance_) return nullptr;
    if (int(hull_.points().size()) >= options_.max_vertices) return vertex_limit_met;
    if (!refine() && !take_slivers_seriously()) return tolerance_too_fine;
  }
}

SampledPolytope Sampler::run(std::vector<Sample> samples, const std::vector<dvec3>& points) {
  const Stopwatch start_time;
  options_.progress.update("sample", 0);
  begin(std::move(samples), points);
  SampledPolytope polytope = [&] {
    try {
      const char* const failure = refine_to_tolerance();
      SampledPolytope whole = result();
      whole.failure = failure;
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
