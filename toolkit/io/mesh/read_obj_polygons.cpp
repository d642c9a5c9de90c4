#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/mesh/obj_reference.h"
#include "taut/io/text/text_scanner.h"

namespace taut {

PolygonMesh read_obj_polygons(const std::string& file, std::string_view data,
                              const Progress& progress) {
  constexpr std::size_t statements_per_update = 65536;
  TextScanner scanner(file, data);
  const double bytes = static_cast<double>(scanner.bytes_left());
  PolygonMesh mesh;
  ObjReferences references;
  std::vector<Word> statement;
  for (std::size_t i = 0; scanner.next_statement(statement); ++i) {
    if (i % statements_per_update == 0) {
      progress.update("read", 1 - static_cast<double>(scanner.bytes_left()) / bytes);
    }
    const std::string_view keyword = statement[0].text;
    if (keyword == "v") mesh.points.push_back(obj_point(scanner, statement));
    if (keyword == "f" || keyword == "fo") {
      add_obj_polygon(scanner, statement, mesh.points.size(), references, mesh.polygons);
    }
  }
  references.check(scanner, mesh.points.size());
  return mesh;
}

}  // namespace taut
