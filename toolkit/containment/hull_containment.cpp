#include "taut/containment/hull_containment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "taut/bounds/scene_content.h"
#include "taut/containment/hull_distance.h"
#include "taut/containment/triangle_rays.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/hull/sampled_start.h"

namespace taut {
namespace {

/// The polytope from which exact searches start: a coarser one leaves them more facets to replace,
/// a finer one more to copy for each point.
constexpr double start_relative = 1e-2;

/// Its points are farther from each other than this, in the scene's frame.
constexpr double same_start_point = 1e-7;

/// Facets whose tetrahedron with the middle is so thin that weights of points in it would be
/// rounded by more prove nothing.
constexpr double worst_weight_rounding = 1e-3;

/// Beyond this many sizes of the scene the hull is a point, as far as distances can tell.
constexpr double far_away = 1e100;

constexpr std::size_t grain = 1024;
constexpr std::size_t distance_grain = 16;

bool is_finite(const dvec3& x) {
  return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
}

/// A facet of the mesh, in the scene's frame.
struct MeshFacet {
  Triangle vertex;
  dvec3 n;              ///< unit
  double outer;         ///< no point of the model is higher
  dmat3 weights;        ///< of the corners in x - middle
  double least_weight;  ///< from which on they are positive in spite of rounding
};

/// The polytope of samples, without those that repeat another but for rounding: slivers between
/// them would bound nothing.
SupportPolytope support_polytope(const Scene& scene, const std::vector<Sample>& samples) {
  SupportPolytope polytope{PointHull(Box{dvec3(-2.0), dvec3(2.0)}), {}};
  std::vector<dvec3> points;
  for (const Sample& s : samples) {
    const dvec3 x = scene.content().frame_point(s.contact);
    const bool repeated = std::any_of(points.begin(), points.end(), [&](const dvec3& other) {
      return glm::distance(other, x) < same_start_point;
    });
    if (repeated) continue;
    points.push_back(x);
    polytope.samples.push_back(s);
  }
  polytope.hull.add(points);
  return polytope;
}

}  // namespace

struct HullContainment::Content {
  const Scene& scene;
  HullContainmentOptions options;
  double on_tolerance;  ///< in the scene's frame
  double accuracy;
  double mesh_distance = std::numeric_limits<double>::infinity();

  SupportPolytope start{PointHull(Box{dvec3(-2.0), dvec3(2.0)}), {}};
  std::vector<Sample> samples;  ///< per vertex of the mesh
  std::vector<MeshFacet> facets;
  std::optional<TriangleRays> rays;
  dvec3 middle = dvec3(0.0);
  double inner_radius = 0;  ///< of a ball about the middle in the hull
  Box box;                  ///< of the hull, in the scene's frame, rounding included

  Content(const Scene& scene, const HullContainmentOptions& options);
  void make_mesh();
  void take_facets(const SampledPolytope& mesh, const std::vector<dvec3>& points);
  MeshFacet facet(const SampledPolytope& mesh, int f, const std::vector<dvec3>& points) const;

  dvec3 to_frame(const dvec3& x) const;
  std::optional<Location> by_mesh(const dvec3& x, int& facet) const;
  DistanceRange search(HullDistance& distance, const dvec3& x, int facet,
                       const DistanceGoal& goal) const;
  Location locate(const dvec3& point, std::optional<HullDistance>& distance, long& searched) const;
  SignedDistance measure(const dvec3& point, HullDistance& distance) const;
};

HullContainment::Content::Content(const Scene& its_scene, const HullContainmentOptions& its_options)
    : scene(its_scene), options(its_options) {
  if (std::isnan(options.on_tolerance) || std::isnan(options.accuracy)) {
    throw InvalidInput("a tolerance is no number");
  }
  const auto in_frame = [&](double length, double relative) {
    return scene.frame().length_to_frame(length >= 0 ? length : relative * scene.diagonal());
  };
  on_tolerance = in_frame(options.on_tolerance, default_on_tolerance);
  accuracy = in_frame(options.accuracy, default_distance_accuracy);
  const double margin = on_tolerance + 64 * rounding_unit;
  box = {scene.frame().to_frame(scene.box().lower) - margin,
         scene.frame().to_frame(scene.box().upper) + margin};
  make_mesh();
}

/// The meshes: a coarse one to start searches from and one for rays.
void HullContainment::Content::make_mesh() {
  HullOptions hull_options;
  hull_options.relative = options.mesh_relative;
  hull_options.threads = options.threads;
  hull_options.progress = options.progress;
  const double tolerance = tolerance_for(hull_options, scene.diagonal());
  SupportQuery query(scene);
  const SampledStart first = sampled_start(scene, query);
  if (first.span.dimension < 3) {
    start = support_polytope(scene, first.samples);
    return;
  }
  const double start_tolerance = std::max(tolerance, start_relative * scene.diagonal());
  const SampledPolytope coarse =
      sampled_polytope(scene, hull_options, start_tolerance, first.samples, first.points);
  start = support_polytope(scene, coarse.samples);
  std::vector<dvec3> points;
  for (const dvec3& p : coarse.hull.points()) points.push_back(p / scene.frame().scale);
  const SampledPolytope mesh =
      sampled_polytope(scene, hull_options, tolerance, coarse.samples, points);
  samples = mesh.samples;
  mesh_distance = mesh.distance_bound;
  points.clear();
  for (const Sample& s : samples) points.push_back(scene.content().frame_point(s.contact));
  take_facets(mesh, points);
}

MeshFacet HullContainment::Content::facet(const SampledPolytope& mesh, int f,
                                          const std::vector<dvec3>& points) const {
  const PointHull::Facet& own = mesh.hull.facet(f);
  MeshFacet facet;
  facet.vertex = own.vertex;
  facet.n = unit(own.side.normal());
  // The gap is that over the lowest corner.
  double lowest = std::numeric_limits<double>::infinity();
  dmat3 corners;
  for (int k = 0; k < 3; ++k) {
    const dvec3& p = points[std::size_t(own.vertex[std::size_t(k)])];
    lowest = std::min(lowest, glm::dot(p, facet.n));
    corners[k] = p - middle;
  }
  const double rounding = scene.frame().length_to_frame(vertex_rounding(scene)) + gap_rounding;
  facet.outer = lowest + mesh.gaps[std::size_t(f)] + rounding;
  facet.weights = glm::inverse(corners);
  double size = 0;
  double inverse_size = 0;
  for (int k = 0; k < 3; ++k) {
    size = std::max(size, glm::length(corners[k]));
    inverse_size = std::max(inverse_size, glm::length(facet.weights[k]));
  }
  // An inverse is off by its condition in rounding units.
  const double condition = 3 * size * inverse_size;
  facet.least_weight = 64 * rounding_unit * condition * condition;
  if (!(facet.least_weight < worst_weight_rounding)) {
    facet.least_weight = std::numeric_limits<double>::infinity();
  }
  return facet;
}

void HullContainment::Content::take_facets(const SampledPolytope& mesh,
                                           const std::vector<dvec3>& points) {
  // Rays from a middle in no symmetric position meet edges and vertices by chance only.
  std::vector<int> alive;
  dvec3 sum(0.0);
  double total = 0;
  for (std::size_t f = 0; f < mesh.hull.facets().size(); ++f) {
    if (!mesh.hull.facets()[f].alive) continue;
    alive.push_back(int(f));
    const Triangle& t = mesh.hull.facets()[f].vertex;
    const dvec3& a = points[std::size_t(t[0])];
    const dvec3& b = points[std::size_t(t[1])];
    const dvec3& c = points[std::size_t(t[2])];
    const double volume = glm::dot(a, glm::cross(b, c));
    sum += volume * (a + b + c);
    total += volume;
  }
  middle = sum / (4 * total);
  const auto radius_about = [&](const dvec3& x) {
    double radius = std::numeric_limits<double>::infinity();
    for (const int f : alive) {
      const PointHull::Facet& own = mesh.hull.facet(f);
      const dvec3 n = unit(own.side.normal());
      radius = std::min(radius, glm::dot(points[std::size_t(own.vertex[0])] - x, n));
    }
    return radius;
  };
  middle += 0.1 * radius_about(middle) * dvec3(0.3011, 0.5023, 0.7017);
  const double rounding = 64 * rounding_unit;
  inner_radius = radius_about(middle) - rounding;
  if (!(inner_radius > on_tolerance)) return;  // as good as flat: all is left to searches

  std::vector<Triangle> triangles;
  for (const int f : alive) {
    facets.push_back(facet(mesh, f, points));
    triangles.push_back(facets.back().vertex);
  }
  rays.emplace(points, triangles);
}

/// @throws InvalidInput if the point is not finite, or overflows there
dvec3 HullContainment::Content::to_frame(const dvec3& x) const {
  const dvec3 in_frame = scene.frame().to_frame(x);
  if (!is_finite(x) || !is_finite(in_frame)) {
    throw InvalidInput("a point is not finite, or too far from the model for doubles");
  }
  return in_frame;
}

/// What the mesh proves, and the facet in whose cone the point lies, -1 if that is not known.
std::optional<Location> HullContainment::Content::by_mesh(const dvec3& x, int& facet) const {
  facet = -1;
  if (!rays) return std::nullopt;
  const dvec3 from_middle = x - middle;
  const double distance = glm::length(from_middle);
  if (!(distance < far_away)) return Location::outside;
  const double rounding = 16 * rounding_unit * (2 + distance);
  const double margin = on_tolerance + rounding;
  if (distance < inner_radius - margin) return Location::inside;
  if (distance == 0) return std::nullopt;
  facet = rays->first_hit(middle, from_middle / distance);
  if (facet < 0) return std::nullopt;
  const MeshFacet& f = facets[std::size_t(facet)];
  if (glm::dot(f.n, x) > f.outer + margin) return Location::outside;
  const dvec3 w = f.weights * from_middle;
  // A share 1 - sum of the ball about the middle stays around the point.
  if (std::min({w.x, w.y, w.z}) > f.least_weight &&
      (1 - (w.x + w.y + w.z) - f.least_weight) * inner_radius > margin) {
    return Location::inside;
  }
  return std::nullopt;
}

DistanceRange HullContainment::Content::search(HullDistance& distance, const dvec3& x, int facet,
                                               const DistanceGoal& goal) const {
  if (facet < 0) return distance(x, goal, {}, dvec3(0.0));
  const MeshFacet& f = facets[std::size_t(facet)];
  const std::array<Sample, 3> near = {samples[std::size_t(f.vertex[0])],
                                      samples[std::size_t(f.vertex[1])],
                                      samples[std::size_t(f.vertex[2])]};
  return distance(x, goal, near, f.n);
}

Location HullContainment::Content::locate(const dvec3& point, std::optional<HullDistance>& distance,
                                          long& searched) const {
  const dvec3 x = to_frame(point);
  for (int axis = 0; axis < 3; ++axis) {
    if (x[axis] < box.lower[axis] || x[axis] > box.upper[axis]) return Location::outside;
  }
  int facet = -1;
  if (const auto known = by_mesh(x, facet)) return *known;
  ++searched;
  if (!distance) distance.emplace(scene, start);
  const DistanceRange range = search(*distance, x, facet, {0, on_tolerance});
  return SignedDistance{range.value, range.lower, range.upper}.location(on_tolerance);
}

SignedDistance HullContainment::Content::measure(const dvec3& point, HullDistance& distance) const {
  const dvec3 x = to_frame(point);
  const double scale = scene.frame().scale;
  const double size = glm::dot(x, unit(x));
  if (size > far_away)
    return {size / scale, size * (1 - 1e-15) / scale, size * (1 + 1e-15) / scale};
  int facet = -1;
  by_mesh(x, facet);
  const DistanceRange range = search(distance, x, facet, {accuracy, -1});
  return {range.value / scale, range.lower / scale, range.upper / scale};
}

HullContainment::HullContainment(const Scene& scene, const HullContainmentOptions& options)
    : content_(std::make_unique<const Content>(scene, options)) {}
HullContainment::~HullContainment() = default;
HullContainment::HullContainment(HullContainment&&) noexcept = default;

Location HullContainment::locate(const dvec3& x) const {
  std::optional<HullDistance> distance;
  long searched = 0;
  return content_->locate(x, distance, searched);
}

SignedDistance HullContainment::distance(const dvec3& x) const {
  HullDistance distance(content_->scene, content_->start);
  return content_->measure(x, distance);
}

std::vector<Location> HullContainment::locate(std::span<const dvec3> points,
                                              ContainmentCounts* counts) const {
  std::vector<Location> locations(points.size());
  std::vector<ContainmentCounts> ranges((points.size() + grain - 1) / grain);
  parallel_for(points.size(), grain, content_->options.threads,
               [&](std::size_t begin, std::size_t end) {
                 content_->options.progress.check();
                 std::optional<HullDistance> distance;
                 ContainmentCounts& own = ranges[begin / grain];
                 own.points = long(end - begin);
                 for (std::size_t i = begin; i < end; ++i) {
                   locations[i] = content_->locate(points[i], distance, own.searched);
                 }
                 if (distance) own.support_queries = distance->queries();
               });
  if (counts != nullptr) {
    for (const ContainmentCounts& own : ranges) *counts += own;
  }
  return locations;
}

std::vector<SignedDistance> HullContainment::distances(std::span<const dvec3> points,
                                                       ContainmentCounts* counts) const {
  std::vector<SignedDistance> distances(points.size());
  std::vector<ContainmentCounts> ranges((points.size() + distance_grain - 1) / distance_grain);
  parallel_for(points.size(), distance_grain, content_->options.threads,
               [&](std::size_t begin, std::size_t end) {
                 HullDistance distance(content_->scene, content_->start);
                 ContainmentCounts& own = ranges[begin / distance_grain];
                 own.points = own.searched = long(end - begin);
                 for (std::size_t i = begin; i < end; ++i) {
                   content_->options.progress.check();
                   distances[i] = content_->measure(points[i], distance);
                 }
                 own.support_queries = distance.queries();
               });
  if (counts != nullptr) {
    for (const ContainmentCounts& own : ranges) *counts += own;
  }
  return distances;
}

double HullContainment::on_tolerance() const {
  return content_->scene.frame().length_to_model(content_->on_tolerance);
}
double HullContainment::mesh_distance() const { return content_->mesh_distance; }

}  // namespace taut
