#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "input.h"
#include "output.h"
#include "standard_input.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/envelope/trace_envelope.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/polyhedral/polyhedral_hull.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/result/measures.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/document/write_hull.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/model/write_project.h"
#include "taut/io/report/report.h"
#include "taut/io/text/formats.h"
#include "text.h"

namespace taut::tool {
namespace {

constexpr double default_relative = 1e-4;
/// Reasons for unresolved spots that the warning names; -v tells all.
constexpr std::size_t reasons_told = 3;
/// Estimated relative accuracy of its measures that a complete boundary does not exceed.
constexpr double worst_accuracy = 1e-9;

struct HullArguments {
  InputArguments inputs;
  std::vector<std::string> outputs;
  std::string report;
  std::string method = "precise";
  std::optional<double> relative;
  std::optional<double> tolerance;
  std::optional<double> resolution;
  int max_vertices = HullOptions().max_vertices;
  std::optional<double> max_seconds;
  std::optional<std::size_t> max_memory;
  int size = EnvelopeOptions().size;
};

std::string format_of(const std::string& output, const HullArguments& arguments) {
  return output == "-" ? arguments.inputs.extension() : extension(output);
}

bool is_document(const std::string& format) {
  return format == ".hull.json" || format == ".hull.cbor";
}

/// What can be told from the command line alone.
void check(const HullArguments& arguments, bool json) {
  for (const std::string& file : arguments.outputs) {
    const std::string format = format_of(file, arguments);
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

/// What of the tolerance is the mesh's, where patches stand for others: what these miss is left to
/// them, rounded so that the sum is within it, unless it is too much for both.
double mesh_tolerance(double tolerance, double deviation) {
  if (deviation == 0 || deviation > tolerance / 2) return tolerance;
  return std::nextafter(tolerance - deviation, 0.0);
}

/// The hull within the tolerance asked for or, with the reason, the best that was found.
struct Outcome {
  std::shared_ptr<const Hull> hull;
  std::optional<std::string> failure;
  bool met_limit = false;  ///< that is the reason

  void meet(const std::string& limit) {
    failure = failure ? *failure + "; " + limit : limit;
    met_limit = true;
  }
};

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

Outcome compute(Input& input, const HullArguments& arguments, const HullOptions& options,
                Console& console) {
  const std::string& method = arguments.method;
  try {
    Hull hull = method == "envelope" ? hull_of_images(input.scene(), arguments.size, options)
                : input.model().polyhedral() ? polyhedral_hull(input.model(), options)
                : method == "precise"        ? precise_hull(input.scene(), options)
                                             : sampled_hull(input.scene(), options);
    return {std::make_shared<const Hull>(std::move(hull)), {}};
  } catch (const HullNotConverged& failure) {
    return {failure.best, failure.what()};
  } catch (const HullLimitExceeded& met) {
    console.lift_limits();
    return {met.best, met.what(), true};
  }
}

/// Why a mesh within its own tolerance is not within the one asked for: the patches of cages miss
/// too much of their limit surfaces. `bound`: the distance of the mesh, with that.
std::optional<std::string> failure_of_cages(double bound, double deviation, double tolerance) {
  if (deviation == 0 || bound <= tolerance) return {};
  return "the tolerance " + number(tolerance, 3) +
         " was not reached: the limit surfaces of the cages are known to " + number(deviation, 3) +
         " only";
}

/// Warns that the exact hull is not complete: how many spots of it, and the first reasons.
void warn_of_unresolved(const HullBoundary& boundary, Console& console) {
  if (boundary.unresolved.empty()) return;
  std::vector<std::pair<std::string, long>> reasons;  // each once, with how often it occurs
  for (const Unresolved& spot : boundary.unresolved) {
    console.note("unresolved at the normal " + number(spot.n.x) + " " + number(spot.n.y) + " " +
                 number(spot.n.z) + ": " + spot.reason);
    const auto known = std::find_if(reasons.begin(), reasons.end(),
                                    [&](const auto& r) { return r.first == spot.reason; });
    if (known == reasons.end()) {
      reasons.emplace_back(spot.reason, 1);
    } else {
      ++known->second;
    }
  }
  std::vector<std::string> words;
  for (std::size_t k = 0; k < std::min(reasons.size(), reasons_told); ++k) {
    words.push_back(reasons[k].first +
                    (reasons[k].second > 1 ? " (" + number(reasons[k].second) + ")" : ""));
  }
  if (reasons.size() > reasons_told) words.emplace_back("and others (-v tells all)");
  console.warn("unresolved",
               counted(long(boundary.unresolved.size()), "spot", "spots") +
                   " of the exact hull could not be resolved: " + joined(words, "; ") +
                   ". Faces of it may be missing, it is not measured; the mesh is whole and within "
                   "its distance");
}

/// Mean width of a convex polyhedron, polygon (both sides of which are faces), segment or point:
/// over 4 pi, the sum of its edges' lengths times the angles by which the normal turns there.
double mean_width(const HullMesh& mesh) {
  const auto normal = [&](OpenMesh::FaceHandle face) {
    std::vector<dvec3> corners;
    for (const auto v : mesh.fv_range(face)) corners.push_back(position(mesh, v));
    return plane_normal(corners);
  };
  std::vector<dvec3> normals;
  for (const auto face : mesh.faces()) normals.push_back(normal(face));
  double sum = 0;
  for (const auto edge : mesh.edges()) {
    const auto h = mesh.halfedge_handle(edge, 0);
    const auto a = mesh.face_handle(h);
    const auto b = mesh.face_handle(mesh.opposite_halfedge_handle(h));
    const dvec3 side =
        position(mesh, mesh.to_vertex_handle(h)) - position(mesh, mesh.from_vertex_handle(h));
    double turn = 2 * std::numbers::pi;  // about a segment
    if (a.is_valid() && b.is_valid()) {
      turn =
          exterior_angle(normals[std::size_t(a.idx())], normals[std::size_t(b.idx())], unit(side));
    }
    sum += turn * glm::length(side);
  }
  return sum / (4 * std::numbers::pi);
}

/// How many faces of a boundary are tolerant, and the largest of their bounds.
Report::ExactHull::Tolerant tolerant_faces(const HullBoundary& boundary) {
  Report::ExactHull::Tolerant tolerant;
  for (const HullFace& face : boundary.faces) {
    if (!(face.tolerant > 0)) continue;
    ++tolerant.faces;
    tolerant.bound = std::max(tolerant.bound, boundary.frame.length_to_model(face.tolerant));
  }
  return tolerant;
}

/// Adds the measures of a boundary. @throws LimitMet
void add_measures(Input& input, const HullBoundary& boundary, Console& console,
                  Report::ExactHull& exact) {
  console.progress().update("measure", 0);
  const BoundaryMeasures measures =
      measure(input.scene(), ContactGeometry(input.scene(), console.progress().stop), boundary);
  exact.measures = measures;
  exact.mean_width = measures.mean_width;
  exact.measures_accuracy = measures.bounds.largest();
  // What is known to the resolution only is so of what is whole, too.
  const double of_places = measures.bounds.largest() - measures.accuracy;
  if (measures.accuracy <= std::max(worst_accuracy, of_places)) return;
  console.warn("inexact-measures",
               "the measures of the exact hull are accurate to " + number(measures.accuracy, 2) +
                   " only: faces of it may be missing or not meet; the mesh is whole and within "
                   "its distance");
}

/// What is known of the exact hull: its faces and, if no limit is met meanwhile, its measures.
Report::ExactHull exact_hull(Input& input, Outcome& outcome, const std::string& method,
                             Console& console) {
  const Hull& hull = *outcome.hull;
  Report::ExactHull exact;
  exact.gap_bound = hull.distance_bound + input.model().deviation_bound();
  if (hull.boundary) {
    const HullBoundary& boundary = *hull.boundary;
    warn_of_unresolved(boundary, console);
    exact.counts = {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
                    boundary.count(FaceKind::facet), int(boundary.curves.size()),
                    int(boundary.unresolved.size())};
    exact.tolerant = tolerant_faces(boundary);
    if (input.model().polyhedral()) {
      exact.measures = measure(polygons(hull.mesh));
      exact.mean_width = mean_width(hull.mesh);
    } else if (boundary.unresolved.empty()) {
      try {
        add_measures(input, boundary, console, exact);
      } catch (const LimitMet& met) {
        outcome.meet(std::string(met.what()) + " before the hull was measured");
      }
    }
  } else if (input.model().polyhedral() && method == "precise") {
    exact.counts = {0, 0, int(hull.mesh.n_faces()), int(hull.mesh.n_edges()), 0};
    exact.tolerant = Report::ExactHull::Tolerant{};
    exact.measures = measure(polygons(hull.mesh));
    exact.mean_width = mean_width(hull.mesh);
  }
  return exact;
}

/// What became of the control cages, if there are any.
std::optional<Report::Subdivision> subdivision(const Model& model) {
  Report::Subdivision sum;
  bool any = false;
  for (const Part& part : model.parts()) {
    for (const CageOfPart& cage : part.cages()) {
      any = true;
      sum.irregular_faces += cage.irregular_faces;
      sum.refined_faces += cage.refined_faces;
    }
  }
  if (!any) return {};
  sum.deviation_bound = model.deviation_bound();
  return sum;
}

Report make_report(Input& input, Outcome& outcome, const HullArguments& arguments, double tolerance,
                   Console& console) {
  const Hull& hull = *outcome.hull;
  Report report;
  report.input = input.summary();
  report.method = arguments.method;
  report.dimension = hull.dimension();
  const Stopwatch measuring;
  report.hull = exact_hull(input, outcome, arguments.method, console);
  report.hull.resolution = hull.resolution;
  report.mesh.vertices = long(hull.mesh.n_vertices());
  report.mesh.edges = long(hull.mesh.n_edges());
  report.mesh.faces = long(hull.mesh.n_faces());
  report.mesh.measures = measure(polygons(hull.mesh));
  report.seconds.measure = measuring.seconds();
  report.mesh.tolerance = tolerance;
  // The scene's surfaces themselves may stand for others.
  report.mesh.distance_bound = hull.distance_bound + input.model().deviation_bound();
  report.subdivision = subdivision(input.model());
  const HullStatistics& statistics = hull.statistics;
  if (statistics.map_cells > 0) {
    report.culling = {statistics.map_candidates, statistics.map_contacts, statistics.map_undecided};
    report.directions = {statistics.map_cells, statistics.map_candidates, statistics.map_undecided};
  }
  report.queries = {statistics.support_queries, statistics.newton_iterations};
  report.seconds.read = input.seconds_read();
  report.seconds.build = input.seconds_build();
  report.seconds.sample = statistics.seconds_sample;
  report.seconds.cull = statistics.seconds_map;
  report.seconds.trace = statistics.seconds_trace;
  report.seconds.stitch = statistics.seconds_stitch;
  report.seconds.mesh = statistics.seconds_mesh;
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
  std::string hull = kinds[std::size_t(report.dimension)];
  if (const auto& counts = report.hull.counts) {
    hull += ": " + counted(counts->patches, "patch", "patches") + ", " +
            counted(counts->scrolls, "scroll", "scrolls") + ", " +
            counted(counts->facets, "facet", "facets") + ", " +
            counted(counts->curves, "curve", "curves");
    if (counts->unresolved > 0) hull += ", " + number(long(counts->unresolved)) + " unresolved";
  }
  if (const auto& tolerant = report.hull.tolerant; tolerant && tolerant->faces > 0) {
    hull += ", " + counted(tolerant->faces, "face", "faces") + " off by up to " +
            number(tolerant->bound, 3);
  }
  text += line("hull", hull);
  if (const auto& resolution = report.hull.resolution) {
    text += line("resolution", " " + number(resolution->rho, 3) + ": " + reason_of(*resolution));
  }
  text += line("mesh", counted(report.mesh.faces, "face", "faces") + ", " +
                           counted(report.mesh.vertices, "vertex", "vertices") + " (" +
                           report.method + ")");
  const auto measured = [&](double Measures::*value) {
    std::string of_mesh = number(report.mesh.measures.*value, 10);
    if (report.mesh.distance_bound == 0) return of_mesh;
    if (!report.hull.measures) return of_mesh + " of the mesh";
    return number((*report.hull.measures).*value, 10) + ", the mesh's " + of_mesh;
  };
  text += line("volume", measured(&Measures::volume));
  text += line("area", measured(&Measures::area));
  text += line("distance", report.mesh.distance_bound == 0
                               ? std::string("none: the mesh is the hull")
                               : "at most " + number(report.mesh.distance_bound, 3) +
                                     " from the true hull, " + number(relative, 3) +
                                     " of the diagonal");
  text += line("seconds", number(s.total, 3) + ": read " + number(s.read, 2) + ", build " +
                              number(s.build, 2) + ", sample " + number(s.sample, 2) + ", cull " +
                              number(s.cull, 2) + ", trace " + number(s.trace, 2) + ", stitch " +
                              number(s.stitch, 2) + ", mesh " + number(s.mesh, 2) + ", measure " +
                              number(s.measure, 2) + ", write " + number(s.write, 2));
  for (const Report::Mesh::File& file : report.mesh.files) {
    if (file.rounding == 0) continue;
    text += line("rounding", "to float moved vertices of " + file.file + " by at most " +
                                 number(file.rounding, 3));
  }
  for (const std::string& file : written) text += line("wrote", file);
  return text;
}

/// The exact hull, with the report as far as it goes.
HullDocument document_of(Input& input, const Hull& hull, const Report& report) {
  HullDocument document = hull.boundary
                              ? hull_document(input.scene(), *hull.boundary, input.part_files())
                              : hull_document(input.model(), hull.mesh, input.part_files());
  document.report = taut::to_json(report);
  return document;
}

/// Writes one output; "-" is standard output.
WrittenMesh write_output(const std::string& file, const std::string& format, Input& input,
                         const Hull& hull, const Report& report, Console& console) {
  if (is_document(format)) {
    const HullDocument document = document_of(input, hull, report);
    if (file != "-") {
      write_hull(file, document);
    } else {
      console.print(to_document(
          document, format == ".hull.json" ? DocumentEncoding::json : DocumentEncoding::cbor));
    }
    return {};
  }
  if (format == ".mlp") {
    if (!hull.boundary) {
      write_project(file, hull.mesh, hull_curves(hull.mesh), input.model());
      return {};
    }
    const SceneFrame& frame = input.scene().frame();
    write_project(file, hull.mesh, hull_curves(frame, *hull.boundary), input.model(),
                  tolerant_curves(frame, *hull.boundary));
    return {};
  }
  if (file != "-") return write_mesh(file, hull.mesh);
  std::string data;
  const WrittenMesh written = write_mesh(data, standard_output, format, hull.mesh);
  console.print(data);
  return written;
}

/// Writes all outputs, tells the report how they were rounded, and warns where that is more than
/// the tolerance.
void write_outputs(const HullArguments& arguments, Input& input, const Hull& hull, Report& report,
                   Console& console) {
  for (const std::string& file : arguments.outputs) {
    if (!is_document(format_of(file, arguments)) || hull.boundary || input.model().polyhedral()) {
      continue;
    }
    throw IoError(file + ": the exact hull of this model, which is " +
                  (hull.kind == HullKind::solid ? "solid" : "flat") +
                  ", is not known; .ply holds its mesh");
  }
  for (const std::string& file : arguments.outputs) {
    console.progress().check();
    const WrittenMesh written =
        write_output(file, format_of(file, arguments), input, hull, report, console);
    report.mesh.files.push_back({file, written.rounding});
    if (written.rounding <= report.mesh.tolerance) continue;
    console.warn("rounded-to-float", file + ": its floats move vertices by up to " +
                                         number(written.rounding, 3) +
                                         ", more than the tolerance; .ply holds doubles");
  }
}

/// The times and warnings until now.
void bring_up_to_date(Report& report, const Outcome& outcome, const Console& console) {
  report.seconds.total = console.seconds();
  report.peak_bytes = peak_bytes();
  report.warnings = console.warnings();
  if (!outcome.failure) return;
  report.warnings.push_back({outcome.met_limit ? "limit-met" : "not-converged", *outcome.failure});
}

/// What a run that ends too early throws, with what was written and how far off that is.
[[noreturn]] void fail(const Outcome& outcome, const std::vector<std::string>& written,
                       double bound) {
  const std::string text = *outcome.failure + "; the hull " +
                           (written.empty() ? "found" : "written") + " is within " +
                           number(bound, 3);
  if (outcome.met_limit) throw LimitExceeded(text);
  throw NotConverged(text, bound);
}

/// @throws LimitExceeded also where a limit is met before there is a hull
ExitCode run_within_limits(const HullArguments& arguments, Console& console) {
  Input input(arguments.inputs, console);
  HullOptions options;
  const double wanted = tolerance(arguments, input.diagonal());
  const double deviation = input.model().deviation_bound();
  options.tolerance = mesh_tolerance(wanted, deviation);
  options.resolution = arguments.resolution;
  options.threads = console.options().threads;
  options.max_vertices = arguments.max_vertices;
  options.progress = console.progress();
  Outcome outcome = compute(input, arguments, options, console);

  Report report = make_report(input, outcome, arguments, wanted, console);
  console.lift_limits();
  if (!outcome.failure) {
    outcome.failure = failure_of_cages(report.mesh.distance_bound, deviation, wanted);
  }
  bring_up_to_date(report, outcome, console);
  const Stopwatch writing;
  write_outputs(arguments, input, *outcome.hull, report, console);
  options.progress.check();
  report.seconds.write = writing.seconds();
  bring_up_to_date(report, outcome, console);

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
  if (outcome.failure) fail(outcome, written, report.mesh.distance_bound);
  return ExitCode::done;
}

ExitCode run(const HullArguments& arguments, Console& console) {
  check(arguments, console.options().json);
  console.limit(arguments.max_seconds, arguments.max_memory);
  try {
    return run_within_limits(arguments, console);
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
                 "see\n--format")
      ->allow_extra_args(false)
      ->type_name("FILE");
  app.add_option(
         "--method", arguments->method,
         "precise (default): the exact hull, and a mesh of it; sampled: a\nmesh through points of "
         "the model; envelope: a mesh through contacts that envelope images\nshow")
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
  add_resolution(app, arguments->resolution);
  add_integer(app, "--max-vertices", arguments->max_vertices, 4, std::numeric_limits<int>::max(),
              "Vertices after which to give up on the tolerance, default " +
                  number(long(arguments->max_vertices)));
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
  app.add_option("--report", arguments->report, "JSON report to write; - is stdout")
      ->type_name("FILE");
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool
