#include "input.h"

#include <utility>

#include "exit_code.h"
#include "taut/io/read_model.h"
#include "text.h"

namespace taut::tool {

Report::Input Input::summary() const {
  const Model& model = scene.model();
  Report::Input summary;
  summary.files = files;
  summary.faces = model.face_count();
  summary.edges = model.edge_count();
  summary.vertices = model.vertex_count();
  summary.patches = model.patch_count();
  summary.diagonal = scene.diagonal();
  summary.box = scene.box();
  return summary;
}

Input load(const std::vector<std::string>& files, Console& console) {
  const Stopwatch reading;
  Model model;
  ReadOptions options;
  options.progress = console.progress();
  for (const std::string& file : files) {
    if (file == "-") {
      throw UsageError("a model cannot be read from standard input: give a file's name");
    }
    read_model(file, model, options);
    if (model.parts().empty() || model.parts().back().control_box().empty()) {
      throw InvalidInput(file + ": holds no geometry");
    }
  }
  const double seconds_read = reading.seconds();
  const Stopwatch building;
  Scene scene(std::move(model), {console.options().threads, console.progress()});
  console.note("the scene takes " + number(double(scene.memory()) / 1e6, 3) + " MB");
  return {files, std::move(scene), seconds_read, building.seconds()};
}

void add_inputs(CLI::App& command, std::vector<std::string>& files) {
  command.add_option("INPUT", files, "Model files; several make one model together")
      ->required()
      ->option_text("FILE...");
}

Json to_json(const Box& box) {
  const auto point = [](const dvec3& p) { return Json::array({p.x, p.y, p.z}); };
  return Json::array({point(box.lower), point(box.upper)});
}

Json to_json(const Report::Input& input) {
  return {{"files", input.files},       {"faces", input.faces},     {"edges", input.edges},
          {"vertices", input.vertices}, {"patches", input.patches}, {"diagonal", input.diagonal},
          {"box", to_json(input.box)}};
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
