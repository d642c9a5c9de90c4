#include "contained_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "taut/containment/closed_surface.h"
#include "taut/containment/hull_containment.h"
#include "taut/containment/model_containment.h"

namespace taut::tool {
namespace {

/// Points on the model, about; at least the corners and the middle of every patch.
constexpr double wanted_points = 50'000;
constexpr int least_grid = 3;
constexpr int most_grid = 65;

/// Points of a hull that are asked before the share that is done is told.
constexpr std::size_t points_at_once = 4096;

/// Points of a hull, each once, and how far inside of it each may be.
struct HullPoints {
  std::vector<dvec3> points;
  std::vector<double> bounds;

  /// What is there already keeps the smaller bound.
  void add(const dvec3& p, double bound) {
    const auto [at, is_new] = index_.try_emplace({p.x, p.y, p.z}, points.size());
    if (!is_new) {
      bounds[at->second] = std::min(bounds[at->second], bound);
      return;
    }
    points.push_back(p);
    bounds.push_back(bound);
  }

 private:
  std::map<std::array<double, 3>, std::size_t> index_;
};

void check_hull_points(const HullPoints& hull_points, const Scene& scene, double accuracy,
                       int threads, const Progress& progress, ContainedSamples& found) {
  HullContainmentOptions options;
  options.accuracy = accuracy;
  options.threads = threads;
  options.progress = progress;
  const HullContainment hull(scene, options);
  found.hull_points = long(hull_points.points.size());
  const std::span<const dvec3> points(hull_points.points);
  for (std::size_t begin = 0; begin < points.size(); begin += points_at_once) {
    progress.update("points", double(begin) / double(points.size()));
    const std::vector<SignedDistance> distances =
        hull.distances(points.subspan(begin, std::min(points_at_once, points.size() - begin)));
    for (std::size_t i = 0; i < distances.size(); ++i) {
      // Outside by no less than what one direction tells; but inside only by what all of them do,
      // of which the best one found tells nothing.
      found.hull_outside = std::max(found.hull_outside, distances[i].value);
      found.hull_inside =
          std::max(found.hull_inside, -distances[i].upper - hull_points.bounds[begin + i]);
    }
  }
}

std::vector<dvec3> model_points(const Model& model) {
  const int patches = std::max(1, model.patch_count());
  const int grid = std::clamp(int(std::sqrt(wanted_points / patches)), least_grid, most_grid);
  std::vector<dvec3> points;
  for (const Instance& instance : model.instances()) {
    const Part& part = model.parts()[std::size_t(instance.part)];
    const double last = grid - 1;
    for (const Patch& patch : part.patches()) {
      for (int i = 0; i < grid; ++i) {
        for (int j = 0; j < grid; ++j) {
          points.push_back(instance.pose(point(patch.bezier, i / last, j / last)));
        }
      }
    }
    for (const EdgePiece& piece : part.pieces()) {
      for (int i = 0; i < grid; ++i) points.push_back(instance.pose(point(piece.bezier, i / last)));
    }
    for (const dvec3& vertex : part.vertices()) points.push_back(instance.pose(vertex));
  }
  return points;
}

/// The mesh as a model of triangles, so that rounded corners make no polygon bent.
Model mesh_model(const PolygonMesh& mesh) {
  PolygonMesh triangles{mesh.points, {}};
  for (const std::vector<int>& polygon : mesh.polygons) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      triangles.polygons.push_back({polygon[0], polygon[k], polygon[k + 1]});
    }
  }
  Part part;
  part.add_polygons(triangles);
  Model model;
  model.add_part(std::move(part), 0);
  return model;
}

}  // namespace

ContainedSamples contained_samples(const PolygonMesh& mesh, const Scene& scene, double accuracy,
                                   int threads, const Progress& progress) {
  ContainedSamples found;
  HullPoints corners;
  for (const dvec3& p : mesh.points) corners.add(p, 0);
  check_hull_points(corners, scene, accuracy, threads, progress, found);
  Model triangles = mesh_model(mesh);
  // That an open mesh bounds nothing is another check's to say.
  if (!why_not_closed(triangles).empty()) return found;
  const Scene body(std::move(triangles), {threads, progress});
  ModelContainmentOptions options;
  options.on_tolerance = accuracy;
  options.accuracy = accuracy;
  options.threads = threads;
  options.progress = progress;
  const ModelContainment containment(body, options);
  const std::vector<dvec3> points = model_points(scene.model());
  std::vector<dvec3> outside;
  const std::vector<Location> locations = containment.locate(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (locations[i] == Location::outside) outside.push_back(points[i]);
  }
  for (const SignedDistance& d : containment.distances(outside)) {
    found.model_outside = std::max(found.model_outside, d.value);
  }
  found.model_points = long(points.size());
  return found;
}

ContainedSamples contained_samples(const HullDocument& hull, const Scene& scene, double accuracy,
                                   int threads, const Progress& progress) {
  HullPoints points;
  for (const HullDocument::Curve& curve : hull.curves) {
    double bound = 0;  // its places are those of both faces
    for (const int face : curve.faces) {
      if (face >= 0) bound = std::max(bound, hull.faces[std::size_t(face)].tolerant);
    }
    for (const dvec3& p : curve.points) points.add(p, bound);
  }
  for (const HullDocument::Face& face : hull.faces) {
    for (const HullDocument::Ruling& ruling : face.rulings) {
      for (const dvec3& p : {ruling.a.p, 0.5 * (ruling.a.p + ruling.b.p), ruling.b.p}) {
        points.add(p, face.tolerant);
      }
    }
    for (const HullDocument::Contact& contact : face.contacts) points.add(contact.p, face.tolerant);
    for (const dvec3& p : face.boundary) points.add(p, face.tolerant);
  }
  ContainedSamples found;
  check_hull_points(points, scene, accuracy, threads, progress, found);
  return found;
}

}  // namespace taut::tool
