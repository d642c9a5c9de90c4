// Evaluation, CBVH and Gauss map build, memory and convergence, and support queries, on the teapot;
// one thread.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "random_directions.h"
#include "taut/bounds/coons_bvh.h"
#include "taut/bounds/gauss_map.h"
#include "taut/bounds/support_query.h"
#include "teapot.h"

namespace {

using namespace taut;

SupportBounds bounds_of(const benchmark::State& state) {
  return state.range(0) == 0 ? SupportBounds::bezier_nets : SupportBounds::coons;
}

void evaluate_second_derivatives(benchmark::State& state) {
  const BezierPatch patch = teapot().parts()[0].patches()[0].bezier;
  double u = 0.1;
  for (auto _ : state) {
    u = u < 0.9 ? u + 1e-3 : 0.1;
    benchmark::DoNotOptimize(jet2(patch, u, 1 - u));
  }
}
BENCHMARK(evaluate_second_derivatives);

void evaluate_point(benchmark::State& state) {
  const BezierPatch patch = teapot().parts()[0].patches()[0].bezier;
  double u = 0.1;
  for (auto _ : state) {
    u = u < 0.9 ? u + 1e-3 : 0.1;
    benchmark::DoNotOptimize(point(patch, u, 1 - u));
  }
}
BENCHMARK(evaluate_point);

void build_scene(benchmark::State& state) {
  const Model model = teapot();
  std::size_t bytes = 0;
  for (auto _ : state) {
    const Scene scene(model, {.threads = 1, .progress = {}});
    bytes = scene.memory();
  }
  state.counters["bytes/patch"] = double(bytes) / model.patch_count();
}
BENCHMARK(build_scene)->Unit(benchmark::kMillisecond);

/// Argument: the levels.
void build_gauss_map(benchmark::State& state) {
  std::size_t bytes = 0;
  std::size_t nodes = 0;
  for (auto _ : state) {
    const GaussMap map(teapot_scene(),
                       {.levels = int(state.range(0)), .threads = 1, .progress = {}});
    bytes = map.memory();
    nodes = map.nodes(0).size();
  }
  state.counters["nodes"] = double(nodes);
  state.counters["bytes/patch"] = double(bytes) / teapot_scene().model().patch_count();
}
BENCHMARK(build_gauss_map)->DenseRange(2, 4)->Unit(benchmark::kMillisecond);

/// Argument: the decimal exponent of the Coons tolerance relative to the patch.
void build_cbvh(benchmark::State& state) {
  const BezierPatch patch = teapot().parts()[0].patches()[0].bezier;
  const double tolerance = std::pow(10.0, double(-state.range(0)));
  std::size_t bytes = 0;
  int leaves = 0;
  for (auto _ : state) {
    const CoonsBvh bvh(patch, tolerance);
    bytes = bvh.memory();
    leaves = bvh.leaf_count();
  }
  state.counters["leaves"] = leaves;
  state.counters["bytes/leaf"] = double(bytes) / leaves;
}
BENCHMARK(build_cbvh)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);

/// The largest bilinear deviation and Coons distance of the cells of one level, and by what factor
/// they fell since the level above. Argument: the level.
void cbvh_convergence(benchmark::State& state) {
  const BezierPatch patch = teapot().parts()[0].patches()[0].bezier;
  const auto largest = [&](long level, bool coons) {
    double result = 0;
    const double size = std::exp2(-double(level));
    for (double u = 0; u < 1; u += size) {
      for (double v = 0; v < 1; v += size) {
        // A tolerance that every patch meets makes the root the leaf: its distance is asked.
        const CoonsBvh bvh(restricted(patch, {u, u + size}, {v, v + size}), 1e9);
        result =
            std::max(result, coons ? bvh.coons_distance(bvh.root()) : bvh.deviation(bvh.root()));
      }
    }
    return result;
  };
  double bilinear = 0;
  double coons = 0;
  for (auto _ : state) {
    bilinear = largest(state.range(0), false);
    coons = largest(state.range(0), true);
  }
  state.counters["bilinear"] = bilinear;
  state.counters["bilinear_factor"] = largest(state.range(0) - 1, false) / bilinear;
  state.counters["coons"] = coons;
  state.counters["coons_factor"] = largest(state.range(0) - 1, true) / coons;
}
BENCHMARK(cbvh_convergence)->DenseRange(1, 5)->Iterations(1);

void support_cold(benchmark::State& state) {
  SupportQuery query(teapot_scene(), {}, bounds_of(state));
  const auto directions = random_directions(4096, 1);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(query(directions[k++ % directions.size()]));
  state.counters["cells"] = double(query.cells()) / double(query.queries());
}
BENCHMARK(support_cold)->ArgName("coons")->Arg(0)->Arg(1);

/// From the contact of a direction about 0.01 radians away.
void support_warm(benchmark::State& state) {
  SupportQuery query(teapot_scene(), {}, bounds_of(state));
  const auto directions = random_directions(4096, 1);
  const auto offsets = random_directions(4096, 2);
  std::vector<Contact> contacts;
  std::vector<dvec3> near;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    contacts.push_back(query(directions[k]).contact);
    near.push_back(unit(directions[k] + 0.01 * offsets[k]));
  }
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(query(near[k], contacts[k]));
    k = (k + 1) % near.size();
  }
}
BENCHMARK(support_warm)->ArgName("coons")->Arg(0)->Arg(1);

}  // namespace
