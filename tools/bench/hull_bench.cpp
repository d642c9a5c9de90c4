// The hull of the teapot, one thread: its build, exact structure and mesh; then the meshes against
// the honest alternative: a uniform tessellation of the same measured accuracy, and the hull of its
// points by CGAL and Qhull. The programs take turns within one run, and the medians of the paired
// ratios are printed. With --benchmark_filter only the benchmarks that it names are run.
//
// The peers are given their points: tessellating, and finding the resolution that a wanted accuracy
// needs, is not counted.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "peers.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"
#include "teapot.h"

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

HullOptions options_for(double relative) {
  HullOptions options;
  options.relative = relative;
  options.threads = 1;
  return options;
}

/// What stands before the structure: hierarchies.
void build(benchmark::State& state) {
  const Model model = teapot();
  for (auto _ : state) {
    const Scene scene(model, {.threads = 1, .progress = {}});
    benchmark::DoNotOptimize(&scene);
  }
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

/// The exact boundary, with the milliseconds of its phases.
void structure(benchmark::State& state) {
  HullStatistics statistics;
  HullBoundary boundary;
  for (auto _ : state) {
    boundary = exact_boundary(teapot_scene(), options_for(1e-4), statistics);
  }
  const auto milliseconds = [](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["cull_ms"] = milliseconds(statistics.seconds_map);
  state.counters["trace_ms"] = milliseconds(statistics.seconds_trace);
  state.counters["stitch_ms"] = milliseconds(statistics.seconds_stitch);
  state.counters["queries"] =
      benchmark::Counter(double(statistics.support_queries), benchmark::Counter::kAvgIterations);
  state.counters["newton"] =
      benchmark::Counter(double(statistics.newton_iterations), benchmark::Counter::kAvgIterations);
  state.counters["faces"] = double(boundary.faces.size());
  state.counters["curves"] = double(boundary.curves.size());
  state.counters["unresolved"] = double(boundary.unresolved.size());
}
BENCHMARK(structure)->Unit(benchmark::kMillisecond);

/// All of the precise hull but the scene. Argument: the decimal exponent of the tolerance.
void precise_mesh(benchmark::State& state) {
  const HullOptions options = options_for(std::pow(10.0, double(-state.range(0))));
  Hull hull;
  for (auto _ : state) hull = precise_hull(teapot_scene(), options);
  state.counters["mesh_ms"] = 1e3 * hull.statistics.seconds_mesh;
  state.counters["faces"] = double(hull.mesh.n_faces());
  state.counters["bound"] = hull.distance_bound / teapot_scene().diagonal();
}
BENCHMARK(precise_mesh)->DenseRange(3, 5)->Unit(benchmark::kMillisecond);

void measure_boundary(benchmark::State& state) {
  HullStatistics statistics;
  const HullBoundary boundary = exact_boundary(teapot_scene(), options_for(1e-4), statistics);
  const ContactGeometry geometry(teapot_scene());
  BoundaryMeasures measures;
  for (auto _ : state) measures = measure(teapot_scene(), geometry, boundary);
  state.counters["accuracy"] = measures.accuracy;
}
BENCHMARK(measure_boundary)->Unit(benchmark::kMillisecond);

void compare(const Model& model, const Scene& scene, double relative, int runs) {
  const HullOptions options = options_for(relative);
  const auto method = [&](const char* name, Hull (*hull)(const Scene&, const HullOptions&)) {
    return Method{name, [&model, options, hull] {
                    const Scene fresh(model, {.threads = 1, .progress = {}});
                    return long(hull(fresh, options).mesh.n_faces());
                  }};
  };
  std::printf("\naccuracy %g of the diagonal; scene build included\n", relative);
  compare_with_peers(tessellation_of_accuracy(model, scene, relative * scene.diagonal()), runs,
                     {method("taut precise", precise_hull), method("taut sampled", sampled_hull)});
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  if (!benchmark::GetBenchmarkFilter().empty()) return 0;
  const Model model = teapot();
  std::printf("\nTaut against point hulls of uniform tessellations of equal measured accuracy\n");
  compare(model, teapot_scene(), 1e-3, 15);
  compare(model, teapot_scene(), 1e-4, 9);
  compare(model, teapot_scene(), 1e-5, 3);
}
