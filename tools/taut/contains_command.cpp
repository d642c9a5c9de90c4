#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "directions.h"
#include "input.h"
#include "taut/containment/hull_containment.h"
#include "taut/containment/model_containment.h"
#include "text.h"

namespace taut::tool {
namespace {

struct ContainsOptions {
  InputArguments inputs;
  std::string points;
  std::string of = "hull";
  std::optional<double> on_tolerance;
};

/// Points answered between two looks at the progress.
constexpr std::size_t points_a_block = 16384;

const char* name_of(Location location) {
  switch (location) {
    case Location::inside:
      return "inside";
    case Location::on:
      return "on";
    default:
      return "outside";
  }
}

/// "inside -0.25"
std::string line_of(const SignedDistance& d, Location location) {
  return std::string(name_of(location)) + " " + number(d.value, 17) + "\n";
}

Json json_of(const dvec3& x, const SignedDistance& d, Location location) {
  return {{"point", {x.x, x.y, x.z}},
          {"location", name_of(location)},
          {"distance", d.value},
          {"distance_bounds", {d.lower, d.upper}}};
}

/// What the answers of one run add up to.
struct Answers {
  std::array<long, 3> counts = {};  ///< inside, on, outside
  ContainmentCounts took;
  Json points = Json::array();
  double seconds = 0;
};

/// Asks of all points, in blocks, and prints the lines unless JSON is wanted.
template <class Containment>
Answers answer(const Containment& containment, const std::vector<dvec3>& points, Console& console) {
  Answers answers;
  const Progress progress = console.progress();
  const double tolerance = containment.on_tolerance();
  for (std::size_t begin = 0; begin < points.size(); begin += points_a_block) {
    progress.update("contains", double(begin) / double(points.size()));
    const std::size_t count = std::min(points_a_block, points.size() - begin);
    const std::span<const dvec3> block(points.data() + begin, count);
    const Stopwatch watch;
    const auto distances = containment.distances(block, &answers.took);
    answers.seconds += watch.seconds();
    std::string lines;
    for (std::size_t i = 0; i < count; ++i) {
      const Location location = distances[i].location(tolerance);
      ++answers.counts[std::size_t(location)];
      if (console.options().json) {
        answers.points.push_back(json_of(block[i], distances[i], location));
      } else {
        lines += line_of(distances[i], location);
      }
    }
    console.print(lines);
  }
  return answers;
}

/// What stands for a cage's limit surface where that cannot touch the hull counts for the model.
void warn_of_stand_ins(const Model& model, Console& console) {
  long faces = 0;
  for (const Part& part : model.parts()) {
    for (const CageOfPart& cage : part.cages()) {
      faces += cage.irregular_faces - cage.refined_faces;
    }
  }
  if (faces == 0) return;
  console.warn("cage-stand-ins",
               counted(faces, "face", "faces") +
                   " of cages cannot touch the hull; OpenSubdiv's end caps stand for their surface "
                   "near extraordinary vertices");
}

ExitCode run(const ContainsOptions& options, Console& console) {
  const Progress progress = console.progress();
  const auto& files = options.inputs.files;
  if (options.points == "-" && std::find(files.begin(), files.end(), "-") != files.end()) {
    throw UsageError("standard input cannot be both the model and the points");
  }
  if (options.points == "-") console.note("reads points from standard input");
  const auto points = read_points(options.points, progress.stop);
  Input input(options.inputs, console);
  const Scene& scene = input.scene();
  const double tolerance = options.on_tolerance.value_or(-1);
  const int threads = console.options().threads;

  Answers answers;
  double used_tolerance = 0;
  const Stopwatch watch;
  if (options.of == "hull") {
    HullContainmentOptions own;
    own.on_tolerance = tolerance;
    own.threads = threads;
    own.progress = progress;
    const HullContainment hull(scene, own);
    used_tolerance = hull.on_tolerance();
    answers = answer(hull, points, console);
  } else {
    warn_of_stand_ins(input.model(), console);
    ModelContainmentOptions own;
    own.on_tolerance = tolerance;
    own.threads = threads;
    own.progress = progress;
    const ModelContainment model(scene, own);
    used_tolerance = model.on_tolerance();
    answers = answer(model, points, console);
  }
  if (!console.options().json) return ExitCode::done;
  console.print(text(Json{{"taut", TAUT_VERSION},
                          {"input", to_json(input.summary())},
                          {"of", options.of},
                          {"on_tolerance", used_tolerance},
                          {"inside", answers.counts[0]},
                          {"on", answers.counts[1]},
                          {"outside", answers.counts[2]},
                          {"points", std::move(answers.points)},
                          {"queries", {{"support", answers.took.support_queries}}},
                          {"seconds",
                           {{"read", input.seconds_read()},
                            {"build", input.seconds_build()},
                            {"prepare", watch.seconds() - answers.seconds},
                            {"contains", answers.seconds},
                            {"total", console.seconds()}}},
                          {"peak_bytes", peak_bytes()},
                          {"warnings", to_json(console.warnings())}}));
  return ExitCode::done;
}

}  // namespace

Command add_contains(CLI::App& parent) {
  Command command =
      add_command(parent, "contains", "Inside, on or outside for each point",
                  "Prints a line for each point: inside, on or outside, and its distance from the\n"
                  "boundary, negative inside. inside and outside are proven; on: not proven to be\n"
                  "farther from the boundary than the tolerance.\n\n"
                  "Examples:\n"
                  "  taut contains teapot.bpt --points points.txt            of the convex hull\n"
                  "  taut contains torus.taut.json --points points.txt --of model\n"
                  "  echo 0 0 1 | taut contains teapot.bpt --points -");
  const auto options = std::make_shared<ContainsOptions>();
  add_inputs(*command.app, options->inputs);
  command.app
      ->add_option(
          "--points", options->points,
          "One point a line: three numbers, apart by blanks, commas or semicolons;\n'#' begins a "
          "comment; - is standard input")
      ->required()
      ->type_name("FILE");
  command.app
      ->add_option("--of", options->of,
                   "The convex hull (default), or the model itself, which must be closed")
      ->check(CLI::IsMember({"hull", "model"}).description(""))
      ->type_name("hull|model");
  add_positive(*command.app, "--on-tolerance", options->on_tolerance,
               "Points nearer to the boundary are on it, in model units; default\n1e-13 of the "
               "diagonal")
      ->type_name("T");
  command.run = [options](Console& console) { return run(*options, console); };
  return command;
}

}  // namespace taut::tool
