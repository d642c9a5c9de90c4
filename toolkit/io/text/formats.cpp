#include "taut/io/text/formats.h"

#include <array>

namespace taut {

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      {".bpt", "Bezier patches", true, false, false},
      {".csv", "Points as text, one a line, perhaps under a line of names", true, false, false},
      {".hull.cbor", "Taut's exact hull document, binary", false, false, false, true, true},
      {".hull.json", "Taut's exact hull document", false, false, false, true, true},
      {".mlp", "MeshLab project: layers under matrices", true, false, false, false, true},
      {".obj", "Wavefront OBJ: free-form surfaces and curves, polygons, points", true, true, true},
      {".off", "Object File Format polygons", true, true, true},
      {".ply", "Polygon File Format, ascii and binary", true, true, true},
      {".pts", "Points as text, one a line, perhaps under their number", true, false, false},
      {".stl", "STL triangles, ascii and binary", true, true, true},
      {".taut.cbor", "Taut's exact model document, binary", true, false, false},
      {".taut.json", "Taut's exact model document", true, false, false},
      {".txt", "Points as text, one a line, perhaps under a line of names", true, false, false},
      {".xyz", "Points as text, one a line", true, false, false},
  };
  return all;
}

std::string extension(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  // By hand, since std::tolower follows the locale.
  for (char& c : name) {
    if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  for (const char* double_extension : {".taut.json", ".taut.cbor", ".hull.json", ".hull.cbor"}) {
    if (name.ends_with(double_extension)) return double_extension;
  }
  return std::filesystem::path(name).extension().string();
}

std::string input_extension(const std::filesystem::path& path) {
  const std::string own = extension(path);
  if (own != ".gz") return own;
  std::filesystem::path inner = path.filename();
  return extension(inner.replace_extension());
}

std::string advice_on(const std::string& extension) {
  struct Plugin {
    const char* name;
    const char* files;
    std::vector<std::string_view> extensions;
  };
  static const std::array<Plugin, 2> plugins = {
      {{"occt", "STEP, IGES and BREP", {".step", ".stp", ".iges", ".igs", ".brep"}},
       {"irit", "IRIT", {".itd"}}}};
  for (const Plugin& plugin : plugins) {
    for (const std::string_view known : plugin.extensions) {
      if (known != extension) continue;
      return std::string(plugin.files) + " files are read by the plugin " + plugin.name +
             ", which is not at hand; export free-form surfaces as .obj, or the model as .stl";
    }
  }
  return {};
}

}  // namespace taut
