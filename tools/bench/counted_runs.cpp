// Runs whose instructions check.sh counts, by stage; one thread.
//
// Models and directions come from files, or from sums, products, quotients and square roots of a
// generator's bits, so that they are the same everywhere.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shapes.h"
#include "taut/bounds/support_query.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/subdivision/add_cage.h"
#include "teapot.h"

namespace taut_bench {

using namespace taut;  // NOLINT: a program

/// Prints the name of the stage that begins. It stays a function of its own, with this name: at
/// each of its calls check.sh has callgrind begin to count anew.
[[gnu::noinline]] void stage_begins(std::string_view stage) {
  std::printf("%.*s\n", int(stage.size()), stage.data());
}

/// What the runs are over: nothing after it belongs to a stage.
constexpr std::string_view end = "end";

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  /// In [-1, 1).
  double number() { return double(bits_() >> 11) * 0x1p-52 - 1; }

  /// In the unit ball.
  dvec3 point() {
    for (;;) {
      const double x = number();
      const double y = number();
      const dvec3 p(x, y, number());
      if (glm::dot(p, p) <= 1) return p;
    }
  }

  dvec3 direction() { return unit(point()); }

  dmat3 rotation() {
    const dvec3 a = direction();
    const dvec3 b = unit(glm::cross(a, direction()));
    return {a, b, glm::cross(a, b)};
  }

 private:
  std::mt19937_64 bits_;
};

Model model_of(Part part) {
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

Model model_of(const shapes::Shape& shape) {
  Part part;
  for (const NurbsSurface& surface : shape.surfaces) part.add_surface(surface, "face");
  for (const NurbsCurve& curve : shape.curves) part.add_curve(curve, "edge");
  return model_of(std::move(part));
}

/// As many teapots, in random poses in a ball whose radius is in diagonals of one: they overlap
/// loosely.
Model posed_teapots(int count, double radius) {
  Model model = teapot();
  const Box box = model.control_box();
  Random random(1);
  model.clear_instances();
  for (int k = 0; k < count; ++k) {
    RigidMotion pose;
    pose.rotation = random.rotation();
    pose.translation = radius * diagonal(box) * random.point() - pose.rotation * box.center();
    model.add_instance(0, pose);
  }
  return model;
}

/// The prism over an L with arms of 2 and widths of 1, one high.
ControlCage l_profile() {
  ControlCage cage;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
      cage.points.emplace_back(x, y, z);
    }
  }
  cage.faces = {{0, 3, 2, 1}, {0, 5, 4, 3}, {6, 7, 8, 9}, {6, 9, 10, 11}};
  for (int k = 0; k < 6; ++k) cage.faces.push_back({k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k});
  return cage;
}

/// The stages of a hull are the steps that it reports.
HullOptions counted_options() {
  HullOptions options;
  options.relative = 1e-4;
  options.threads = 1;
  options.progress.report = [last = std::string()](std::string_view step, double) mutable {
    if (step == last) return;
    last = step;
    stage_begins(step);
  };
  return options;
}

/// First the build, and the map: what stands before the steps that are reported.
void precise(const Model& model) {
  stage_begins("build");
  const Scene scene(model, {.threads = 1, .progress = {}});
  stage_begins("map");
  const Hull hull = precise_hull(scene, counted_options());
  stage_begins("measure");
  measure(scene, ContactGeometry(scene), *hull.boundary);
}

void cage() {
  stage_begins("subdivide");
  Part part;
  add_cage(part, l_profile(), "cage");
  precise(model_of(std::move(part)));
}

/// A closed smooth body with dents, in general position: blob(1) of tests/models.h, written out.
void blob() {
  Model model;
  read_model(TAUT_SOURCE_DIR "/tools/bench/blob.taut.json", model);
  precise(model);
}

void points(int count, bool on_sphere) {
  Random random(1);
  std::vector<dvec3> all;
  all.reserve(std::size_t(count));
  for (int k = 0; k < count; ++k) all.push_back(on_sphere ? random.direction() : random.point());
  stage_begins("build");
  Part part;
  part.add_points(all);
  convex_hull(model_of(std::move(part)), counted_options());
}

void sampled() {
  const Model model = teapot();
  stage_begins("build");
  const Scene scene(model, {.threads = 1, .progress = {}});
  sampled_hull(scene, counted_options());
}

/// Cold, and from the contacts of directions about 0.01 radians away.
void queries(int count) {
  const Scene& scene = teapot_scene();
  SupportQuery query(scene);
  Random random(1);
  std::vector<dvec3> directions;
  std::vector<Contact> contacts;
  while (int(directions.size()) < count) directions.push_back(random.direction());
  contacts.reserve(directions.size());
  stage_begins("cold");
  for (const dvec3& n : directions) contacts.push_back(query(n).contact);
  stage_begins("warm");
  for (std::size_t k = 0; k < directions.size(); ++k) {
    query(unit(directions[k] + 0.01 * random.point()), contacts[k]);
  }
}

struct Run {
  const char* name;
  void (*run)();
};

/// Ones that take long under valgrind, half a minute to two, come first, so that no core idles at
/// the end.
constexpr Run runs[] = {
    {"cage", cage},
    {"blob", blob},
    {"teapots_64", [] { precise(posed_teapots(64, 1.2)); }},
    {"teapot", [] { precise(teapot()); }},
    {"teapots_16", [] { precise(posed_teapots(16, 0.8)); }},
    {"torus", [] { precise(model_of(shapes::torus(2, 0.5))); }},
    {"oloid", [] { precise(model_of(shapes::oloid())); }},
    {"sampled", sampled},
    {"points", [] { points(100'000, false); }},
    {"points_on_sphere", [] { points(50'000, true); }},
    {"queries", [] { queries(10'000); }},
};

}  // namespace taut_bench

/// counted_runs: prints the compiler and the names of the runs, one a line.
/// counted_runs RUN: runs it, and prints the stages as they begin.
int main(int argc, char** argv) try {
  using namespace taut_bench;  // NOLINT: a program
  if (argc < 2) {
    std::puts(TAUT_COMPILER);
    for (const Run& run : runs) std::puts(run.name);
    return 0;
  }
  const auto* const named = std::find_if(std::begin(runs), std::end(runs), [&](const Run& run) {
    return std::strcmp(run.name, argv[1]) == 0;
  });
  if (named == std::end(runs)) {
    std::fprintf(stderr, "counted_runs: no run is named %s\n", argv[1]);
    return 2;
  }
  named->run();
  stage_begins(end);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "counted_runs: %s\n", e.what());
  return 1;
}
