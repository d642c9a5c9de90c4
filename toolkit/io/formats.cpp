#include "taut/io/formats.h"

namespace taut {

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      {".bpt", "Bezier patches", true, false, false},
      {".obj", "Wavefront OBJ: free-form surfaces and curves, polygons", true, true, true},
      {".off", "Object File Format polygons", false, true, true},
      {".ply", "Polygon File Format, ascii and binary", false, true, true},
      {".stl", "STL triangles, ascii and binary", false, true, true},
      {".taut.cbor", "Taut's exact model document, binary", true, false, false},
      {".taut.json", "Taut's exact model document", true, false, false},
  };
  return all;
}

std::string extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  // By hand, since std::tolower follows the locale.
  for (char& c : text) {
    if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (text != ".json" && text != ".cbor") return text;
  return extension(path.stem()) == ".taut" ? ".taut" + text : text;
}

}  // namespace taut
