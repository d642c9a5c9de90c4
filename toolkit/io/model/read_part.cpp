#include "taut/io/model/read_part.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "taut/io/mesh/cage_of_polygons.h"
#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/model/read_bpt.h"
#include "taut/io/model/read_xyz.h"
#include "taut/io/obj/read_obj.h"
#include "taut/subdivision/add_cage.h"

namespace taut {

bool is_part_format(std::string_view format) {
  constexpr std::array<std::string_view, 5> others = {".bpt", ".obj", ".off", ".ply", ".stl"};
  return is_points_format(format) ||
         std::find(others.begin(), others.end(), format) != others.end();
}

FileContent read_content(std::string_view data, const std::string& name, std::string_view format,
                         const ReadOptions& options) {
  const Progress& progress = options.progress;
  progress.check();
  if (format == ".bpt") return {read_bpt(name, data, progress), {}, {}};
  if (format == ".obj") return read_obj(name, data, options);
  FileContent content;
  if (format == ".off") content.mesh = read_off(name, data, progress);
  if (format == ".ply") content.mesh = read_ply(name, data, progress);
  if (format == ".stl") content.mesh = read_stl(name, data, progress);
  if (is_points_format(format)) content.mesh.points = read_xyz(name, data, progress);
  const Scheme scheme = options.scheme.value_or(Scheme::bilinear);
  if (scheme == Scheme::bilinear || content.mesh.polygons.empty()) return content;
  if (format == ".stl") {
    throw IoError(name +
                  ": triangles of an STL file have no vertices in common, so they are no cage; "
                  "--scheme bilinear takes them as they are");
  }
  content.cage = cage_of(std::exchange(content.mesh, {}), scheme);
  return content;
}

Part as_part(FileContent content, const std::string& name, const ReadOptions& options) {
  Part part = std::move(content.part);
  try {
    part.add_polygons(content.mesh);
    if (content.cage) {
      add_cage(part, *content.cage, name, {options.cage_accuracy, options.progress});
    }
  } catch (const BackendError& error) {
    throw BackendError(name + ": " + error.what());
  } catch (const InvalidInput& error) {
    throw InvalidInput(name + ": " + error.what());
  } catch (const LimitExceeded& error) {
    throw LimitExceeded(name + ": " + error.what());
  }
  if (part.control_box().empty()) throw InvalidInput(name + ": holds no geometry");
  part.name = std::filesystem::path(name).filename().string();
  return part;
}

}  // namespace taut
