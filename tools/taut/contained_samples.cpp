#include "contained_samples.h"

#include <algorithm>
#include <cmath>
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

void check_hull_points(const std::vector<dvec3>& points, const Scene& scene, double accuracy,
                       int threads, const Progress& progress, ContainedSamples& found) {
  HullContainmentOptions options;
  options.accuracy = accuracy;
  options.threads = threads;
  options.progress = progress;
  const HullContainment hull(scene, options);
  found.hull_points = long(points.size());
  for (const SignedDistance& d : hull.distances(points)) {
    // Outside by no less than what one direction tells; but inside only by what all of them do, of
    // which the best one found tells nothing.
    found.hull_outside = std::max(found.hull_outside, d.value);
    found.hull_inside = std::max(found.hull_inside, -d.upper);
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
  check_hull_points(mesh.points, scene, accuracy, threads, progress, found);
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
  std::vector<dvec3> points;
  for (const HullDocument::Curve& curve : hull.curves) {
    points.insert(points.end(), curve.points.begin(), curve.points.end());
  }
  for (const HullDocument::Face& face : hull.faces) {
    for (const HullDocument::Ruling& ruling : face.rulings) {
      points.insert(points.end(), {ruling.a.p, 0.5 * (ruling.a.p + ruling.b.p), ruling.b.p});
    }
    for (const HullDocument::Contact& contact : face.contacts) points.push_back(contact.p);
    points.insert(points.end(), face.boundary.begin(), face.boundary.end());
  }
  ContainedSamples found;
  check_hull_points(points, scene, accuracy, threads, progress, found);
  return found;
}

}  // namespace taut::tool
