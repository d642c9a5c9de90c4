#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "command.h"
#include "contained_samples.h"
#include "input.h"
#include "standard_input.h"
#include "taut/io/document/read_hull.h"
#include "taut/io/mesh/read_mesh.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/text/formats.h"
#include "taut/verify/verify.h"
#include "taut/verify/verify_hull.h"
#include "text.h"

namespace taut::tool {
namespace {

constexpr double default_mesh_relative = 1e-4;
/// Of exact hulls, which claim to be so.
constexpr double default_exact_relative = 1e-12;

/// Distances of points are found to this share of the tolerance.
constexpr double sample_accuracy = 0.01;

struct VerifyArguments {
  std::string hull;
  InputArguments inputs;
  std::optional<double> given_relative;

  double relative(bool exact) const {
    return given_relative.value_or(exact ? default_exact_relative : default_mesh_relative);
  }
};

/// A check with its answer and, where it measures a length, that as a fraction of the diagonal.
struct Check {
  const char* key;
  const char* name;
  const char* fault;
  bool passed;
  const char* measure_key = nullptr;
  double measure = 0;
  bool counted = false;  ///< the measure is a number of things
  bool made = true;      ///< else the check could not be made
  double accuracy = 0;   ///< how well the measure is known, where that is worse than the tolerance
};

std::vector<Check> checks(const Verification& found, double relative, double diagonal) {
  const auto fraction = [&](double length) {
    if (diagonal > 0) return length / diagonal;
    return length > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  const double model_outside = fraction(found.model_outside);
  const double mesh_outside = fraction(found.mesh_outside);
  return {
      {"closed", "closed", "not closed", found.closed},
      {"manifold", "manifold", "not manifold", found.manifold},
      {"oriented", "oriented outward", "not oriented outward", found.oriented},
      {"topological_sphere", "one closed surface", "not one surface without holes",
       found.topological_sphere},
      {"convex", "convex", "not convex", found.convex, "largest_violation",
       fraction(found.largest_violation)},
      {"no_zero_area", "no face of zero area", "a face has zero area", found.no_zero_area},
      {"contains_model", "contains the model", "the model reaches out of the mesh",
       model_outside <= relative, "model_outside", model_outside},
      {"inside_hull", "inside the model's hull", "the mesh reaches out of the model's hull",
       mesh_outside <= relative, "mesh_outside", mesh_outside},
  };
}

/// Of an exact hull.
std::vector<Check> checks(const HullVerification& found, double relative) {
  const auto within = [&](double measure) { return measure <= relative + found.rounding; };
  const auto length = [&](const char* key, const char* name, const char* fault,
                          const char* measure_key, double measure) {
    return Check{key, name, fault, within(measure), measure_key, measure};
  };
  std::vector<Check> all = {
      {"complete", "complete", "faces are missing", found.complete},
      {"closed", "closed", "not closed", found.closed},
      {"topological_sphere", "one closed surface", "not one surface without holes",
       found.topological_sphere(), "euler", double(found.euler), true},
      {"covered", "patches are all there", "patches are missing", found.uncovered == 0, "uncovered",
       double(found.uncovered), true},
      length("of_model", "sources are the model's", "sources are not the model's", "off_model",
             found.off_model),
      length("on_sources", "contacts on their sources", "contacts are off their sources",
             "off_source", found.off_source),
      length("on_outlines", "curves on their faces", "curves are off their faces", "off_outline",
             found.off_outline),
      length("tangent", "contacts are tangent", "contacts are not tangent", "tangency",
             found.tangency),
      length("flat", "rulings and facets are flat", "rulings or facets are not flat", "flatness",
             found.flatness),
      length("contains_model", "contains the model", "the model reaches out of the hull",
             "model_outside", found.model_outside),
      length("inside_hull", "inside the model's hull", "the hull reaches out of the model's",
             "hull_outside", found.hull_outside),
      length("patches_support", "patches on the hull", "patches are not on the hull",
             "patch_outside", found.patch_outside),
      {"no_vector_area", "faces close up", "the faces do not close up", found.closes_up(relative),
       "vector_area", found.vector_area},
      {"width", "width of the model", "the width is not the model's", found.has_width(relative),
       "mean_width_error", found.mean_width_error},
      {"sound", "nothing else is wrong", "", found.faults.empty()}};
  const std::set<std::string> of_model = {"covered", "on_outlines", "patches_support",
                                          "no_vector_area", "width"};
  for (Check& check : all) {
    check.made = found.comparable || !of_model.contains(check.key);
    const std::string key = check.key;
    if (key == "width") check.accuracy = found.mean_width_accuracy;
    if (key == "no_vector_area" && found.vector_area_error > relative) {
      check.accuracy = found.vector_area_error;
    }
  }
  return all;
}

/// Of points of a mesh and of the model.
std::vector<Check> checks(const ContainedSamples& found, double relative, double diagonal) {
  const auto fraction = [&](double length) {
    if (diagonal > 0) return length / diagonal;
    return length > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  const double hull_outside = fraction(found.hull_outside);
  const double model_outside = fraction(found.model_outside);
  std::vector<Check> all = {{"vertices_in_hull", "vertices in the exact hull",
                             "vertices lie outside the model's hull", hull_outside <= relative,
                             "vertices_outside", hull_outside}};
  if (found.model_points) {
    all.push_back({"model_points_in_mesh", "points of the model inside",
                   "points of the model lie outside the mesh", model_outside <= relative,
                   "model_points_outside", model_outside});
  }
  return all;
}

/// What verify() says of either.
struct Verdict {
  std::vector<Check> checks;
  /// Of an exact hull, what no check has a line for.
  std::vector<std::string> faults;
  double relative = 0;
  int directions = 0;
  bool is_hull = false;
  /// What the file's format may add to lengths, which is allowed on top.
  double format_rounding = 0;
};

/// What stands before the number that a check measured.
std::string measure_name(const Check& check) {
  const std::string key = check.measure_key;
  if (key == "largest_violation") return "largest violation ";
  if (key == "euler") return "V - E + F = ";
  if (key == "uncovered") return "directions missed: ";
  return check.passed ? "to within " : "off by ";
}

std::string text_of(const Verdict& verdict) {
  std::string text;
  for (const Check& check : verdict.checks) {
    text += padded(check.name, 28) + (check.made ? padded(check.passed ? "yes" : "no", 5) : "?");
    if (check.made && check.measure_key != nullptr) {
      text += measure_name(check) + number(check.measure, 3);
      if (check.accuracy > 0) text += ", known to " + number(check.accuracy, 3);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  for (const std::string& fault : verdict.faults) text += "  " + fault + "\n";
  const bool all_made = std::all_of(verdict.checks.begin(), verdict.checks.end(),
                                    [](const Check& check) { return check.made; });
  if (!all_made) text += "(?: cannot be told without finite numbers and the model's own sources)\n";
  text += "(lengths are fractions of the diagonal, measured in " +
          counted(verdict.directions, "direction", "directions") + ")\n";
  if (verdict.format_rounding > 0) {
    text += "(the file holds floats: their rounding, " + number(verdict.format_rounding, 3) +
            ", is allowed on top)\n";
  }
  text += padded("hull within " + number(verdict.relative, 3), 28);
  return text + (verdict.is_hull ? "yes" : "no") + "\n";
}

Json measure_of(const Check& check) {
  if (!check.made) return {};
  return check.counted ? Json(long(check.measure)) : Json(check.measure);
}

Json json_of(const Verdict& verdict, const std::string& hull) {
  Json json;
  json["taut"] = TAUT_VERSION;
  json["hull"] = hull;
  json["is_hull"] = verdict.is_hull;
  json["relative"] = verdict.relative;
  for (const Check& check : verdict.checks) {
    json[check.key] = check.made ? Json(check.passed) : Json();
    if (check.measure_key == nullptr) continue;
    if (check.accuracy > 0) json["mean_width_accuracy"] = check.accuracy;
    json[check.measure_key] = measure_of(check);
  }
  json["faults"] = verdict.faults;
  json["directions"] = verdict.directions;
  json["format_rounding"] = verdict.format_rounding;
  return json;
}

std::string faults_of(const Verdict& verdict) {
  std::vector<std::string> faults;
  for (const Check& check : verdict.checks) {
    if (!check.made || check.passed || *check.fault == 0) continue;
    std::string fault = check.fault;
    if (check.measure_key != nullptr && !check.counted) {
      fault += " by " + number(check.measure, 3) + " diagonals";
    }
    faults.push_back(std::move(fault));
  }
  // One line is no place for all of them.
  if (!verdict.faults.empty()) faults.push_back(verdict.faults.front());
  return joined(faults, "; ");
}

/// The hull to check, of a mesh or exact.
struct HullFile {
  std::optional<HullDocument> exact;
  PolygonMesh mesh;
  /// What the format's rounding may have moved the mesh's vertices by, in model units.
  double rounding = 0;
};

/// A mesh with what its format does to it.
HullFile mesh_file(PolygonMesh mesh, const std::string& format) {
  HullFile file{{}, std::move(mesh)};
  if (format == ".stl") file.rounding = float_rounding(file.mesh.points);
  return file;
}

HullFile read_hull_file(const VerifyArguments& arguments, Console& console) {
  const bool given = arguments.hull == "-";
  const std::string format =
      given ? arguments.inputs.input_extension() : input_extension(arguments.hull);
  const bool json = format == ".hull.json";
  const bool exact = json || format == ".hull.cbor";
  if (!given && exact) return {read_hull(arguments.hull, console.progress()), {}};
  if (!given) return mesh_file(read_mesh(arguments.hull), format);
  const std::vector<std::string>& files = arguments.inputs.files;
  if (std::find(files.begin(), files.end(), "-") != files.end()) {
    throw UsageError("standard input cannot be both the hull and the model");
  }
  if (format.empty()) throw UsageError("standard input needs its format, such as --from ply");
  const std::string data = read_standard_input(console.progress().stop);
  if (!exact) return mesh_file(read_mesh(data, standard_input, format), format);
  return {
      taut::read_hull(data, standard_input, json ? DocumentEncoding::json : DocumentEncoding::cbor,
                      console.progress()),
      {}};
}

Verdict check(const HullFile& hull, Input& input, double relative, const VerifyOptions& options) {
  const double diagonal = input.scene().diagonal();
  const double accuracy = sample_accuracy * relative * diagonal;
  const auto add = [](Verdict& verdict, const std::vector<Check>& more) {
    for (const Check& check : more) {
      verdict.is_hull = verdict.is_hull && (check.passed || !check.made);
      verdict.checks.push_back(check);
    }
  };
  if (!hull.exact) {
    const double rounding = diagonal > 0 ? hull.rounding / diagonal : 0;
    const double allowed = relative + rounding;
    const Verification found = verify(hull.mesh, input.scene(), options);
    Verdict verdict{checks(found, allowed, diagonal),  {},      relative, found.directions,
                    found.is_hull(allowed * diagonal), rounding};
    const ContainedSamples samples =
        contained_samples(hull.mesh, input.scene(), accuracy, options.threads, options.progress);
    add(verdict, checks(samples, allowed, diagonal));
    return verdict;
  }
  const HullVerification found = verify(*hull.exact, input.scene(), options);
  Verdict verdict{checks(found, relative), {}, relative, found.directions, found.is_hull(relative)};
  for (const HullFault& fault : found.faults) verdict.faults.push_back(fault.text);
  if (!found.comparable) return verdict;
  const ContainedSamples samples =
      contained_samples(*hull.exact, input.scene(), accuracy, options.threads, options.progress);
  const double off = std::max(samples.hull_outside, samples.hull_inside);
  const double fraction = diagonal > 0 ? off / diagonal : off;
  add(verdict, {{"points_on_hull", "points on the exact hull", "points are off the exact hull",
                 fraction <= relative + found.rounding, "points_off_hull", fraction}});
  return verdict;
}

ExitCode run(const VerifyArguments& arguments, Console& console) {
  const HullFile hull = read_hull_file(arguments, console);
  Input input(arguments.inputs, console);
  input.scene();
  const Stopwatch watch;
  VerifyOptions options;
  options.threads = console.options().threads;
  options.progress = console.progress();
  const double relative = arguments.relative(hull.exact.has_value());
  const Verdict verdict = check(hull, input, relative, options);
  const double seconds = watch.seconds();

  if (console.options().json) {
    Json json = json_of(verdict, arguments.hull);
    json["input"] = to_json(input.summary());
    json["seconds"] = {{"read", input.seconds_read()},
                       {"build", input.seconds_build()},
                       {"verify", seconds},
                       {"total", console.seconds()}};
    json["peak_bytes"] = peak_bytes();
    json["warnings"] = to_json(console.warnings());
    console.print(text(json));
  } else if (!console.options().quiet) {
    console.print(text_of(verdict));
  }
  if (verdict.is_hull) return ExitCode::done;
  throw CheckFailed(arguments.hull + ": is not the convex hull of the model within " +
                    number(relative, 3) + " of its diagonal: " + faults_of(verdict));
}

}  // namespace

Command add_verify(CLI::App& parent) {
  Command command = add_command(
      parent, "verify", "Checks any hull file against a model",
      "Exits with 0 if HULL is the model's convex hull within the tolerance, else 1.\n\n"
      "Examples:\n"
      "  taut verify hull.ply teapot.bpt\n"
      "  taut verify hull.stl teapot.bpt --relative 1e-3\n"
      "  taut verify teapot.hull.json teapot.bpt   an exact hull");
  const auto arguments = std::make_shared<VerifyArguments>();
  command.app
      ->add_option(
          "HULL", arguments->hull,
          "Mesh or exact hull (.hull.json .hull.cbor) to check; - is standard\ninput, see --from")
      ->required()
      ->option_text("FILE");
  add_inputs(*command.app, arguments->inputs);
  add_positive(
      *command.app, "--relative", arguments->given_relative,
      "Tolerance as a fraction of the model's diagonal, default 1e-4,\n1e-12 for an exact hull")
      ->type_name("R");
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool
