#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "input.h"
#include "output.h"
#include "taut/io/document/write_document.h"
#include "taut/io/text/formats.h"
#include "taut/surface/resolution.h"
#include "text.h"

namespace taut::tool {
namespace {

/// Degrees (u, v) of patches, or (t, 0) of the pieces of free curves, and how many there are.
using DegreeCounts = std::map<std::pair<int, int>, long>;

/// What one file holds.
struct Contents {
  Report::Input summary;
  DegreeCounts patches;
  DegreeCounts free_pieces;
  long free_vertices = 0;
  long polygons = 0;
  /// Control cages by their schemes, and faces of them.
  std::map<std::string, long> cage_faces;
  long irregular_faces = 0;
  long refined_faces = 0;
  double deviation_bound = 0;
  /// None where the diagonal is not known.
  std::optional<Resolution> resolution;
  int trimmed = 0;
  long rational = 0;
  std::vector<std::string> face_names;
};

Contents contents(Input& input, std::optional<double> resolution, const Progress& progress) {
  Contents contents;
  contents.summary = input.summary();
  if (!contents.summary.box.empty()) {
    contents.resolution = resolution_of(input.model(), input.diagonal(), resolution);
    warn_if_capped(*contents.resolution, progress);
  }
  contents.trimmed = trimmed_face_count(input.model());
  for (const Instance& instance : input.model().instances()) {
    const Part& part = input.model().parts()[std::size_t(instance.part)];
    for (const Patch& patch : part.patches()) {
      ++contents.patches[{patch.bezier.degree_u, patch.bezier.degree_v}];
      contents.rational += is_polynomial(patch.bezier.points) ? 0 : 1;
    }
    for (const EdgePiece& piece : part.pieces()) {
      if (piece.edge < 0) break;  // seams
      if (!part.edges()[std::size_t(piece.edge)].faces.empty()) continue;
      ++contents.free_pieces[{piece.bezier.degree(), 0}];
      contents.rational += is_polynomial(piece.bezier.points) ? 0 : 1;
    }
    contents.free_vertices += part.point_count();
    contents.polygons += long(part.polygons().size());
    for (const CageOfPart& cage : part.cages()) {
      contents.cage_faces[name_of(cage.cage->scheme)] += long(cage.cage->faces.size());
      contents.irregular_faces += cage.irregular_faces;
      contents.refined_faces += cage.refined_faces;
    }
    for (const Face& face : part.faces()) contents.face_names.push_back(face.name);
  }
  contents.deviation_bound = input.model().deviation_bound();
  return contents;
}

/// What the polygons of a file were taken for; empty if it has none.
std::string scheme_of(const Contents& file) {
  std::string schemes = file.polygons > 0 ? "bilinear" : "";
  for (const auto& [scheme, faces] : file.cage_faces) {
    schemes += (schemes.empty() ? "" : ", ") + scheme;
  }
  return schemes;
}

/// All files taken together, without building a common scene.
Report::Input total(const std::vector<Contents>& files) {
  Report::Input total;
  for (const Contents& file : files) {
    total.files.insert(total.files.end(), file.summary.files.begin(), file.summary.files.end());
    total.faces += file.summary.faces;
    total.edges += file.summary.edges;
    total.vertices += file.summary.vertices;
    total.patches += file.summary.patches;
    total.curves += file.summary.curves;
    total.points += file.summary.points;
    if (total.unit.empty()) total.unit = file.summary.unit;
    total.box.include(file.summary.box);
  }
  total.diagonal = diagonal(total.box);
  return total;
}

Json degrees_json(const DegreeCounts& counts, const char* noun) {
  Json json = Json::array();
  for (const auto& [degree, count] : counts) {
    Json entry;
    entry["degree"] = degree.second > 0 ? Json{degree.first, degree.second} : Json{degree.first};
    entry[noun] = count;
    json.push_back(std::move(entry));
  }
  return json;
}

/// Of doubles, null.
Json grid_json(const CoordinateGrid& grid) {
  switch (grid.kind) {
    case CoordinateGrid::Kind::float32:
      return {{"kind", "float32"}, {"step", grid.step}};
    case CoordinateGrid::Kind::decimals:
      return {{"kind", "decimals"}, {"decimals", grid.decimals}, {"step", grid.step}};
    default:
      return {};
  }
}

Json json_of(const Contents& file) {
  Json json;
  json["file"] = file.summary.files.front();
  const Json counts = to_json(file.summary);
  for (const char* key : {"faces", "edges", "vertices", "patches"}) json[key] = counts[key];
  json["degrees"] = degrees_json(file.patches, "patches");
  json["free_curves"] = degrees_json(file.free_pieces, "pieces");
  json["points"] = file.free_vertices;
  json["polygons"] = file.polygons;
  const std::string scheme = scheme_of(file);
  json["scheme"] = scheme.empty() ? Json() : Json(scheme);
  if (!file.cage_faces.empty()) {
    json["subdivision"] = {{"irregular_faces", file.irregular_faces},
                           {"refined_faces", file.refined_faces},
                           {"deviation_bound", file.deviation_bound}};
  }
  json["trimmed"] = file.trimmed;
  json["rational"] = file.rational > 0;
  json["unit"] = counts["unit"];
  json["diagonal"] = counts["diagonal"];
  json["box"] = counts["box"];
  if (file.resolution) {
    json["resolution"] = file.resolution->rho;
    json["resolution_source"] = name_of(file.resolution->source);
    json["worst_join"] = file.resolution->worst_join;
    json["grid"] = grid_json(file.resolution->grid);
  }
  json["names"] = file.face_names;
  return json;
}

std::string degrees_text(const DegreeCounts& counts) {
  std::vector<std::string> words;
  for (const auto& [degree, count] : counts) {
    std::string word = number(long(degree.first));
    if (degree.second > 0) word += "x" + number(long(degree.second));
    words.push_back(word + ": " + number(count));
  }
  return joined(words);
}

std::string point_text(const dvec3& p) {
  return number(p.x, 9) + " " + number(p.y, 9) + " " + number(p.z, 9);
}

std::string sizes_text(const Report::Input& input) {
  return "  faces     " + number(long(input.faces)) + "\n" +     //
         "  edges     " + number(long(input.edges)) + "\n" +     //
         "  vertices  " + number(long(input.vertices)) + "\n" +  //
         "  patches   " + number(long(input.patches)) + "\n" +   //
         (input.box.empty() ? ""
                            : "  box       " + point_text(input.box.lower) + "  to  " +
                                  point_text(input.box.upper) + "\n" +  //
                                  "  diagonal  " + number(input.diagonal, 9) + "\n") +
         (input.unit.empty() ? "" : "  unit      " + one_line(input.unit) + "\n");
}

std::string text_of(const Contents& file, bool names) {
  std::string text = one_line(file.summary.files.front()) + "\n" + sizes_text(file.summary);
  if (!file.patches.empty()) text += "  degrees   " + degrees_text(file.patches) + "\n";
  if (!file.free_pieces.empty()) {
    text += "  free curves, degrees  " + degrees_text(file.free_pieces) + "\n";
  }
  if (file.polygons > 0) {
    text += "  polygons  " + number(file.polygons) + ", taken as they are (scheme bilinear)\n";
  }
  for (const auto& [scheme, faces] : file.cage_faces) {
    text += "  cage      " + counted(faces, "face", "faces") + " (scheme " + scheme + ")\n";
  }
  if (!file.cage_faces.empty()) {
    text += "  irregular " + counted(file.irregular_faces, "face", "faces") + ", " +
            number(file.refined_faces) + " refined since they may touch the hull, to within " +
            number(file.deviation_bound, 2) + "\n";
  }
  if (file.free_vertices > 0) text += "  points    " + number(file.free_vertices) + "\n";
  if (file.trimmed > 0) {
    text += "  trimmed   " + counted(file.trimmed, "face", "faces") +
            ", which cannot be evaluated yet: the box is not known\n";
  }
  if (file.resolution) {
    text += "  resolution  " + number(file.resolution->rho, 3) + ": " +
            reason_of(*file.resolution) + "\n";
    if (file.summary.patches > 0) {
      text += "  worst join  " + number(file.resolution->worst_join, 3) + "\n";
    }
  }
  text += std::string("  rational  ") +
          (file.rational > 0 ? "yes, " + number(file.rational) + " of the patches and curves"
                             : std::string("no")) +
          "\n";
  if (names) {
    for (std::size_t i = 0; i < file.face_names.size(); ++i) {
      text += "  face " + number(long(i)) + "  " + one_line(file.face_names[i]) + "\n";
    }
  }
  return text;
}

/// Puts parts and instances of several models together.
class Collection {
 public:
  void add(const Model& model) {
    const int first = int(all_.parts().size());
    if (unit_.empty()) unit_ = model.unit();
    // Parts are connected already, by the angle they were read with.
    for (const Part& part : model.parts()) all_.add_part(part, 0);
    for (const Instance& instance : model.instances()) {
      instances_.push_back({first + instance.part, instance.pose});
    }
  }
  Model take() {
    all_.set_unit(unit_);
    all_.clear_instances();
    for (const Instance& instance : instances_) all_.add_instance(instance.part, instance.pose);
    return std::move(all_);
  }

 private:
  Model all_;
  std::vector<Instance> instances_;
  std::string unit_;  ///< the first that is known
};

struct InfoArguments {
  InputArguments inputs;
  std::string output;  ///< the model document that all inputs are written to, or empty
  std::optional<double> resolution;

  std::string output_format() const {
    return output == "-" ? inputs.output_extension() : extension(output);
  }
};

void check_output(const InfoArguments& arguments, bool json) {
  const std::string& output = arguments.output;
  const std::string format = arguments.output_format();
  if (output == "-" && format.empty()) {
    throw UsageError("standard output needs its format, such as --to taut.json");
  }
  if (format != ".taut.json" && format != ".taut.cbor") {
    throw UsageError((output == "-" ? format : output) +
                     ": a model is written as .taut.json or .taut.cbor only");
  }
  if (output == "-" && json) throw UsageError("only one thing can be written to standard output");
  check_outputs({}, "", output, arguments.inputs.files);
}

/// "-" is standard output.
void write_document(const InfoArguments& arguments, const Model& model, Console& console) {
  if (arguments.output == "-") {
    console.print(to_document(model, arguments.output_format() == ".taut.json"
                                         ? DocumentEncoding::json
                                         : DocumentEncoding::cbor));
    return;
  }
  write_model(arguments.output, model);
}

ExitCode run(const InfoArguments& arguments, Console& console) {
  const auto& [inputs, output, resolution] = arguments;
  if (!output.empty()) check_output(arguments, console.options().json);
  std::vector<Contents> files;
  Collection collection;
  double seconds_read = 0;
  double seconds_build = 0;
  for (const std::string& file : inputs.files) {
    InputArguments one = inputs;
    one.files = {file};
    Input input(one, console);
    files.push_back(contents(input, resolution, console.progress()));
    seconds_read += input.seconds_read();
    seconds_build += input.seconds_build();
    if (!output.empty()) collection.add(input.model());
  }
  if (!output.empty()) {
    write_document(arguments, collection.take(), console);
    if (output == "-") return ExitCode::done;
  }
  if (console.options().json) {
    Json list = Json::array();
    for (const Contents& file : files) list.push_back(json_of(file));
    console.print(text(
        Json{{"taut", TAUT_VERSION},
             {"input", to_json(total(files))},
             {"files", std::move(list)},
             {"seconds",
              {{"read", seconds_read}, {"build", seconds_build}, {"total", console.seconds()}}},
             {"peak_bytes", peak_bytes()},
             {"warnings", to_json(console.warnings())}}));
    return ExitCode::done;
  }
  for (const Contents& file : files) console.print(text_of(file, console.options().verbose));
  if (files.size() > 1) console.print("all together\n" + sizes_text(total(files)));
  if (!output.empty() && !console.options().quiet)
    console.print("wrote " + one_line(output) + "\n");
  return ExitCode::done;
}

}  // namespace

Command add_info(CLI::App& parent) {
  Command command = add_command(parent, "info", "What the inputs hold",
                                "Examples:\n"
                                "  taut info teapot.bpt\n"
                                "  taut info a.bpt b.obj --json\n"
                                "  taut info a.bpt b.obj -o both.taut.json");
  const auto arguments = std::make_shared<InfoArguments>();
  add_inputs(*command.app, arguments->inputs);
  add_resolution(*command.app, arguments->resolution);
  command.app
      ->add_option(
          "-o,--output", arguments->output,
          "Model document that all inputs are written to: .taut.json,\n.taut.cbor; - is standard "
          "output, see --to")
      ->option_text("FILE");
  add_output_format(*command.app, arguments->inputs);
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool
