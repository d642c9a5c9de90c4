// The sampled hull of the teapot against the honest alternative: a uniform tessellation of the same
// measured accuracy, then the hull of its points by CGAL and Qhull. One thread; the programs take
// turns within one run, and the medians of the paired ratios are printed.
//
// The peers are given their points: tessellating, and finding the resolution that a wanted accuracy
// needs, is not counted.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "peers.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/point_hull.h"
#include "taut/io/read_model.h"

namespace {

using namespace taut;        // NOLINT: a program
using namespace taut_bench;  // NOLINT

std::vector<dvec3> tessellate(const Model& model, int steps) {
  std::vector<dvec3> points;
  for (const Patch& patch : model.parts()[0].patches()) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        points.push_back(point(patch.bezier, double(i) / steps, double(j) / steps));
      }
    }
  }
  return points;
}

/// How far the model reaches out of the points' hull: the largest gap of its facets.
double measured_distance(const Scene& scene, const std::vector<dvec3>& points) {
  PointHull hull(scene.box());
  hull.add(points);
  SupportQuery query(scene);
  double distance = 0;
  for (const PointHull::Facet& facet : hull.facets()) {
    if (!facet.alive) continue;
    const dvec3 n = unit(facet.side.normal());
    const dvec3 p = scene.frame().to_frame(hull.point(facet.vertex[0]));
    distance = std::max(distance, query(n).h - glm::dot(n, p));
  }
  return scene.frame().length_to_model(distance);
}

/// The coarsest tessellation of at most the distance, by bisection.
std::vector<dvec3> tessellation_of_accuracy(const Model& model, const Scene& scene,
                                            double distance) {
  int low = 1;
  int high = 2;
  while (measured_distance(scene, tessellate(model, high)) > distance) {
    low = high;
    high *= 2;
  }
  while (high - low > 1 && double(high - low) > 0.02 * high) {
    const int middle = low + (high - low) / 2;
    (measured_distance(scene, tessellate(model, middle)) > distance ? low : high) = middle;
  }
  return tessellate(model, high);
}

void compare(const Model& model, const Scene& scene, double relative, int runs) {
  HullOptions options;
  options.tolerance = relative * scene.diagonal();
  options.threads = 1;
  std::printf("\naccuracy %g of the diagonal; scene build included\n", relative);
  compare_with_peers(tessellation_of_accuracy(model, scene, options.tolerance), runs, [&] {
    const Scene fresh(model, {.threads = 1, .progress = {}});
    return long(sampled_hull(fresh, options).mesh.n_faces());
  });
}

}  // namespace

int main() {
  Model model;
  read_model(TAUT_SOURCE_DIR "/data/teapot.bpt", model);
  const Scene scene(model, {.threads = 1, .progress = {}});
  std::printf("Taut against point hulls of uniform tessellations of equal measured accuracy\n");
  compare(model, scene, 1e-3, 15);
  compare(model, scene, 1e-4, 9);
  compare(model, scene, 1e-5, 3);
}
