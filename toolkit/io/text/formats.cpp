#include "taut/io/text/formats.h"

namespace taut {

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      {".bpt", "Bezier patches", true, false, false},
      {".hull.cbor", "Taut's exact hull document, binary", false, false, false, true, true},
      {".hull.json", "Taut's exact hull document", false, false, false, true, true},
      {".mlp", "MeshLab project: layers under matrices", true, false, false, false, true},
      {".obj", "Wavefront OBJ: free-form surfaces and curves, polygons, points", true, true, true},
      {".off", "Object File Format polygons", true, true, true},
      {".ply", "Polygon File Format, ascii and binary", true, true, true},
      {".stl", "STL triangles, ascii and binary", true, true, true},
      {".taut.cbor", "Taut's exact model document, binary", true, false, false},
      {".taut.json", "Taut's exact model document", true, false, false},
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

}  // namespace taut
