#include "taut/containment/model_containment.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <string>

#include "taut/containment/closed_surface.h"
#include "taut/containment/placed_surface.h"
#include "taut/containment/point_batches.h"
#include "taut/containment/ray_crossings.h"
#include "taut/containment/surface_distance.h"
#include "taut/core/nearest_in_simplex.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

constexpr std::size_t grain = 64;
constexpr std::size_t most_triangles = 2'000'000;

/// What floats may move the surface and a ray by, in a frame of size about two.
constexpr double float_margin = 1e-5;

/// Directions tried for one point before it is left in doubt. A random one is in doubt once in some
/// ten (near sides of triangles) or in some million (crossings of patches).
constexpr int ray_limit = 64;

/// Beyond this many sizes of the frame a point is outside and the model a point.
constexpr double far_away = 1e6;

/// Directions that depend on the point alone, so that answers do not depend on the order.
class Directions {
 public:
  explicit Directions(const dvec3& x) {
    std::uint64_t bits[3];
    std::memcpy(bits, &x, sizeof bits);
    random_.seed(bits[0] ^ (bits[1] * 0x9E3779B97F4A7C15U) ^ (bits[2] * 0xC2B2AE3D27D4EB4FU));
  }
  dvec3 next() {
    for (;;) {
      const auto coordinate = [&] { return double(random_() >> 11) * 0x1p-52 - 1; };
      const double a = coordinate();
      const double b = coordinate();
      const dvec3 v(a, b, coordinate());
      const double length = glm::length(v);
      if (length > 0.1 && length <= 1) return v / length;
    }
  }

 private:
  std::mt19937_64 random_;
};

double distance_to_triangle(const dvec3& x, const std::array<dvec3, 3>& corner) {
  return glm::length(
      nearest_in_simplex(std::array{corner[0] - x, corner[1] - x, corner[2] - x}).point);
}

}  // namespace

struct ModelContainment::Content {
  const Scene& scene;
  ModelContainmentOptions options;
  PlacedSurface surface;
  Tessellation mesh;
  std::optional<TriangleRays> rays;
  std::optional<TriangleRays> polygons;  ///< the polygons' triangles alone
  Box box;                               ///< in the scene's frame
  double on_tolerance;                   ///< in the scene's frame
  double accuracy;
  double near;  ///< closer to the tessellation floats decide nothing

  Content(const Scene& scene, const ModelContainmentOptions& options);
};

ModelContainment::Content::Content(const Scene& its_scene, const ModelContainmentOptions& its)
    : scene(its_scene), options(its) {
  if (!(options.mesh_relative > 0) || std::isnan(options.on_tolerance) ||
      std::isnan(options.accuracy)) {
    throw InvalidInput("a tolerance is no number, or not positive");
  }
  if (const std::string reason = why_not_closed(scene.model()); !reason.empty()) {
    throw InvalidInput("the model is not closed: " + reason);
  }
  surface = placed_surface(scene);
  const double diagonal = scene.frame().length_to_frame(scene.diagonal());
  const SceneFrame& frame = scene.frame();
  on_tolerance = options.on_tolerance >= 0
                     ? frame.length_to_frame(options.on_tolerance)
                     : std::max(default_on_tolerance * diagonal, surface.crack);
  accuracy = options.accuracy >= 0 ? frame.length_to_frame(options.accuracy)
                                   : default_distance_accuracy * diagonal;
  mesh = tessellation(scene, surface, options.mesh_relative * diagonal, most_triangles);
  rays.emplace(mesh.points, mesh.triangles);
  if (!surface.triangles.empty()) {
    std::vector<dvec3> points;
    std::vector<Triangle> triangles;
    for (const PlacedTriangle& t : surface.triangles) {
      const int first = int(points.size());
      points.insert(points.end(), t.corner.begin(), t.corner.end());
      triangles.push_back({first, first + 1, first + 2});
    }
    polygons.emplace(points, triangles);
  }
  for (const dvec3& p : mesh.points) box.include(p);
  near = mesh.deviation + surface.crack + surface.rounding + float_margin + on_tolerance;
  box.lower -= near;
  box.upper += near;
}

/// Answers points one after the other.
class ModelContainment::Worker {
 public:
  explicit Worker(const Content& content)
      : content_(content), distance_(content.surface), crossings_(content.surface) {}

  Location locate(const dvec3& point) {
    const dvec3 x = point_in_frame(content_.scene.frame(), point);
    if (is_beyond_box(x)) return Location::outside;
    const double near = mesh_distance(x);
    if (near >= content_.near) {
      if (const auto inside = parity_by_embree(x)) return located(any(*inside));
    }
    ++searched_;
    const DistanceRange range = distance(x, {0, content_.on_tolerance}, -1, near);
    if (range.lower > content_.on_tolerance) {
      const auto inside = parity(x, -1);
      return inside ? located(any(*inside)) : Location::on;
    }
    return is_inside_another(x) ? Location::inside : Location::on;
  }

  SignedDistance measure(const dvec3& point) {
    const SceneFrame& frame = content_.scene.frame();
    const dvec3 x = point_in_frame(frame, point);
    const SignedDistance d = measure_in_frame(x);
    return {frame.length_to_model(d.value), frame.length_to_model(d.lower),
            frame.length_to_model(d.upper)};
  }

  ContainmentCounts counts() const { return {0, searched_, 0}; }

 private:
  static Location located(bool inside) { return inside ? Location::inside : Location::outside; }
  static bool any(const std::vector<char>& inside) {
    return std::find(inside.begin(), inside.end(), 1) != inside.end();
  }

  bool is_beyond_box(const dvec3& x) const {
    const Box& box = content_.box;
    for (int axis = 0; axis < 3; ++axis) {
      if (x[axis] < box.lower[axis] || x[axis] > box.upper[axis]) return true;
    }
    return false;
  }

  /// Of x from the tessellation, where that is less than content_.near.
  double mesh_distance(const dvec3& x) const {
    return content_.rays->nearest(x, content_.near, [&](int triangle) {
      const Triangle& t = content_.mesh.triangles[std::size_t(triangle)];
      return distance_to_triangle(
          x, {content_.mesh.points[std::size_t(t[0])], content_.mesh.points[std::size_t(t[1])],
              content_.mesh.points[std::size_t(t[2])]});
    });
  }

  /// Bounds of the distance of x from the surface of one body, or of all (-1).
  DistanceRange distance(const dvec3& x, const DistanceGoal& goal, int body, double mesh_distance) {
    const double within = mesh_distance < content_.near && body < 0
                              ? mesh_distance + content_.mesh.deviation
                              : infinity;
    DistanceRange range = distance_(x, goal, body, within);
    if (!content_.polygons) return range;
    const double d = content_.polygons->nearest(x, range.value, [&](int triangle) {
      const PlacedTriangle& t = content_.surface.triangles[std::size_t(triangle)];
      return body < 0 || t.body == body ? distance_to_triangle(x, t.corner) : infinity;
    });
    if (d < range.value) range = {d, std::min(d, range.lower), d};
    const double rounding = content_.surface.rounding;
    range.lower = std::min(range.lower, d - rounding);
    range.upper = std::max(range.upper, range.value + rounding);
    return range;
  }

  /// Which bodies x is in, by rays through the tessellation.
  std::optional<std::vector<char>> parity_by_embree(const dvec3& x) {
    Directions directions(x);
    std::optional<std::vector<char>> first;
    for (int k = 0; k < ray_limit; ++k) {
      content_.rays->all_hits(x, directions.next(), hits_);
      if (hits_.doubtful) continue;
      std::vector<char> odd(std::size_t(content_.surface.bodies), 0);
      for (const int t : hits_.triangles) {
        odd[std::size_t(content_.mesh.body[std::size_t(t)])] ^= 1;
      }
      if (!first) {
        first = std::move(odd);
      } else if (*first == odd) {
        return odd;
      } else {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Whether x is in one body, or in which of all (-1), by rays through the surface itself.
  std::optional<std::vector<char>> parity(const dvec3& x, int body) {
    Directions directions(x);
    for (int k = 0; k < ray_limit; ++k) {
      if (crossings_.count(x, directions.next(), body)) return crossings_.odd();
    }
    return std::nullopt;
  }

  /// Whether x, which lies on a body's surface, is inside another body.
  bool is_inside_another(const dvec3& x) {
    for (int body = 0; body < content_.surface.bodies && content_.surface.bodies > 1; ++body) {
      const DistanceRange own = distance(x, {0, content_.on_tolerance}, body, infinity);
      if (!(own.lower > content_.on_tolerance)) continue;
      const auto inside = parity(x, body);
      if (inside && any(*inside)) return true;
    }
    return false;
  }

  /// Which bodies x is in; none where it is on one, as far as rounding tells, and in no other.
  std::optional<std::vector<char>> parity_by_bodies(const dvec3& x) {
    const double doubt = 4 * (content_.surface.rounding + content_.surface.crack);
    std::vector<char> inside(std::size_t(content_.surface.bodies), 0);
    bool known = true;
    for (int body = 0; body < content_.surface.bodies; ++body) {
      std::optional<std::vector<char>> own;
      if (distance(x, {0, doubt}, body, infinity).lower > doubt) own = parity(x, body);
      if (own) {
        inside[std::size_t(body)] = (*own)[std::size_t(body)];
      } else {
        known = false;
      }
    }
    if (!known && !any(inside)) return std::nullopt;
    return inside;
  }

  SignedDistance measure_in_frame(const dvec3& x) {
    ++searched_;
    const double size = glm::dot(x, unit(x));
    if (size > far_away) {
      const double spread = 4 + 1e-15 * size;
      return {size, size - spread, size + spread};
    }
    const DistanceGoal goal{content_.accuracy, -1};
    const double near = mesh_distance(x);
    const DistanceRange all = distance(x, goal, -1, near);
    std::optional<std::vector<char>> inside;
    if (is_beyond_box(x)) {
      return {all.value, all.lower, all.upper};
    }
    if (near >= content_.near) inside = parity_by_embree(x);
    if (!inside) inside = parity_by_bodies(x);
    if (!inside) return {0, -all.upper, all.upper};  // on the surface, for all that is known
    if (!any(*inside)) return {all.value, all.lower, all.upper};
    const bool alone = content_.surface.bodies == 1;
    SignedDistance deepest{0, 0, 0};
    for (int body = 0; body < content_.surface.bodies; ++body) {
      if ((*inside)[std::size_t(body)] == 0) continue;
      const DistanceRange own = alone ? all : distance(x, goal, body, near);
      deepest.value = std::min(deepest.value, -own.value);
      deepest.upper = std::min(deepest.upper, -own.lower);
      deepest.lower = std::min(deepest.lower, -own.upper);
    }
    if (!alone) deepest.lower = std::min(deepest.lower, -depth_in_box(x));
    return deepest;
  }

  double depth_in_box(const dvec3& x) const {
    const dvec3 depth = glm::min(x - content_.box.lower, content_.box.upper - x);
    return std::min({depth.x, depth.y, depth.z});
  }

  const Content& content_;
  SurfaceDistance distance_;
  RayCrossings crossings_;
  TriangleRays::Hits hits_;
  long searched_ = 0;
};

ModelContainment::ModelContainment(const Scene& scene, const ModelContainmentOptions& options)
    : content_(std::make_unique<const Content>(scene, options)) {}
ModelContainment::~ModelContainment() = default;
ModelContainment::ModelContainment(ModelContainment&&) noexcept = default;

Location ModelContainment::locate(const dvec3& x) const { return Worker(*content_).locate(x); }

SignedDistance ModelContainment::distance(const dvec3& x) const {
  return Worker(*content_).measure(x);
}

std::vector<Location> ModelContainment::locate(std::span<const dvec3> points,
                                               ContainmentCounts* counts) const {
  return answer_points<Location>(
      points, {grain, content_->options.threads, content_->options.progress}, counts,
      [&] { return Worker(*content_); },
      [](Worker& worker, const dvec3& x) { return worker.locate(x); });
}

std::vector<SignedDistance> ModelContainment::distances(std::span<const dvec3> points,
                                                        ContainmentCounts* counts) const {
  return answer_points<SignedDistance>(
      points, {grain, content_->options.threads, content_->options.progress}, counts,
      [&] { return Worker(*content_); },
      [](Worker& worker, const dvec3& x) { return worker.measure(x); });
}

double ModelContainment::on_tolerance() const {
  return content_->scene.frame().length_to_model(content_->on_tolerance);
}

}  // namespace taut
