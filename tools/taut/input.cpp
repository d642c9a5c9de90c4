#include "input.h"

#include <algorithm>
#include <utility>

#include "exit_code.h"
#include "standard_input.h"
#include "taut/io/model/read_model.h"
#include "text.h"

namespace taut::tool {

namespace {

std::optional<Scheme> scheme_of(const std::string& name) {
  if (name == "bilinear") return Scheme::bilinear;
  if (name == "catmark") return Scheme::catmark;
  if (name == "loop") return Scheme::loop;
  return {};
}

/// @throws UsageError, IoError
void read_from_standard_input(const InputArguments& arguments, Model& model,
                              const ReadOptions& options) {
  const std::string format = arguments.input_extension();
  if (format.empty()) throw UsageError("standard input needs its format, such as --from ply");
  read_model(read_standard_input(options.progress.stop), standard_input, format, model, options);
}

/// A format as an extension: ".ply" for "ply"; an empty one stays so.
std::string with_dot(const std::string& format) {
  return format.empty() || format.starts_with(".") ? format : "." + format;
}

}  // namespace

std::string InputArguments::extension() const { return with_dot(format); }

std::string InputArguments::input_extension() const {
  return from.empty() ? extension() : with_dot(from);
}

std::string InputArguments::output_extension() const {
  return to.empty() ? extension() : with_dot(to);
}

Input::Input(const InputArguments& arguments, Console& console)
    : console_(console), files_(arguments.files) {
  const Stopwatch watch;
  ReadOptions options;
  options.progress = console.progress();
  options.scheme = scheme_of(arguments.scheme);
  options.cage_accuracy = arguments.cage_accuracy.value_or(default_cage_accuracy);
  if (std::count(files_.begin(), files_.end(), "-") > 1) {
    throw UsageError("standard input can be read only once");
  }
  for (const std::string& file : files_) {
    if (file == "-") {
      read_from_standard_input(arguments, model_, options);
    } else {
      read_model(file, model_, options);
    }
    part_files_.resize(model_.parts().size(), file == "-" ? std::string(standard_input) : file);
    if (model_.empty()) throw InvalidInput(file + ": holds no geometry");
  }
  seconds_read_ = watch.seconds();
}

const Scene& Input::scene() {
  if (!scene_) {
    const Stopwatch watch;
    scene_.emplace(std::move(model_),
                   SceneOptions{console_.options().threads, console_.progress()});
    seconds_build_ = watch.seconds();
    console_.note("the scene takes " + number(double(scene_->memory()) / 1e6, 3) + " MB");
  }
  return *scene_;
}

Report::Input Input::summary() {
  Report::Input summary;
  summary.files = files_;
  summary.faces = model().face_count();
  summary.edges = model().edge_count();
  summary.vertices = model().vertex_count();
  summary.patches = model().patch_count();
  for (const Instance& instance : model().instances()) {
    const Part& part = model().parts()[std::size_t(instance.part)];
    summary.curves += int(std::count_if(part.edges().begin(), part.edges().end(),
                                        [](const Edge& edge) { return edge.faces.empty(); }));
    summary.points += part.point_count();
  }
  summary.unit = model().unit();
  if (model().polyhedral()) {
    summary.box = model().control_box();
  } else if (trimmed_face_count(model()) == 0) {
    summary.box = scene().box();
  }
  summary.diagonal = diagonal();
  return summary;
}

double Input::diagonal() {
  if (model().polyhedral()) return taut::diagonal(model().control_box());
  return trimmed_face_count(model()) > 0 ? 0 : scene().diagonal();
}

int trimmed_face_count(const Model& model) {
  long count = 0;
  for (const Instance& instance : model.instances()) {
    const std::vector<Face>& faces = model.parts()[std::size_t(instance.part)].faces();
    count += std::count_if(faces.begin(), faces.end(),
                           [](const Face& face) { return !face.loops.empty(); });
  }
  return int(count);
}

void add_inputs(CLI::App& command, InputArguments& arguments) {
  command
      .add_option("INPUT", arguments.files,
                  "Model files; several make one model together; - is standard\ninput")
      ->required()
      ->option_text("FILE...");
  command
      .add_option(
          "--format", arguments.format,
          "Format of what is read from standard input and written to\nstandard output: ply, "
          "obj, taut.json, ...")
      ->type_name("FORMAT");
  command.add_option("--from", arguments.from, "That of standard input alone")->type_name("FORMAT");
  command
      .add_option(
          "--scheme", arguments.scheme,
          "What polygons stand for: bilinear: themselves; catmark and loop: the\ncontrol cage of "
          "a subdivision surface. Default: bilinear, but of .obj\nfiles with the tags of a "
          "cage loop where all are triangles, else\ncatmark")
      ->check(CLI::IsMember({"bilinear", "catmark", "loop"}).description(""))
      ->type_name("bilinear|catmark|loop");
  add_positive(
      command, "--cage-accuracy", arguments.cage_accuracy,
      "What may be left of the exact surface of a control cage near\nextraordinary vertices, as "
      "a fraction of the diagonal; default 1e-9")
      ->type_name("R");
}

void add_output_format(CLI::App& command, InputArguments& arguments) {
  command.add_option("--to", arguments.to, "Format of what is written to standard output")
      ->type_name("FORMAT");
}

Json to_json(const Box& box) {
  const auto point = [](const dvec3& p) { return Json::array({p.x, p.y, p.z}); };
  return Json::array({point(box.lower), point(box.upper)});
}

Json to_json(const Report::Input& input) {
  return {{"files", input.files},
          {"faces", input.faces},
          {"edges", input.edges},
          {"vertices", input.vertices},
          {"patches", input.patches},
          {"curves", input.curves},
          {"points", input.points},
          {"unit", input.unit.empty() ? Json() : Json(input.unit)},
          {"diagonal", input.box.empty() ? Json() : Json(input.diagonal)},
          {"box", input.box.empty() ? Json() : to_json(input.box)}};
}

Json to_json(const std::vector<Warning>& warnings) {
  Json json = Json::array();
  for (const Warning& warning : warnings) {
    json.push_back({{"code", warning.code}, {"text", warning.text}});
  }
  return json;
}

std::string text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace taut::tool
