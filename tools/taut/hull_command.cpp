#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "hull_arguments.h"
#include "hull_outputs.h"
#include "hull_report.h"
#include "hull_summary.h"
#include "input.h"
#include "output.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/envelope/trace_envelope.h"
#include "taut/hull/polyhedral/polyhedral_hull.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/io/mesh/write_mesh.h"
#include "text.h"

namespace taut::tool {
namespace {

constexpr double default_relative = 1e-4;
/// Of a budget.
constexpr int fewest_vertices = 4;
constexpr int limit_of_vertices = std::numeric_limits<int>::max();

/// What can be told from the command line alone.
OutputPlaces check(const HullArguments& arguments, bool json) {
  for (const std::string& file : arguments.outputs) {
    const std::string format = arguments.format_of(file);
    if (arguments.method == "precise" || !is_document(format)) continue;
    std::string message = file;
    message += ": a " + format + " holds the exact hull, which --method ";
    message += arguments.method + " does not find: give --method precise";
    throw UsageError(message);
  }
  if (arguments.outputs.empty() && arguments.report.empty() && !json) {
    throw UsageError("nothing to write: give -o FILE, --report FILE or --json");
  }
  const auto on_stdout = std::count(arguments.outputs.begin(), arguments.outputs.end(), "-") +
                         (json ? 1 : 0) + (arguments.report == "-" && !json ? 1 : 0);
  if (on_stdout > 1) throw UsageError("only one thing can be written to standard output");
  return check_outputs(arguments.outputs, arguments.format_of("-"), arguments.report,
                       arguments.inputs.files);
}

/// In model units; 0 where there is none but a budget of vertices.
double tolerance(const HullArguments& arguments, double diagonal) {
  if (arguments.tolerance) return *arguments.tolerance;
  if (arguments.max_vertices && !arguments.relative) return 0;
  const double relative = arguments.relative.value_or(default_relative);
  // A single point has no diagonal; any tolerance serves it.
  if (!(diagonal > 0)) return relative;
  const double tolerance = relative * diagonal;
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    throw UsageError("--relative " + number(relative, 17) + " of the diagonal " +
                     number(diagonal, 17) + " is no number that a double holds");
  }
  return tolerance;
}

/// What of the tolerance is the mesh's: what patches that stand for others miss, and what files of
/// floats round, is left to these, rounded so that the sum is within it, unless it is too much for
/// both.
double mesh_tolerance(double tolerance, double others) {
  if (others == 0 || others > tolerance / 2) return tolerance;
  return std::nextafter(tolerance - others, 0.0);
}

/// How far the files that hold floats may move vertices of the model's hull; 0 if there are none.
double rounding_of_files(const HullArguments& arguments, Input& input) {
  const bool any =
      std::any_of(arguments.outputs.begin(), arguments.outputs.end(),
                  [&](const std::string& file) { return arguments.format_of(file) == ".stl"; });
  return any ? float_rounding_bound(input.model().control_box()) : 0;
}

Hull hull_of_images(const Scene& scene, int size, const HullOptions& options) {
  const Stopwatch watch;
  const EnvelopeImages images(
      scene, {.size = size, .threads = options.threads, .progress = options.progress});
  const EnvelopeMap map = trace_envelope(images, options.progress);
  const double seconds = watch.seconds();
  Hull hull = envelope_hull(images, map, options);
  hull.statistics.seconds_sample += seconds;
  return hull;
}

/// The hull of points and polygons; where that has more vertices than the budget, the best of as
/// many, all faces of which are facets.
Outcome polyhedral(Input& input, const HullOptions& options, Console& console) {
  const auto whole = std::make_shared<const Hull>(polyhedral_hull(input.model(), options));
  if (long(whole->mesh.n_vertices()) <= options.vertex_budget.value_or(limit_of_vertices)) {
    return {whole, {}, {}};
  }
  Outcome outcome{{}, whole, {}};
  Hull hull;
  try {
    hull = sampled_hull(input.scene(), options);
  } catch (const HullNotConverged& failure) {
    hull = *failure.best;
    outcome.failure = failure.what();
  } catch (const HullLimitExceeded& met) {
    console.lift_limits();
    hull = *met.best;
    outcome.failure = met.what();
    outcome.met_limit = true;
  } catch (const LimitMet& met) {
    console.lift_limits();
    return {whole, {}, met.what(), true};
  }
  for (const auto f : hull.mesh.faces()) hull.mesh.data(f).kind = FaceKind::facet;
  outcome.hull = std::make_shared<const Hull>(std::move(hull));
  return outcome;
}

Outcome compute(Input& input, const HullArguments& arguments, const HullOptions& options,
                Console& console) {
  const std::string& method = arguments.method;
  try {
    if (method != "envelope" && input.model().polyhedral()) {
      return polyhedral(input, options, console);
    }
    Hull hull = method == "envelope"  ? hull_of_images(input.scene(), arguments.size, options)
                : method == "precise" ? precise_hull(input.scene(), options)
                                      : sampled_hull(input.scene(), options);
    return {std::make_shared<const Hull>(std::move(hull)), {}, {}};
  } catch (const HullNotConverged& failure) {
    return {failure.best, {}, failure.what()};
  } catch (const HullLimitExceeded& met) {
    console.lift_limits();
    return {met.best, {}, met.what(), true};
  }
}

/// Refuses a tolerance that no mesh can be proven to keep. @throws UsageError
void check_reachable(double wanted, Input& input) {
  if (wanted == 0 || input.model().polyhedral() || trimmed_face_count(input.model()) > 0) return;
  const double least = least_tolerance(input.scene());
  if (wanted >= least) return;
  // Rounded to three digits it is no less.
  const double above = 1.006 * least;
  throw UsageError("the tolerance " + number(wanted, 3) +
                   " is below what double precision can prove of this model; the least is " +
                   number(above, 3) + ", --relative " + number(above / input.diagonal(), 3));
}

/// What is asked of the toolkit; `wanted`: the tolerance in model units, 0: none.
HullOptions options_for(const HullArguments& arguments, double wanted, Input& input,
                        Console& console) {
  HullOptions options;
  const double others = input.model().deviation_bound() + rounding_of_files(arguments, input);
  options.tolerance = wanted > 0 ? mesh_tolerance(wanted, others) : 0;
  options.resolution = arguments.resolution;
  options.threads = console.options().threads;
  options.vertex_budget = arguments.max_vertices;
  options.progress = console.progress();
  return options;
}

/// Why a mesh within its own tolerance is not within the one asked for: the patches of cages miss
/// too much of their limit surfaces. `bound`: the distance of the mesh, with that.
std::optional<std::string> failure_of_cages(double bound, double deviation, double tolerance) {
  if (deviation == 0 || tolerance == 0 || bound <= tolerance) return {};
  return "the tolerance " + number(tolerance, 3) +
         " was not reached: the limit surfaces of the cages are known to " + number(deviation, 3) +
         " only";
}

/// The file that rounds vertices most.
Report::Mesh::File worst_rounding(const Report& report) {
  Report::Mesh::File worst;
  for (const Report::Mesh::File& file : report.mesh.files) {
    if (file.rounding > worst.rounding) worst = file;
  }
  return worst;
}

/// Why a mesh within the tolerance is not so in a file of floats.
std::optional<std::string> failure_of_floats(const Report& report) {
  const Report::Mesh::File worst = worst_rounding(report);
  const bool any = worst.rounding > 0 && report.mesh.tolerance > 0;
  if (!any || report.mesh.distance_bound + worst.rounding <= report.mesh.tolerance) return {};
  return "the tolerance " + number(report.mesh.tolerance, 3) + " was not reached: " + worst.file +
         " holds floats, which move vertices by up to " + number(worst.rounding, 3) +
         "; .ply holds doubles";
}

/// What a run that ends too early throws, with what was written, how far off that is, and how near
/// it was to be (`wanted`, 0: none).
[[noreturn]] void fail(const Outcome& outcome, bool written, double bound, double wanted) {
  const std::string text = *outcome.failure + ": the hull " + (written ? "written" : "found") +
                           " is within " + number(bound, 3) + " of the true one";
  if (outcome.met_limit) throw LimitExceeded(text);
  throw NotConverged(wanted > 0 ? text + ", " + number(wanted, 3) + " was asked for" : text, bound);
}

/// The failures of outputs, one line each, after which the run fails: the last is thrown.
void fail_if_not_written(const std::vector<std::string>& failures, Console& console) {
  if (failures.empty()) return;
  for (std::size_t i = 0; i + 1 < failures.size(); ++i) console.error(failures[i]);
  throw IoError(failures.back());
}

/// Prints what a run found, as far as standard output is free for it.
void print_result(const HullArguments& arguments, const Report& report, const Written& written,
                  Console& console) {
  const auto& outputs = arguments.outputs;
  const bool mesh_on_stdout = std::find(outputs.begin(), outputs.end(), "-") != outputs.end();
  if (console.options().json || arguments.report == "-") {
    console.print(taut::to_json(report));
  } else if (!console.options().quiet && !mesh_on_stdout && !written.files.empty()) {
    console.print(summary(report, written.files));
  }
}

/// @throws LimitExceeded also where a limit is met before there is a hull
ExitCode run_within_limits(const HullArguments& arguments, const OutputPlaces& places,
                           Console& console) {
  Input input(arguments.inputs, console);
  const double wanted = tolerance(arguments, input.diagonal());
  check_reachable(wanted, input);
  Outcome outcome =
      compute(input, arguments, options_for(arguments, wanted, input, console), console);
  Report report = make_report(input, outcome, arguments, wanted, console);
  console.lift_limits();
  const double deviation = input.model().deviation_bound();
  if (!outcome.failure) {
    outcome.failure = failure_of_cages(report.mesh.distance_bound, deviation, wanted);
  }
  bring_up_to_date(report, outcome, console);
  Written written = write_outputs(arguments, places, input, outcome, report, console);
  console.progress().check();
  if (!outcome.failure) outcome.failure = failure_of_floats(report);
  bring_up_to_date(report, outcome, console);
  for (const std::string& failure : written.failures) {
    report.warnings.push_back({"not-written", failure});
  }
  write_report(arguments, places, report, written);

  print_result(arguments, report, written, console);
  const bool is_whole = written.failures.empty();
  if (outcome.failure && is_whole) {
    fail(outcome, written.any_hull, report.mesh.distance_bound + worst_rounding(report).rounding,
         wanted);
  }
  if (outcome.failure) console.error(*outcome.failure);
  fail_if_not_written(written.failures, console);
  return ExitCode::done;
}

ExitCode run(const HullArguments& arguments, Console& console) {
  const OutputPlaces places = check(arguments, console.options().json);
  console.limit(arguments.max_seconds, arguments.max_memory);
  try {
    return run_within_limits(arguments, places, console);
  } catch (const LimitExceeded& error) {
    // They are lifted from when there is a hull on; readers tell of other limits as well.
    if (!console.progress().stop.stop_requested()) throw;
    throw LimitExceeded(std::string(error.what()) + " before there was a hull; nothing is written");
  }
}

}  // namespace

Command add_hull(CLI::App& parent) {
  Command command = add_command(
      parent, "hull", "Convex hull of all inputs together",
      "Examples:\n"
      "  taut hull teapot.bpt -o hull.ply\n"
      "  taut hull teapot.bpt -o hull.ply -o hull.stl --relative 1e-5 --report report.json\n"
      "  taut hull teapot.bpt -o teapot.hull.json     the exact hull: patches, scrolls, facets\n"
      "  taut hull a.bpt b.obj --tolerance 0.01 --json\n"
      "  taut hull cage.obj --scheme catmark -o hull.ply   of the subdivision surface\n"
      "  taut hull scan.xyz -o hull.ply              points and triangles: the exact hull\n"
      "  taut hull car.obj -o hull.ply --max-seconds 60   the best that a minute brings");
  const auto arguments = std::make_shared<HullArguments>();
  CLI::App& app = *command.app;
  add_inputs(app, arguments->inputs);
  app.add_option("-o,--output", arguments->outputs,
                 "What to write: a mesh (.ply .obj .off .stl), the exact hull\n(.hull.json "
                 ".hull.cbor), or a "
                 "MeshLab project with its layers\nbeside it (.mlp); may be repeated; - is "
                 "standard output, "
                 "see\n--to")
      ->allow_extra_args(false)
      ->type_name("FILE");
  app.add_option(
         "--method", arguments->method,
         "precise (default): the exact hull, and a mesh of it; sampled: a\nmesh through points of "
         "the model; envelope: a mesh through contacts that envelope images\nshow")
      ->check(CLI::IsMember({"sampled", "precise", "envelope"}).description(""))
      ->type_name("precise|sampled|envelope");
  CLI::Option* relative =
      add_positive(
          app, "--relative", arguments->relative,
          "Largest distance of the mesh from the true hull, as a fraction of\nthe diagonal "
          "of the model's box; default 1e-4")
          ->type_name("R");
  add_positive(app, "--tolerance", arguments->tolerance,
               "The same in model units; not with --relative")
      ->type_name("T")
      ->excludes(relative);
  add_resolution(app, arguments->resolution);
  add_integer(app, "--max-vertices", arguments->max_vertices, fewest_vertices, limit_of_vertices,
              "A budget: at most so many vertices, 4 or more, and the best mesh for\nthem; with "
              "--relative or --tolerance no more than that takes, and exit\ncode 5 where that is "
              "not reached");
  add_positive(app, "--max-seconds", arguments->max_seconds,
               "Seconds of the whole run after which the best hull found until then\nis written, "
               "with exit code 6; nothing is written before there is one")
      ->type_name("S");
  add_memory(app, "--max-memory", arguments->max_memory,
             "Memory that the command may hold before it ends so, in bytes or\nwith a unit: 500M, "
             "2G");
  add_integer(app, "--size", arguments->size, 8, 16000,
              "Width and height in pixels of the images of --method envelope,\ndefault " +
                  number(long(arguments->size)))
      ->type_name("N");
  add_output_format(app, arguments->inputs);
  app.add_option("--report", arguments->report, "JSON report to write; - is stdout")
      ->type_name("FILE");
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool
