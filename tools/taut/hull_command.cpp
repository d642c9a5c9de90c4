#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "input.h"
#include "output.h"
#include "standard_input.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measures.h"
#include "taut/io/report.h"
#include "taut/io/write_mesh.h"
#include "text.h"

namespace taut::tool {
namespace {

constexpr double default_relative = 1e-4;

struct HullArguments {
  InputArguments inputs;
  std::vector<std::string> outputs;
  std::string report;
  std::string method = "sampled";
  std::optional<double> relative;
  std::optional<double> tolerance;
  int max_vertices = HullOptions().max_vertices;
};

/// What can be told from the command line alone.
void check(const HullArguments& arguments, bool json) {
  if (arguments.method != "sampled") {
    throw UsageError("--method " + arguments.method +
                     " is not available yet: give --method sampled");
  }
  if (arguments.outputs.empty() && arguments.report.empty() && !json) {
    throw UsageError("nothing to write: give -o FILE, --report FILE or --json");
  }
  const auto on_stdout = std::count(arguments.outputs.begin(), arguments.outputs.end(), "-") +
                         (json ? 1 : 0) + (arguments.report == "-" && !json ? 1 : 0);
  if (on_stdout > 1) throw UsageError("only one thing can be written to standard output");
  check_outputs(arguments.outputs, arguments.inputs.extension(), arguments.report,
                arguments.inputs.files);
}

/// In model units.
double tolerance(const HullArguments& arguments, double diagonal) {
  if (arguments.tolerance) return *arguments.tolerance;
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

/// The hull within the tolerance asked for or, where `failure` is set, the best that was found.
struct Outcome {
  std::shared_ptr<const Hull> hull;
  std::optional<HullNotConverged> failure;
};

Outcome compute(Input& input, const HullOptions& options) {
  try {
    Hull hull = input.model().polyhedral() ? polyhedral_hull(input.model(), options)
                                           : sampled_hull(input.scene(), options);
    return {std::make_shared<const Hull>(std::move(hull)), {}};
  } catch (const HullNotConverged& failure) {
    return {failure.best, failure};
  }
}

Report make_report(Input& input, const Hull& hull, const HullArguments& arguments,
                   double tolerance) {
  Report report;
  report.input = input.summary();
  report.method = arguments.method;
  report.dimension = hull.dimension();
  report.hull.gap_bound = hull.distance_bound;
  report.mesh.vertices = long(hull.mesh.n_vertices());
  report.mesh.edges = long(hull.mesh.n_edges());
  report.mesh.faces = long(hull.mesh.n_faces());
  report.mesh.measures = measure(polygons(hull.mesh));
  report.mesh.tolerance = tolerance;
  report.mesh.distance_bound = hull.distance_bound;
  report.queries = {hull.statistics.support_queries, hull.statistics.newton_iterations};
  report.seconds.read = input.seconds_read();
  report.seconds.build = input.seconds_build();
  report.seconds.sample = hull.statistics.seconds_sample;
  report.seconds.mesh = hull.statistics.seconds_mesh;
  return report;
}

std::string summary(const Report& report, const std::vector<std::string>& written) {
  const auto line = [](const char* name, const std::string& text) {
    return padded(name, 10) + one_line(text) + "\n";
  };
  const Report::Input& input = report.input;
  const Report::Seconds& s = report.seconds;
  const double relative = input.diagonal > 0 ? report.mesh.distance_bound / input.diagonal : 0;
  constexpr std::array kinds = {"point", "segment", "planar", "solid"};
  std::string text;
  text += line("input", joined(input.files));
  text += line("", counted(input.faces, "face", "faces") + ", " +
                       counted(input.patches, "patch", "patches") + ", diagonal " +
                       number(input.diagonal));
  text += line("hull", kinds[std::size_t(report.dimension)]);
  text += line("mesh", counted(report.mesh.faces, "face", "faces") + ", " +
                           counted(report.mesh.vertices, "vertex", "vertices") + " (" +
                           report.method + ")");
  text += line("volume", number(report.mesh.measures.volume, 10));
  text += line("area", number(report.mesh.measures.area, 10));
  text += line("distance", report.mesh.distance_bound == 0
                               ? std::string("none: the mesh is the hull")
                               : "at most " + number(report.mesh.distance_bound, 3) +
                                     " from the true hull, " + number(relative, 3) +
                                     " of the diagonal");
  text += line("seconds", number(s.total, 3) + ": read " + number(s.read, 2) + ", build " +
                              number(s.build, 2) + ", sample " + number(s.sample, 2) + ", mesh " +
                              number(s.mesh, 2) + ", write " + number(s.write, 2));
  for (const Report::Mesh::File& file : report.mesh.files) {
    if (file.rounding == 0) continue;
    text += line("rounding", "to float moved vertices of " + file.file + " by at most " +
                                 number(file.rounding, 3));
  }
  for (const std::string& file : written) text += line("wrote", file);
  return text;
}

/// Writes the meshes, tells the report how they were rounded, and warns where that is more than the
/// tolerance.
void write_outputs(const HullArguments& arguments, const Hull& hull, Report& report,
                   Console& console) {
  for (const std::string& file : arguments.outputs) {
    console.progress().check();
    WrittenMesh written;
    if (file == "-") {
      std::string data;
      written = write_mesh(data, standard_output, arguments.inputs.extension(), hull.mesh);
      console.print(data);
    } else {
      written = write_mesh(file, hull.mesh);
    }
    report.mesh.files.push_back({file, written.rounding});
    if (written.rounding <= report.mesh.tolerance) continue;
    console.warn("rounded-to-float", file + ": its floats move vertices by up to " +
                                         number(written.rounding, 3) +
                                         ", more than the tolerance; .ply holds doubles");
  }
}

ExitCode run(const HullArguments& arguments, Console& console) {
  check(arguments, console.options().json);
  Input input(arguments.inputs, console);
  HullOptions options;
  options.tolerance = tolerance(arguments, input.diagonal());
  options.threads = console.options().threads;
  options.max_vertices = arguments.max_vertices;
  options.progress = console.progress();
  const Outcome outcome = compute(input, options);

  Report report = make_report(input, *outcome.hull, arguments, options.tolerance);
  const Stopwatch writing;
  write_outputs(arguments, *outcome.hull, report, console);
  options.progress.check();
  report.seconds.write = writing.seconds();
  report.seconds.total = console.seconds();
  report.peak_bytes = peak_bytes();
  report.warnings = console.warnings();
  if (outcome.failure) report.warnings.push_back({"not-converged", outcome.failure->what()});

  const std::string json = taut::to_json(report);
  std::vector<std::string> written = arguments.outputs;
  const bool mesh_on_stdout = std::erase(written, "-") > 0;
  if (!arguments.report.empty() && arguments.report != "-") {
    write_text(arguments.report, json);
    written.push_back(arguments.report);
  }
  if (console.options().json || arguments.report == "-") {
    console.print(json);
  } else if (!console.options().quiet && !mesh_on_stdout) {
    console.print(summary(report, written));
  }
  if (!outcome.failure) return ExitCode::done;
  throw NotConverged(std::string(outcome.failure->what()) + "; the hull " +
                         (written.empty() ? "found" : "written") + " is within " +
                         number(report.mesh.distance_bound, 3),
                     outcome.failure->reached);
}

}  // namespace

Command add_hull(CLI::App& parent) {
  Command command = add_command(
      parent, "hull", "Convex hull of all inputs together",
      "Examples:\n"
      "  taut hull teapot.bpt -o hull.ply\n"
      "  taut hull teapot.bpt -o hull.ply -o hull.stl --relative 1e-5 --report hull.json\n"
      "  taut hull a.bpt b.obj --tolerance 0.01 --json\n"
      "  taut hull scan.xyz -o hull.ply              points and triangles: the exact hull");
  const auto arguments = std::make_shared<HullArguments>();
  CLI::App& app = *command.app;
  add_inputs(app, arguments->inputs);
  app.add_option(
         "-o,--output", arguments->outputs,
         "Mesh to write: .ply .obj .off .stl; may be repeated; - is standard\noutput, see --format")
      ->allow_extra_args(false)
      ->type_name("FILE");
  app.add_option("--method", arguments->method,
                 "sampled (default): a mesh through points of the model;\nprecise and "
                 "envelope are not available yet")
      ->check(CLI::IsMember({"sampled", "precise", "envelope"}).description(""))
      ->type_name("METHOD");
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
  add_integer(app, "--max-vertices", arguments->max_vertices, 4, std::numeric_limits<int>::max(),
              "Vertices after which to give up on the tolerance, default " +
                  number(long(arguments->max_vertices)));
  app.add_option("--report", arguments->report, "JSON report to write; - is stdout")
      ->type_name("FILE");
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool
