#include "hull_outputs.h"

#include <filesystem>

#include "standard_input.h"
#include "taut/core/stopwatch.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/document/write_hull.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/model/write_project.h"
#include "text.h"

namespace taut::tool {
namespace {

/// The exact hull, with the report as far as it goes.
HullDocument document_of(Input& input, const Hull& hull, const Report& report) {
  const std::vector<std::string>& files = input.part_files();
  HullDocument document = hull.boundary ? hull_document(input.scene(), *hull.boundary, files)
                          : input.model().polyhedral()
                              ? hull_document(input.model(), hull.mesh, files)
                              : hull_document(input.scene(), hull.mesh, files);
  document.report = taut::to_json(report);
  return document;
}

/// Segments and points are their meshes, as polyhedral hulls are.
bool is_known(const Hull& hull, const Model& model) {
  return hull.boundary || model.polyhedral() || hull.kind < HullKind::planar;
}

/// Why the exact hull is not written, and what could be instead.
std::string no_document(const HullArguments& arguments, const Hull& hull) {
  std::string text = "cannot be written: the exact hull of this ";
  text += hull.kind == HullKind::solid ? "model" : "flat model";
  text += " is not known; ";
  for (const std::string& file : arguments.outputs) {
    const std::string format = arguments.format_of(file);
    if (file != "-" && !is_document(format) && format != ".mlp") {
      return text + file + " is its mesh";
    }
  }
  return text + "-o FILE.ply writes its mesh";
}

/// What writing one output gave.
struct Output {
  std::vector<std::string> files;
  double rounding = 0;
};

/// A project and its layers.
Output write_layers(const std::string& file, Input& input, const Hull& hull) {
  std::vector<std::filesystem::path> paths;
  if (hull.boundary) {
    const SceneFrame& frame = input.scene().frame();
    paths = write_project(file, hull.mesh, hull_curves(frame, *hull.boundary), input.model(),
                          tolerant_curves(frame, *hull.boundary));
  } else {
    paths = write_project(file, hull.mesh, hull_curves(hull.mesh), input.model());
  }
  Output output;
  for (const std::filesystem::path& path : paths) output.files.push_back(path.string());
  return output;
}

/// Writes one output; "-" is standard output. @throws IoError
Output write_output(const std::string& file, const HullArguments& arguments, Input& input,
                    const Outcome& outcome, const Report& report, Console& console) {
  const std::string format = arguments.format_of(file);
  const Hull& hull = *outcome.hull;
  if (is_document(format)) {
    if (!is_known(outcome.exact(), input.model())) {
      throw IoError((file == "-" ? std::string(standard_output) : file) + ": " +
                    no_document(arguments, hull));
    }
    const HullDocument document = document_of(input, outcome.exact(), report);
    if (file != "-") {
      write_hull(file, document);
    } else {
      console.print(to_document(
          document, format == ".hull.json" ? DocumentEncoding::json : DocumentEncoding::cbor));
    }
    return {{file}, 0};
  }
  if (format == ".mlp") return write_layers(file, input, hull);
  if (file != "-") return {{file}, write_mesh(file, hull.mesh).rounding};
  std::string data;
  const WrittenMesh written = write_mesh(data, standard_output, format, hull.mesh);
  console.print(data);
  return {{file}, written.rounding};
}

}  // namespace

bool is_document(const std::string& format) {
  return format == ".hull.json" || format == ".hull.cbor";
}

Written write_outputs(const HullArguments& arguments, const OutputPlaces& places, Input& input,
                      const Outcome& outcome, Report& report, Console& console) {
  const Stopwatch writing;
  Written written;
  for (std::size_t i = 0; i < arguments.outputs.size(); ++i) {
    const std::string& file = arguments.outputs[i];
    console.progress().update("write", double(i) / double(arguments.outputs.size()));
    if (!places.hulls[i].empty()) {
      written.failures.push_back(places.hulls[i]);
      continue;
    }
    try {
      const Output output = write_output(file, arguments, input, outcome, report, console);
      report.mesh.files.push_back({file, output.rounding});
      written.any_hull = true;
      for (const std::string& own : output.files) {
        if (own != "-") written.files.push_back(own);
      }
    } catch (const IoError& failure) {
      written.failures.emplace_back(failure.what());
    }
  }
  report.seconds.write = writing.seconds();
  return written;
}

void write_report(const HullArguments& arguments, const OutputPlaces& places, const Report& report,
                  Written& written) {
  if (arguments.report.empty() || arguments.report == "-") return;
  try {
    if (!places.report.empty()) throw IoError(places.report);
    write_text(arguments.report, taut::to_json(report));
    written.files.push_back(arguments.report);
  } catch (const IoError& failure) {
    written.failures.emplace_back(failure.what());
  }
}

}  // namespace taut::tool
