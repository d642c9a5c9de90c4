#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include "taut/bounds/support_query.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/hull/certificate.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/point_hull.h"
#include "taut/hull/polytope_mesh.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A scene thinner than this in some direction, in its frame, is flat: below it, facet normals are
/// rounding noise (support values are proven to about 1e-13). Starting points closer than this
/// count as one.
constexpr double flat_width = 1e-11;

/// Refines a polytope of support points until its distance from the hull is certified.
class Sampler {
 public:
  Sampler(const Scene& scene, const HullOptions& options)
      : scene_(scene), options_(options), query_(scene), hull_(inflated(scene)) {}

  Hull run();

 private:
  /// What is known of a facet: its supporting plane.
  struct Plane {
    bool known = false;
    dvec3 n;
    double h_bound = 0;
    dvec3 point;  ///< the support point, in model coordinates
    Contact contact;
  };

  struct Span {
    int dimension;
    std::vector<dvec3> across;
  };
  static Span spanned(const std::vector<dvec3>& points);

  static Box inflated(const Scene& scene) {
    const double scale = scene.frame().scale;
    const dvec3 margin(1e-3 * scale * scene.diagonal());
    return {scale * scene.box().lower - margin, scale * scene.box().upper + margin};
  }
  /// What the point hull is told: model coordinates times the scene's scale, a power of two, so
  /// that its decisions hold for the coordinates as stored and never leave the range of doubles.
  dvec3 scaled(const dvec3& point) const { return scene_.frame().scale * point; }

  void start();
  void add_support_points(const std::vector<dvec3>& directions);
  void find_planes();
  void bound_vertices();
  bool refine();
  void remember(const dvec3& n, const Contact& contact, const dvec3& point);
  double gap(const Plane& plane, int vertex) const {
    return plane.h_bound - glm::dot(plane.n, frame_points_[std::size_t(vertex)]) + gap_rounding;
  }
  /// What a gap at a vertex means for the distance; infinite where the normals about the vertex
  /// prove nothing.
  double distance_bound(double gap, int vertex) const {
    const double depth = vertex_depths_[std::size_t(vertex)];
    return depth > 0 ? gap / depth : std::numeric_limits<double>::infinity();
  }
  HullMesh make_mesh();
  /// How far rounding may move a support point out of the hull, in model units: half a unit in the
  /// last place of each stored coordinate, and the evaluation in the frame.
  double vertex_rounding() const {
    const dvec3 largest = glm::max(glm::abs(scene_.box().lower), glm::abs(scene_.box().upper));
    return rounding_unit * (largest.x + largest.y + largest.z) +
           scene_.frame().length_to_model(gap_rounding);
  }

  /// Rounding of a gap in the scene's frame, where coordinates are at most about two.
  static constexpr double gap_rounding = 16 * rounding_unit;

  const Scene& scene_;
  const HullOptions& options_;
  SupportQuery query_;
  PointHull hull_;
  std::vector<Sample> samples_;        // per vertex
  std::vector<dvec3> frame_points_;    // per vertex
  std::vector<double> vertex_gaps_;    // per vertex: the largest gap of its facets
  std::vector<double> vertex_depths_;  // per vertex: cone_depth() of its facets' normals
  std::vector<Plane> planes_;          // per facet
  double tolerance_ = 0;               // in the scene's frame
  double bound_ = 0;
  HullStatistics statistics_;
};

void Sampler::remember(const dvec3& n, const Contact& contact, const dvec3& point) {
  samples_.push_back({n, contact});
  frame_points_.push_back(scene_.frame().to_frame(point));
}

void Sampler::add_support_points(const std::vector<dvec3>& directions) {
  std::vector<dvec3> points;
  for (const dvec3& n : directions) {
    const Support s = query_(n);
    const dvec3 point = scene_.frame().to_model(s.point);
    const dvec3 frame_point = scene_.frame().to_frame(point);
    const bool near_another = std::any_of(
        frame_points_.begin(), frame_points_.end(),
        [&](const dvec3& other) { return glm::distance(other, frame_point) < flat_width; });
    if (near_another) continue;
    points.push_back(scaled(point));
    remember(n, s.contact, point);
  }
  hull_.add(points);
}

/// What the points span, flat_width allowed for, and directions across it.
Sampler::Span Sampler::spanned(const std::vector<dvec3>& points) {
  dvec3 line(0.0);
  for (const dvec3& p : points) {
    if (glm::length(p - points.front()) > glm::length(line)) line = p - points.front();
  }
  if (glm::length(line) < flat_width) return {0, {}};
  line = unit(line);
  dvec3 off_line(0.0);
  for (const dvec3& p : points) {
    const dvec3 off = p - points.front() - glm::dot(p - points.front(), line) * line;
    if (glm::length(off) > glm::length(off_line)) off_line = off;
  }
  if (glm::length(off_line) < flat_width) {
    const dvec3 axis = std::abs(line.x) < std::abs(line.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 a = unit(glm::cross(line, axis));
    const dvec3 b = glm::cross(line, a);
    return {1, {a, -a, b, -b, unit(a + b), -unit(a + b), unit(a - b), -unit(a - b)}};
  }
  const dvec3 normal = unit(glm::cross(line, off_line));
  double off_plane = 0;
  for (const dvec3& p : points) {
    off_plane = std::max(off_plane, std::abs(glm::dot(p - points.front(), normal)));
  }
  return {off_plane < flat_width ? 2 : 3, {normal, -normal}};
}

/// The support points of 26 directions: axes, and diagonals of faces and of space; and while they
/// lie in a plane or on a line, those of the directions across it.
void Sampler::start() {
  std::vector<dvec3> directions;
  for (int k = 0; k < 27; ++k) {
    const dvec3 d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (d != dvec3(0.0)) directions.push_back(unit(d));
  }
  add_support_points(directions);
  for (Span span = spanned(frame_points_); span.dimension < 3;) {
    add_support_points(span.across);
    const Span wider = spanned(frame_points_);
    if (wider.dimension == span.dimension) {
      throw InvalidInput("the model is flat: its hull has dimension " +
                         std::to_string(span.dimension) + ", and only solid hulls can be computed");
    }
    span = wider;
  }
}

/// Queries the supporting plane of every facet that has none yet, in parallel; each query starts
/// from the contact of the vertex whose own direction is closest.
void Sampler::find_planes() {
  planes_.resize(hull_.facets().size());
  std::vector<int> wanted;
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (hull_.facets()[f].alive && !planes_[f].known) wanted.push_back(int(f));
  }
  constexpr std::size_t grain = 64;
  std::vector<std::pair<long, long>> counts((wanted.size() + grain - 1) / grain);
  parallel_for(wanted.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    SupportQuery query(scene_);
    for (std::size_t k = begin; k < end; ++k) {
      options_.progress.check();
      const PointHull::Facet& facet = hull_.facet(wanted[k]);
      Plane& plane = planes_[std::size_t(wanted[k])];
      plane.n = unit(facet.side.normal());
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
  for (const PointHull::Facet& facet : hull_.facets()) {
    if (!facet.alive) continue;
    for (const int v : facet.vertex) ++first[std::size_t(v) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<dvec3> normals(std::size_t(first.back()));
  std::vector<int> next(first.begin(), first.end() - 1);
  vertex_gaps_.assign(count, 0);
  vertex_depths_.assign(count, 1);
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (!hull_.facets()[f].alive) continue;
    for (const int v : hull_.facets()[f].vertex) {
      normals[std::size_t(next[std::size_t(v)]++)] = planes_[f].n;
      double& largest = vertex_gaps_[std::size_t(v)];
      largest = std::max(largest, gap(planes_[f], v));
    }
  }
  bound_ = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const std::span<const dvec3> own(normals.data() + first[v], normals.data() + first[v + 1]);
    if (own.empty()) continue;  // no vertex of the boundary any more
    vertex_depths_[v] = cone_depth(own);
    bound_ = std::max(bound_, distance_bound(vertex_gaps_[v], int(v)));
  }
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
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.gap != b.gap ? a.gap > b.gap : a.facet < b.facet;
  });
  bool inserted = false;
  for (const Candidate& c : candidates) {
    // A facet that an earlier insertion replaced has lost its plane.
    const Plane plane = planes_[std::size_t(c.facet)];
    if (!plane.known || plane.n != c.n) continue;
    if (!hull_.insert(scaled(plane.point), c.facet)) continue;
    remember(plane.n, plane.contact, plane.point);
    planes_.resize(hull_.facets().size());
    for (const int f : hull_.replaced()) planes_[std::size_t(f)].known = false;
    for (const int f : hull_.created()) planes_[std::size_t(f)].known = false;
    inserted = true;
  }
  return inserted;
}

HullMesh Sampler::make_mesh() {
  std::vector<double> gaps(planes_.size(), 0);
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    if (!hull_.facets()[f].alive) continue;
    for (const int v : hull_.facets()[f].vertex) gaps[f] = std::max(gaps[f], gap(planes_[f], v));
  }
  std::vector<double> bounds;
  for (std::size_t v = 0; v < vertex_gaps_.size(); ++v) {
    bounds.push_back(scene_.frame().length_to_model(distance_bound(vertex_gaps_[v], int(v))));
  }
  return polytope_mesh(scene_, hull_, samples_, gaps, flat_width, bounds);
}

Hull Sampler::run() {
  if (!(options_.tolerance > 0)) throw InvalidInput("the tolerance must be positive");
  const auto start_time = Clock::now();
  tolerance_ = options_.tolerance * scene_.frame().scale;
  start();
  for (;;) {
    find_planes();
    bound_vertices();
    // Vertices grow as the inverse of the distance: the orders of magnitude done tell the rounds.
    options_.progress.update("sample", std::clamp(std::log(bound_) / std::log(tolerance_), 0., 1.));
    if (bound_ <= tolerance_) break;
    const bool full = int(hull_.points().size()) >= options_.max_vertices;
    if (full || !refine()) {
      // Where nothing is certified, everything lies within the diagonal all the same.
      const double reached = std::min(scene_.frame().length_to_model(bound_), scene_.diagonal());
      throw NotConverged(full ? "the limit of vertices was met before the tolerance"
                              : "the tolerance is below what double precision can certify here",
                         reached);
    }
  }
  Hull result;
  statistics_.support_queries += query_.queries();
  statistics_.newton_iterations += query_.newton_iterations();
  statistics_.seconds_sample = seconds_since(start_time);
  const auto mesh_time = Clock::now();
  options_.progress.update("mesh", 0);
  result.mesh = make_mesh();
  statistics_.seconds_mesh = seconds_since(mesh_time);
  result.distance_bound = std::max(scene_.frame().length_to_model(bound_), vertex_rounding());
  result.statistics = statistics_;
  return result;
}

}  // namespace

Hull sampled_hull(const Scene& scene, const HullOptions& options) {
  return Sampler(scene, options).run();
}

}  // namespace taut
