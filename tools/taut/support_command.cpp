#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "command.h"
#include "directions.h"
#include "input.h"
#include "taut/bounds/model_support.h"
#include "taut/core/parallel.h"
#include "text.h"

namespace taut::tool {
namespace {

struct SupportOptions {
  InputArguments inputs;
  std::string directions;
};

/// Directions answered between two looks at the progress, and by one thread at a time.
constexpr std::size_t directions_a_block = 16384;
constexpr std::size_t grain = 256;

/// How many parameters a contact has.
int parameter_count(SourceKind kind) {
  return kind == SourceKind::face ? 2 : kind == SourceKind::edge ? 1 : 0;
}

const char* name_of(SourceKind kind) {
  return kind == SourceKind::face ? "face" : kind == SourceKind::edge ? "edge" : "vertex";
}

/// "h x y z source u v"
std::string line_of(const ModelSupport& s) {
  const int parameters = parameter_count(s.contact.kind);
  std::string line;
  for (const double value : {s.h, s.point.x, s.point.y, s.point.z}) line += number(value, 17) + " ";
  line += number(long(s.contact.source));
  line += " " + (parameters > 0 ? number(s.contact.u, 17) : "-");
  line += " " + (parameters > 1 ? number(s.contact.v, 17) : "-");
  return line + "\n";
}

Json json_of(const dvec3& direction, const ModelSupport& s) {
  const int parameters = parameter_count(s.contact.kind);
  const dvec3 n = unit(direction);
  return {{"n", {n.x, n.y, n.z}},
          {"h", s.h},
          {"h_bound", s.h_bound},
          {"point", {s.point.x, s.point.y, s.point.z}},
          {"source", s.contact.source},
          {"kind", name_of(s.contact.kind)},
          {"u", parameters > 0 ? Json(s.contact.u) : Json()},
          {"v", parameters > 1 ? Json(s.contact.v) : Json()}};
}

struct Counts {
  std::atomic<long> queries = 0;
  std::atomic<long> newton_iterations = 0;
};

/// The answers for a block of directions, in order.
std::vector<ModelSupport> answer(const Scene& scene, const std::vector<dvec3>& directions,
                                 std::size_t begin, int threads, Counts& counts) {
  std::vector<ModelSupport> answers(std::min(directions_a_block, directions.size() - begin));
  parallel_for(answers.size(), grain, threads, [&](std::size_t first, std::size_t last) {
    SupportQuery query(scene);
    for (std::size_t i = first; i < last; ++i) {
      answers[i] = support(query, scene, directions[begin + i]);
    }
    counts.queries += query.queries();
    counts.newton_iterations += query.newton_iterations();
  });
  return answers;
}

ExitCode run(const SupportOptions& options, Console& console) {
  const bool json = console.options().json;
  const Progress progress = console.progress();
  const auto& files = options.inputs.files;
  if (options.directions == "-" && std::find(files.begin(), files.end(), "-") != files.end()) {
    throw UsageError("standard input cannot be both the model and the directions");
  }
  if (options.directions == "-") console.note("reads directions from standard input");
  const auto directions = read_directions(options.directions, progress.stop);
  Input input(options.inputs, console);
  const Scene& scene = input.scene();
  Counts counts;
  Json answers = Json::array();
  double seconds = 0;
  for (std::size_t begin = 0; begin < directions.size(); begin += directions_a_block) {
    progress.update("support", double(begin) / double(directions.size()));
    const Stopwatch watch;
    const auto block = answer(scene, directions, begin, console.options().threads, counts);
    seconds += watch.seconds();
    std::string lines;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (json) {
        answers.push_back(json_of(directions[begin + i], block[i]));
      } else {
        lines += line_of(block[i]);
      }
    }
    console.print(lines);
  }
  if (json) {
    console.print(text(Json{{"taut", TAUT_VERSION},
                            {"input", to_json(input.summary())},
                            {"support", std::move(answers)},
                            {"queries",
                             {{"support", counts.queries.load()},
                              {"newton_iterations", counts.newton_iterations.load()}}},
                            {"seconds",
                             {{"read", input.seconds_read()},
                              {"build", input.seconds_build()},
                              {"support", seconds},
                              {"total", console.seconds()}}},
                            {"peak_bytes", peak_bytes()},
                            {"warnings", to_json(console.warnings())}}));
  }
  return ExitCode::done;
}

}  // namespace

Command add_support(CLI::App& parent) {
  Command command = add_command(
      parent, "support", "Support value and contact for each direction",
      "Prints a line for each direction: h x y z source u v. h is the largest x.n over the\n"
      "model for the unit vector n along the direction, x y z a point where it is attained,\n"
      "source and u v where that lies (an edge has one parameter, a vertex none: -).\n\n"
      "Examples:\n"
      "  taut support teapot.bpt --directions directions.txt\n"
      "  echo 0 0 1 | taut support teapot.bpt --directions -");
  const auto options = std::make_shared<SupportOptions>();
  add_inputs(*command.app, options->inputs);
  command.app
      ->add_option("--directions", options->directions,
                   "One direction a line: three numbers, apart by blanks, commas or\nsemicolons, "
                   "need not be "
                   "unit; '#' begins a comment; - is standard\ninput")
      ->required()
      ->type_name("FILE");
  command.run = [options](Console& console) { return run(*options, console); };
  return command;
}

}  // namespace taut::tool
