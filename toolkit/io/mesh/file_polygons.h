#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// The faces of a hull mesh as a file takes them: polygons of a limited number of vertices.
class FilePolygons {
 public:
  /// Larger faces are split along diagonals, into convex pieces of the same vertices. No piece has
  /// all its corners on one line unless its face has. The two sides of a planar hull have no
  /// diagonal in common.
  /// @pre faces are convex; most >= 3
  FilePolygons(const HullMesh& mesh, std::size_t most);

  std::size_t size() const { return faces_.size(); }
  /// Vertex indices, counter-clockwise from outside.
  std::span<const int> corners(std::size_t i) const {
    return std::span(corners_).subspan(ends_[i], ends_[i + 1] - ends_[i]);
  }
  /// The mesh face that the polygon is part of.
  OpenMesh::FaceHandle face(std::size_t i) const { return OpenMesh::FaceHandle(faces_[i]); }

 private:
  void add(int face, const std::vector<int>& polygon);

  std::vector<int> corners_;
  std::vector<std::size_t> ends_ = {0};
  std::vector<int> faces_;
};

}  // namespace taut
