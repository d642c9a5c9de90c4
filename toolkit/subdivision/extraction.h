#pragma once

#include <opensubdiv/far/topologyLevel.h>

#include <cstddef>
#include <span>
#include <vector>

namespace taut {

/// For each of some components those that are incident to it.
class Incidence {
 public:
  /// Those of the next component.
  void append(const std::vector<int>& items) {
    items_.insert(items_.end(), items.begin(), items.end());
    first_.push_back(items_.size());
  }
  std::size_t size() const { return first_.size() - 1; }
  std::span<const int> operator[](std::size_t i) const {
    return {items_.data() + first_[i], first_[i + 1] - first_[i]};
  }

 private:
  std::vector<int> items_;
  std::vector<std::size_t> first_ = {0};
};

/// Some faces of a level as a cage of their own, with the edges that they have there.
///
/// No pair of vertices stands for an edge: two edges have the same ends where an edge from a vertex
/// to itself was halved, or where each of two triangles has an edge between the middles of two
/// sides that they share.
class Extraction {
 public:
  /// The first `own` faces, which must be distinct, are to have a surface; the others become holes.
  Extraction(const OpenSubdiv::Far::TopologyLevel& level, std::vector<int> faces, std::size_t own);

  /// @name What there is
  /// All by their numbers in the level, in the order of the new ones.
  /// @{
  const std::vector<int>& faces() const { return faces_; }
  const std::vector<int>& edges() const { return edges_; }
  const std::vector<int>& vertices() const { return vertices_; }
  /// @}

  /// @name Incident components
  /// By new numbers, counter-clockwise around faces, and around manifold vertices, at the boundary
  /// from its one edge to the other.
  /// @{
  const Incidence& face_vertices() const { return face_vertices_; }
  const Incidence& face_edges() const { return face_edges_; }
  const Incidence& edge_vertices() const { return edge_vertices_; }
  const Incidence& edge_faces() const { return edge_faces_; }
  const Incidence& vertex_faces() const { return vertex_faces_; }
  const Incidence& vertex_edges() const { return vertex_edges_; }
  /// @}

  /// @name Tags
  /// By new numbers.
  /// @{
  bool is_hole(std::size_t face) const { return face >= own_; }
  bool is_manifold_edge(std::size_t edge) const { return is_manifold_edge_[edge]; }
  bool is_manifold_vertex(std::size_t vertex) const { return is_manifold_vertex_[vertex]; }
  float edge_sharpness(std::size_t edge) const { return level_.GetEdgeSharpness(edges_[edge]); }
  float vertex_sharpness(std::size_t v) const { return level_.GetVertexSharpness(vertices_[v]); }
  /// @}

 private:
  /// A face about a vertex, which it enters along one edge and leaves along another.
  struct Corner {
    int face, entering, leaving;
  };
  std::vector<Corner> corners(int vertex) const;
  void add_edge(int edge);
  void add_vertex(int vertex);

  const OpenSubdiv::Far::TopologyLevel& level_;
  std::size_t own_;
  std::vector<int> faces_, edges_, vertices_;
  std::vector<int> face_number_, edge_number_, vertex_number_;  // by those of the level; or -1
  Incidence face_vertices_, face_edges_, edge_vertices_, edge_faces_, vertex_faces_, vertex_edges_;
  std::vector<bool> is_manifold_edge_, is_manifold_vertex_;
};

/// Some faces and, behind them, all others that touch their vertices.
std::vector<int> with_surroundings(const OpenSubdiv::Far::TopologyLevel& level,
                                   std::vector<int> faces);

}  // namespace taut
