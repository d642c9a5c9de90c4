#include "taut/containment/hull_containment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "taut/bounds/scene_content.h"
#include "taut/containment/hull_distance.h"
#include "taut/containment/point_batches.h"
#include "taut/containment/triangle_rays.h"
#include "taut/core/tolerances.h"
#include "taut/hull/sample/sampled_polytope.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// The polytope from which exact searches start: a coarser one leaves them more facets to replace,
/// a finer one more to copy for each point.
constexpr double start_relative = 1e-2;

/// Facets whose tetrahedron with the middle is so thin that weights of points in it would be
/// rounded by more prove nothing.
constexpr double worst_weight_rounding = 1e-3;

/// Beyond this many sizes of the scene the hull is a point, as far as distances can tell.
constexpr double beyond_distances = 1e100;
constexpr double far_share = 1e-15;

constexpr std::size_t location_grain = 1024;
constexpr std::size_t distance_grain = 16;

/// A facet of the mesh, in the scene's frame.
struct MeshFacet {
  Triangle vertex;
  dvec3 n;              ///< unit
  double outer;         ///< no point of the model is higher
  dmat3 weights;        ///< of the corners in x - middle
  double least_weight;  ///< from which on weights are positive in spite of rounding
};

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

  dvec3 to_frame(const dvec3& x) const { return point_in_frame(scene.frame(), x); }
  std::optional<Location> by_mesh(const dvec3& x, int& facet) const;
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
  const double margin = on_tolerance + 4 * contact_rounding(scene);
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
  SupportQuery query(scene, options.progress.stop);
  const SampledStart first = sampled_start(scene, query);
  if (first.span.dimension < 3) {
    start = support_polytope(scene, first.samples);
    start.across = directions_across(first.span);
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
  if (mesh.limit) throw LimitMet(*mesh.limit);
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
  const double rounding =
      64 * rounding_unit + 4 * scene.frame().length_to_frame(vertex_rounding(scene));
  inner_radius = radius_about(middle) - rounding;
  if (!(inner_radius > on_tolerance)) return;  // as good as flat: all is left to searches

  std::vector<Triangle> triangles;
  for (const int f : alive) {
    facets.push_back(facet(mesh, f, points));
    triangles.push_back(facets.back().vertex);
  }
  rays.emplace(points, triangles);
}

/// What the mesh proves, and the facet in whose cone the point lies, -1 if that is not known.
std::optional<Location> HullContainment::Content::by_mesh(const dvec3& x, int& facet) const {
  facet = -1;
  if (!rays) return std::nullopt;
  const dvec3 from_middle = x - middle;
  const double distance = glm::length(from_middle);
  if (!(distance < beyond_distances)) return Location::outside;
  const double rounding = 16 * rounding_unit * (2 + distance);
  const double margin = on_tolerance + rounding + contact_rounding(scene);
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

/// Answers points one after the other.
class HullContainment::Worker {
 public:
  explicit Worker(const Content& content) : content_(content) {}

  Location locate(const dvec3& point) {
    const dvec3 x = content_.to_frame(point);
    for (int axis = 0; axis < 3; ++axis) {
      if (x[axis] < content_.box.lower[axis] || x[axis] > content_.box.upper[axis]) {
        return Location::outside;
      }
    }
    int facet = -1;
    if (const auto known = content_.by_mesh(x, facet)) return *known;
    const DistanceRange range = search(x, facet, {0, content_.on_tolerance});
    return SignedDistance{range.value, range.lower, range.upper}.location(content_.on_tolerance);
  }

  SignedDistance distance(const dvec3& point) {
    const dvec3 x = content_.to_frame(point);
    const double scale = content_.scene.frame().scale;
    const double size = glm::dot(x, unit(x));
    if (size > beyond_distances) {  // the hull is a point, as far as doubles can tell
      return {size / scale, size * (1 - far_share) / scale, size * (1 + far_share) / scale};
    }
    int facet = -1;
    content_.by_mesh(x, facet);
    const DistanceRange range = search(x, facet, {content_.accuracy, -1});
    return {range.value / scale, range.lower / scale, range.upper / scale};
  }

  ContainmentCounts counts() const { return {0, searched_, search_ ? search_->queries() : 0}; }

 private:
  DistanceRange search(const dvec3& x, int facet, const DistanceGoal& goal) {
    ++searched_;
    if (!search_) search_.emplace(content_.scene, content_.start);
    if (facet < 0) return (*search_)(x, goal, {}, dvec3(0.0));
    const MeshFacet& f = content_.facets[std::size_t(facet)];
    const std::array<Sample, 3> near = {content_.samples[std::size_t(f.vertex[0])],
                                        content_.samples[std::size_t(f.vertex[1])],
                                        content_.samples[std::size_t(f.vertex[2])]};
    return (*search_)(x, goal, near, f.n);
  }

  const Content& content_;
  std::optional<HullDistance> search_;
  long searched_ = 0;
};

HullContainment::HullContainment(const Scene& scene, const HullContainmentOptions& options)
    : content_(std::make_unique<const Content>(scene, options)) {}
HullContainment::~HullContainment() = default;
HullContainment::HullContainment(HullContainment&&) noexcept = default;

Location HullContainment::locate(const dvec3& x) const { return Worker(*content_).locate(x); }

SignedDistance HullContainment::distance(const dvec3& x) const {
  return Worker(*content_).distance(x);
}

std::vector<Location> HullContainment::locate(std::span<const dvec3> points,
                                              ContainmentCounts* counts) const {
  return answer_points<Location>(
      points, {location_grain, content_->options.threads, content_->options.progress}, counts,
      [&] { return Worker(*content_); },
      [](Worker& worker, const dvec3& x) { return worker.locate(x); });
}

std::vector<SignedDistance> HullContainment::distances(std::span<const dvec3> points,
                                                       ContainmentCounts* counts) const {
  return answer_points<SignedDistance>(
      points, {distance_grain, content_->options.threads, content_->options.progress}, counts,
      [&] { return Worker(*content_); },
      [](Worker& worker, const dvec3& x) { return worker.distance(x); });
}

double HullContainment::on_tolerance() const {
  return content_->scene.frame().length_to_model(content_->on_tolerance);
}
double HullContainment::mesh_distance() const { return content_->mesh_distance; }

}  // namespace taut
