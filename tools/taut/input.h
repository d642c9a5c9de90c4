#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "taut/bounds/scene.h"
#include "taut/io/report/report.h"

namespace taut::tool {

using Json = nlohmann::ordered_json;

/// Which files make the model, and how they are read.
struct InputArguments {
  std::vector<std::string> files;  ///< "-" is standard input
  std::string format;              ///< of standard input and output; may begin with a dot
  std::string from;                ///< of standard input, before `format`
  std::string to;                  ///< of standard output, before `format`
  std::string scheme;              ///< empty: by the files
  std::optional<double> cage_accuracy;

  /// The format of both as an extension, with its dot; empty if it is not given.
  std::string extension() const;
  /// Those of standard input and output.
  std::string input_extension() const;
  std::string output_extension() const;
};

/// Input files read as one model, and its scene where that is asked for.
class Input {
 public:
  /// Reads the files. @throws UsageError for standard input without a format, IoError, InvalidInput
  /// (also where a file holds no geometry)
  Input(const InputArguments& arguments, Console& console);

  const Model& model() const { return scene_ ? scene_->model() : model_; }
  /// Built when it is first asked for. @throws InvalidInput for trimmed faces
  const Scene& scene();
  /// Counts and sizes. The box of points and polygons needs no scene; that of trimmed faces is
  /// not known, and stays empty.
  Report::Input summary();
  /// The diagonal of that box.
  double diagonal();

  /// The file that each of the model's parts was read from.
  const std::vector<std::string>& part_files() const { return part_files_; }

  double seconds_read() const { return seconds_read_; }
  double seconds_build() const { return seconds_build_; }

 private:
  Console& console_;
  std::vector<std::string> files_;
  std::vector<std::string> part_files_;
  Model model_;
  std::optional<Scene> scene_;
  double seconds_read_ = 0;
  double seconds_build_ = 0;
};

/// Faces with trim loops, over all instances.
int trimmed_face_count(const Model& model);

/// Adds the positional arguments INPUT... and the options on how to read them.
void add_inputs(CLI::App& command, InputArguments& arguments);

/// Adds the option --to, of commands that write to standard output.
void add_output_format(CLI::App& command, InputArguments& arguments);

Json to_json(const Box& box);
Json to_json(const Report::Input& input);
Json to_json(const std::vector<Warning>& warnings);
/// The text of a JSON document as commands print it, with the line's end; bytes that are no UTF-8
/// (file names may hold any) are replaced.
std::string text(const Json& json);

}  // namespace taut::tool
