#include "taut/hull/hull_mesh.h"

namespace taut {

PolygonMesh polygons(const HullMesh& mesh) {
  PolygonMesh result;
  for (const auto v : mesh.vertices()) result.points.push_back(position(mesh, v));
  for (const auto f : mesh.faces()) {
    std::vector<int> polygon;
    for (const auto v : mesh.fv_range(f)) polygon.push_back(v.idx());
    result.polygons.push_back(std::move(polygon));
  }
  return result;
}

}  // namespace taut
