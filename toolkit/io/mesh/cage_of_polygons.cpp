#include "taut/io/mesh/cage_of_polygons.h"

#include <utility>

namespace taut {

ControlCage cage_of(PolygonMesh mesh, Scheme scheme) {
  ControlCage cage;
  cage.scheme = scheme == Scheme::loop ? CageScheme::loop : CageScheme::catmark;
  constexpr int unused = -1;
  std::vector<int> number(mesh.points.size(), unused);
  for (std::vector<int>& polygon : mesh.polygons) {
    for (int& v : polygon) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n == unused) {
        n = static_cast<int>(cage.points.size());
        cage.points.push_back(mesh.points[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
  }
  cage.faces = std::move(mesh.polygons);
  return cage;
}

}  // namespace taut
