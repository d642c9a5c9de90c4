#include "taut/io/mesh/file_polygons.h"

#include <algorithm>
#include <set>
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

using Diagonals = std::set<std::pair<int, int>>;

/// Cuts as evenly as leaves both halves an area: a diagonal along a side that has further vertices
/// on it would not. Where there is an area at all, some diagonal is left.
///
/// Avoids `taken` diagonals and adds its own. One is always left: those that are taken come from
/// another cutting of the same outline, so they do not cross, and k corners have more diagonals
/// than the k - 3 of them that do not cross.
Halves halved(const HullMesh& mesh, const std::vector<int>& polygon, Diagonals* taken) {
  const std::size_t even = polygon.size() / 2 + 1;
  for (std::size_t count = even; count >= 3; --count) {
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      const std::pair<int, int> diagonal =
          std::minmax(polygon[first], polygon[(first + count - 1) % polygon.size()]);
      if (taken != nullptr && taken->contains(diagonal)) continue;
      Halves halves = cut(polygon, first, count);
      if (!all_on_one_line(mesh, halves.first) && !all_on_one_line(mesh, halves.second)) {
        if (taken != nullptr) taken->insert(diagonal);
        return halves;
      }
    }
  }
  return cut(polygon, 0, even);
}

/// The pieces, in order.
void split(const HullMesh& mesh, std::vector<int> polygon, std::size_t most, Diagonals* taken,
           std::vector<std::vector<int>>& pieces) {
  if (polygon.size() <= most) {
    pieces.push_back(std::move(polygon));
    return;
  }
  Halves halves = halved(mesh, polygon, taken);
  split(mesh, std::move(halves.first), most, taken, pieces);
  split(mesh, std::move(halves.second), most, taken, pieces);
}

}  // namespace

FilePolygons::FilePolygons(const HullMesh& mesh, std::size_t most) {
  faces_.reserve(mesh.n_faces());
  ends_.reserve(mesh.n_faces() + 1);
  corners_.reserve(2 * mesh.n_edges());
  // A diagonal of both sides of a planar hull would be an edge of four polygons.
  Diagonals of_both_sides;
  Diagonals* taken = mesh.n_faces() == 2 ? &of_both_sides : nullptr;
  std::vector<int> polygon;
  std::vector<std::vector<int>> pieces;
  for (const auto face : mesh.faces()) {
    polygon.clear();
    for (const auto vertex : mesh.fv_ccw_range(face)) polygon.push_back(vertex.idx());
    if (polygon.size() <= most) {
      add(face.idx(), polygon);
      continue;
    }
    pieces.clear();
    split(mesh, polygon, most, taken, pieces);
    for (const std::vector<int>& piece : pieces) add(face.idx(), piece);
  }
}

void FilePolygons::add(int face, const std::vector<int>& polygon) {
  corners_.insert(corners_.end(), polygon.begin(), polygon.end());
  ends_.push_back(corners_.size());
  faces_.push_back(face);
}

}  // namespace taut
