#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace taut::tool {

/// Why outputs cannot be written, each a line that names its file; empty where they can be.
struct OutputPlaces {
  std::vector<std::string> hulls;
  std::string report;
};

/// Checks before any work is done whether the hulls (meshes, documents, projects with their layers)
/// and, if not empty, the report can be written. "-" is standard output, where a hull takes the
/// format of this extension.
/// @throws UsageError if no format writes a hull with such an extension, or a file is named twice
/// or is also an input; IoError if none of the files can be written and nothing goes to standard
/// output
OutputPlaces check_outputs(const std::vector<std::string>& hulls, const std::string& stdout_format,
                           const std::string& report, const std::vector<std::string>& inputs);

/// Writes a text file under a temporary name and renames it, so that it appears whole or not at
/// all. What is there and is no regular file (a pipe, a device) is written to.
/// @throws IoError
void write_text(const std::string& path, std::string_view text);

/// @throws IoError
void write_stdout(std::string_view text);

}  // namespace taut::tool
