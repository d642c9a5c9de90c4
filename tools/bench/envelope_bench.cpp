// Culling of what the envelope does not show; envelope images of the teapot against their size, and
// how many triangles a second the driver draws. The driver draws with all cores, or as many threads
// as LP_NUM_THREADS says (0: none but the caller's); everything else here with one.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "random_directions.h"
#include "taut/bounds/gauss_map.h"
#include "taut/envelope/cull/culling.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/envelope/offscreen_canvas.h"
#include "taut/envelope/trace_envelope.h"
#include "teapot.h"

namespace {

using namespace taut;  // NOLINT: a program

EnvelopeImages teapot_images(int size) {
  return EnvelopeImages(teapot_scene(), {.size = size, .threads = 1, .progress = {}});
}

/// Argument: the finest level.
void cull_cells(benchmark::State& state) {
  const GaussMap map(teapot_scene(), {.threads = 1, .progress = {}});
  Culling culling;
  for (auto _ : state) {
    culling =
        cull(teapot_scene(), map, {.levels = int(state.range(0)), .threads = 1, .progress = {}});
  }
  const CullingLevel& last = culling.levels.back();
  state.counters["visited"] = double(culling.visited());
  state.counters["mixed"] = double(culling.mixed());
  state.counters["queries"] = double(culling.support_queries);
  state.counters["removed"] = last.removed_share;
  state.counters["decided"] = last.decided_share;
}
BENCHMARK(cull_cells)->DenseRange(3, 5)->Unit(benchmark::kMillisecond);

/// Argument: the number of teapots, in random poses.
void cull_instances(benchmark::State& state) {
  Model model = teapot();
  model.clear_instances();
  const auto axes = random_directions(3 * std::size_t(state.range(0)), 3);
  for (std::size_t k = 0; k < axes.size(); k += 3) {
    const dvec3 a = axes[k];
    const dvec3 b = unit(glm::cross(a, axes[k + 1]));
    model.add_instance(0, {dmat3(a, b, glm::cross(a, b)), 30.0 * axes[k + 2]});
  }
  const Scene scene(model, {.threads = 1, .progress = {}});
  const GaussMap map(scene, {.threads = 1, .progress = {}});
  Culling culling;
  for (auto _ : state) culling = cull(scene, map, {.threads = 1, .progress = {}});
  state.counters["visited"] = double(culling.visited());
  state.counters["mixed"] = double(culling.mixed());
  state.counters["queries"] = double(culling.support_queries);
  state.counters["removed"] = culling.removed_share();
}
BENCHMARK(cull_instances)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// Both images. Argument: their size.
void images(benchmark::State& state) {
  EnvelopeStatistics sum;
  for (auto _ : state) {
    const EnvelopeImages images = teapot_images(int(state.range(0)));
    const EnvelopeStatistics& s = images.statistics();
    sum.triangles = s.triangles;
    sum.decided_pixels = s.decided_pixels;
    sum.seconds_triangles += s.seconds_triangles;
    sum.seconds_draw += s.seconds_draw;
    sum.seconds_decide += s.seconds_decide;
  }
  const auto milliseconds = [](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["triangles"] = double(sum.triangles);
  state.counters["decided"] = double(sum.decided_pixels);
  state.counters["triangles_ms"] = milliseconds(sum.seconds_triangles);
  state.counters["draw_ms"] = milliseconds(sum.seconds_draw);
  state.counters["decide_ms"] = milliseconds(sum.seconds_decide);
}
BENCHMARK(images)
    ->RangeMultiplier(2)
    ->Range(256, 4096)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Regions, curves and triple points, the images given. Argument: their size.
void trace(benchmark::State& state) {
  const EnvelopeImages images = teapot_images(int(state.range(0)));
  EnvelopeMap map;
  for (auto _ : state) map = trace_envelope(images);
  state.counters["curves"] = double(map.curves.size());
  state.counters["triple_points"] = double(map.triple_points.size());
}
BENCHMARK(trace)->RangeMultiplier(2)->Range(256, 4096)->Unit(benchmark::kMillisecond);

/// The hull of the images, these given. Arguments: their size, the decimal exponent of the
/// tolerance.
void hull(benchmark::State& state) {
  const EnvelopeImages images = teapot_images(int(state.range(0)));
  const EnvelopeMap map = trace_envelope(images);
  HullOptions options;
  options.relative = std::pow(10.0, double(-state.range(1)));
  options.threads = 1;
  Hull result;
  for (auto _ : state) result = envelope_hull(images, map, options);
  state.counters["faces"] = double(result.mesh.n_faces());
  state.counters["bound"] = result.distance_bound / teapot_scene().diagonal();
}
BENCHMARK(hull)
    ->Args({256, 3})
    ->Args({256, 4})
    ->Args({1024, 3})
    ->Args({1024, 4})
    ->Args({1024, 5})
    ->Unit(benchmark::kMillisecond);

/// A million triangles of some three pixels, in random places, drawn once. Argument: the size.
void million_triangles(benchmark::State& state) {
  constexpr std::size_t count = 1000000;
  const int size = int(state.range(0));
  OffscreenCanvas canvas(size);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> place(-1, 1);
  std::vector<OffscreenCanvas::Vertex> vertices;
  vertices.reserve(3 * count);
  const float step = 2.5F * 2 / float(size);
  for (std::uint32_t k = 0; k < count; ++k) {
    const float x = place(random);
    const float y = place(random);
    const float z = place(random);
    vertices.push_back({x, y, {0, 0, z}, {1, 0}, {0, 0, 0}, k, k});
    vertices.push_back({x + step, y, {0, 0, z}, {0, 1}, {0, 0, 0}, k, k});
    vertices.push_back({x, y + step, {0, 0, z}, {0, 0}, {0, 0, 0}, k, k});
  }
  canvas.begin(1, 1, 2);
  canvas.add(vertices);
  for (auto _ : state) benchmark::DoNotOptimize(canvas.draw_first());
  state.counters["triangles"] =
      benchmark::Counter(double(count), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(million_triangles)
    ->RangeMultiplier(2)
    ->Range(1024, 4096)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
