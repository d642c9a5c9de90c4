#include "taut/io/file_polygons.h"

#include <algorithm>
#include <utility>

#include "taut/core/predicates.h"

namespace taut {
namespace {

bool all_on_one_line(const HullMesh& mesh, const std::vector<int>& polygon) {
  const auto at = [&](std::size_t i) { return position(mesh, OpenMesh::VertexHandle(polygon[i])); };
  std::size_t second = 1;
  while (second < polygon.size() && at(second) == at(0)) ++second;
  for (std::size_t i = second + 1; i < polygon.size(); ++i) {
    if (!collinear(at(0), at(second), at(i))) return false;
  }
  return true;
}

using Halves = std::pair<std::vector<int>, std::vector<int>>;

/// Cuts off `count` corners from `first` on, cyclically; both halves keep the diagonal's ends.
Halves cut(std::vector<int> polygon, std::size_t first, std::size_t count) {
  std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
  const auto middle = polygon.begin() + static_cast<std::ptrdiff_t>(count) - 1;
  Halves halves = {{polygon.begin(), middle + 1}, {middle, polygon.end()}};
  halves.second.push_back(polygon.front());
  return halves;
}

/// Cuts as evenly as leaves both halves an area: a diagonal along a side that has further vertices
/// on it would not. Where there is an area at all, some diagonal is left.
Halves halved(const HullMesh& mesh, const std::vector<int>& polygon) {
  const std::size_t even = polygon.size() / 2 + 1;
  for (std::size_t count = even; count >= 3; --count) {
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      Halves halves = cut(polygon, first, count);
      if (!all_on_one_line(mesh, halves.first) && !all_on_one_line(mesh, halves.second)) {
        return halves;
      }
    }
  }
  return cut(polygon, 0, even);
}

}  // namespace

FilePolygons::FilePolygons(const HullMesh& mesh, std::size_t most) {
  faces_.reserve(mesh.n_faces());
  ends_.reserve(mesh.n_faces() + 1);
  for (const auto face : mesh.faces()) {
    std::vector<int> polygon;
    for (const auto vertex : mesh.fv_ccw_range(face)) polygon.push_back(vertex.idx());
    add(mesh, face.idx(), std::move(polygon), most);
  }
}

void FilePolygons::add(const HullMesh& mesh, int face, std::vector<int> polygon, std::size_t most) {
  if (polygon.size() > most) {
    Halves halves = halved(mesh, polygon);
    add(mesh, face, std::move(halves.first), most);
    add(mesh, face, std::move(halves.second), most);
    return;
  }
  corners_.insert(corners_.end(), polygon.begin(), polygon.end());
  ends_.push_back(corners_.size());
  faces_.push_back(face);
}

}  // namespace taut
