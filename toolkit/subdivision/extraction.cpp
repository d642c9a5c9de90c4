#include "taut/subdivision/extraction.h"

#include <algorithm>
#include <utility>

#include "taut/core/integers.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Vtr = OpenSubdiv::Vtr;

/// The new numbers of some components, which are given to those that have none.
std::vector<int> numbered(const Vtr::ConstIndexArray& components, std::vector<int>& number,
                          std::vector<int>& originals) {
  std::vector<int> result;
  result.reserve(to_size(components.size()));
  for (const int c : components) {
    int& n = number[to_size(c)];
    if (n < 0) {
      n = to_int(originals.size());
      originals.push_back(c);
    }
    result.push_back(n);
  }
  return result;
}

/// The new numbers of those that have one.
std::vector<int> extracted(const Vtr::ConstIndexArray& components, const std::vector<int>& number) {
  std::vector<int> result;
  for (const int c : components) {
    if (number[to_size(c)] >= 0) result.push_back(number[to_size(c)]);
  }
  return result;
}

/// It has two ends, and no more than two faces, which run along it in opposite directions.
bool is_manifold(const Far::TopologyLevel& level, int edge) {
  const auto ends = level.GetEdgeVertices(edge);
  const auto faces = level.GetEdgeFaces(edge);
  if (ends[0] == ends[1] || faces.size() > 2) return false;
  if (faces.size() < 2) return true;
  const auto places = level.GetEdgeFaceLocalIndices(edge);
  return level.GetFaceVertices(faces[0])[places[0]] != level.GetFaceVertices(faces[1])[places[1]];
}

/// Into counter-clockwise order; false if they are no fan.
template <class Corner>
bool order(std::vector<Corner>& corners) {
  const auto follows = [](const Corner& a) {
    return [&a](const Corner& b) { return b.leaving == a.entering; };
  };
  const auto is_first = [&](const Corner& a) {
    return std::none_of(corners.begin(), corners.end(),
                        [&](const Corner& b) { return b.entering == a.leaving; });
  };
  const auto first = std::find_if(corners.begin(), corners.end(), is_first);
  if (first != corners.end()) std::iter_swap(corners.begin(), first);
  for (auto last = corners.begin(); last + 1 != corners.end(); ++last) {
    const auto next = std::find_if(last + 1, corners.end(), follows(*last));
    if (next == corners.end()) return false;
    std::iter_swap(last + 1, next);
  }
  return true;
}

}  // namespace

Extraction::Extraction(const Far::TopologyLevel& level, std::vector<int> faces, std::size_t own)
    : level_(level),
      own_(own),
      faces_(std::move(faces)),
      face_number_(to_size(level.GetNumFaces()), -1),
      edge_number_(to_size(level.GetNumEdges()), -1),
      vertex_number_(to_size(level.GetNumVertices()), -1) {
  for (std::size_t i = 0; i < faces_.size(); ++i) face_number_[to_size(faces_[i])] = to_int(i);
  for (const int f : faces_) {
    face_vertices_.append(numbered(level.GetFaceVertices(f), vertex_number_, vertices_));
    face_edges_.append(numbered(level.GetFaceEdges(f), edge_number_, edges_));
  }
  for (const int e : edges_) add_edge(e);
  for (const int v : vertices_) add_vertex(v);
}

void Extraction::add_edge(int edge) {
  edge_vertices_.append(extracted(level_.GetEdgeVertices(edge), vertex_number_));
  edge_faces_.append(extracted(level_.GetEdgeFaces(edge), face_number_));
  is_manifold_edge_.push_back(is_manifold(level_, edge));
}

std::vector<Extraction::Corner> Extraction::corners(int vertex) const {
  std::vector<Corner> result;
  const auto faces = level_.GetVertexFaces(vertex);
  const auto places = level_.GetVertexFaceLocalIndices(vertex);
  for (int i = 0; i < faces.size(); ++i) {
    const int face = face_number_[to_size(faces[i])];
    if (face < 0) continue;
    const std::span<const int> edges = face_edges_[to_size(face)];
    const std::size_t place = places[i];
    result.push_back({face, edges[(place + edges.size() - 1) % edges.size()], edges[place]});
  }
  return result;
}

/// In the level's order they may begin elsewhere, and are in none where it was no manifold. About a
/// vertex that a face has more than once OpenSubdiv finds the face's corners only where the vertex
/// is no manifold.
void Extraction::add_vertex(int vertex) {
  std::vector<int> faces = extracted(level_.GetVertexFaces(vertex), face_number_);
  const bool repeats = std::adjacent_find(faces.begin(), faces.end()) != faces.end();
  std::vector<int> edges = extracted(level_.GetVertexEdges(vertex), edge_number_);
  std::vector<Corner> fan = corners(vertex);
  const bool manifold = !repeats && std::all_of(edges.begin(), edges.end(), [&](int e) {
    return is_manifold_edge(to_size(e));
  }) && order(fan);
  if (manifold) {
    for (std::size_t i = 0; i < fan.size(); ++i) {
      faces[i] = fan[i].face;
      edges[i] = fan[i].leaving;
    }
    if (edges.size() > fan.size()) edges.back() = fan.back().entering;
  }
  is_manifold_vertex_.push_back(manifold);
  vertex_faces_.append(faces);
  vertex_edges_.append(edges);
}

std::vector<int> with_surroundings(const Far::TopologyLevel& level, std::vector<int> faces) {
  std::vector<bool> taken(to_size(level.GetNumFaces()));
  for (const int f : faces) taken[to_size(f)] = true;
  const std::size_t own = faces.size();
  for (std::size_t i = 0; i < own; ++i) {
    const auto vertices = level.GetFaceVertices(faces[i]);
    for (int k = 0; k < vertices.size(); ++k) {
      const auto around = level.GetVertexFaces(vertices[k]);
      for (int j = 0; j < around.size(); ++j) {
        if (taken[to_size(around[j])]) continue;
        taken[to_size(around[j])] = true;
        faces.push_back(around[j]);
      }
    }
  }
  return faces;
}

}  // namespace taut
