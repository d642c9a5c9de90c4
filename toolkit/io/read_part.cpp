#include "taut/io/read_part.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "taut/io/mesh_readers.h"
#include "taut/io/read_bpt.h"
#include "taut/io/read_obj.h"
#include "taut/io/read_xyz.h"

namespace taut {

bool is_part_format(std::string_view format) {
  constexpr std::array<std::string_view, 6> all = {".bpt", ".obj", ".off", ".ply", ".stl", ".xyz"};
  return std::find(all.begin(), all.end(), format) != all.end();
}

FileContent read_content(std::string_view data, const std::string& name, std::string_view format,
                         const ReadOptions& options) {
  const Progress& progress = options.progress;
  progress.check();
  if (format == ".bpt") return {read_bpt(name, data, progress), {}};
  if (format == ".obj") return read_obj(name, data, options);
  FileContent content;
  if (format == ".off") content.mesh = read_off(name, data, progress);
  if (format == ".ply") content.mesh = read_ply(name, data, progress);
  if (format == ".stl") content.mesh = read_stl(name, data, progress);
  if (format == ".xyz") content.mesh.points = read_xyz(name, data, progress);
  if (asks_for_cage(options) && !content.mesh.polygons.empty()) {
    throw IoError(name + ": " + std::string(cages_are_not_evaluated));
  }
  return content;
}

Part as_part(FileContent content, const std::string& name) {
  Part part = std::move(content.part);
  try {
    part.add_polygons(content.mesh);
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
