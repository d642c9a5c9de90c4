#include "taut/io/mesh/read_mesh.h"

#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/gunzip.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

using Reader = PolygonMesh (*)(const std::string& file, std::string_view data, const Progress&);

Reader reader(const std::string& name, const std::string& format) {
  if (format == ".obj") return read_obj_polygons;
  if (format == ".off") return read_off;
  if (format == ".ply") return read_ply;
  if (format == ".stl") return read_stl;
  throw IoError(name + ": no format of meshes has the extension " + in_quotes(format) +
                "; known are .obj, .off, .ply, .stl");
}

}  // namespace

PolygonMesh read_mesh(const std::filesystem::path& path) {
  const Reader read = reader(path.string(), input_extension(path));
  return read(path.string(), read_file(path), {});
}

PolygonMesh read_mesh(std::string_view data, const std::string& name, const std::string& format) {
  const Reader read = reader(name, format);
  return is_gzipped(data) ? read(name, gunzipped(name, data), {}) : read(name, data, {});
}

}  // namespace taut
