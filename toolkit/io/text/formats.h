#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace taut {

/// A file format by its extension.
struct Format {
  std::string extension;     ///< with the dot, lower case: ".ply"
  std::string description;   ///< a few words
  bool reads_model = false;  ///< models of it are read
  bool reads_mesh = false;   ///< meshes of it are read as hulls to verify
  bool writes_mesh = false;  ///< meshes of hulls are written
  /// Hulls with what else is known of them: the exact faces, or layers of several files.
  bool reads_hull = false;
  bool writes_hull = false;  ///< hulls with what else is known of them are written
};

/// All formats of this library, sorted by extension.
const std::vector<Format>& formats();

/// The path's extension in lower case: ".ply"; empty if it has none. Taut's own documents have two
/// words in theirs: ".taut.json", ".taut.cbor", ".hull.json", ".hull.cbor".
std::string extension(const std::filesystem::path& path);

/// The extension of a file to read, which may be compressed: ".ply" of "a.ply.gz".
std::string input_extension(const std::filesystem::path& path);

/// How to come by a model in a format that is not read here, though others do: a sentence; empty
/// where nothing is known of the extension.
std::string advice_on(const std::string& extension);

}  // namespace taut
