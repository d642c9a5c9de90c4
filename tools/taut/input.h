#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "taut/bounds/scene.h"
#include "taut/io/report.h"

namespace taut::tool {

using Json = nlohmann::ordered_json;

/// Input files made ready for queries, as one scene.
struct Input {
  std::vector<std::string> files;
  Scene scene;
  double seconds_read = 0;
  double seconds_build = 0;

  /// Its counts and sizes.
  Report::Input summary() const;
};

/// Reads all files into one model and builds its scene.
/// @throws UsageError for "-", IoError, InvalidInput (also where a file holds no geometry)
Input load(const std::vector<std::string>& files, Console& console);

/// Adds the positional arguments INPUT...
void add_inputs(CLI::App& command, std::vector<std::string>& files);

Json to_json(const Box& box);
Json to_json(const Report::Input& input);
Json to_json(const std::vector<Warning>& warnings);
/// The text of a JSON document as commands print it, with the line's end; bytes that are no UTF-8
/// (file names may hold any) are replaced.
std::string text(const Json& json);

}  // namespace taut::tool
