#include "taut/subdivision/extraction.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }
int to_int(std::size_t n) { return static_cast<int>(n); }

}  // namespace

Extraction::Extraction(const Far::TopologyLevel& level)
    : level_(level), number_(to_size(level.GetNumVertices()), -1) {}

void Extraction::add_face(int face, bool hole) {
  if (hole) out_.holes.push_back(to_int(out_.sizes.size()));
  const auto vertices = level_.GetFaceVertices(face);
  out_.sizes.push_back(vertices.size());
  for (int i = 0; i < vertices.size(); ++i) out_.vertices.push_back(number(vertices[i]));
  const auto edges = level_.GetFaceEdges(face);
  for (int i = 0; i < edges.size(); ++i) edges_.push_back(edges[i]);
}

Description Extraction::take() {
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  for (const int e : edges_) {
    const float sharpness = level_.GetEdgeSharpness(e);
    if (sharpness <= 0) continue;
    const auto ends = level_.GetEdgeVertices(e);
    for (int k = 0; k < 2; ++k) out_.crease_vertices.push_back(number_[to_size(ends[k])]);
    out_.crease_sharpness.push_back(sharpness);
  }
  for (std::size_t i = 0; i < originals_.size(); ++i) {
    const float sharpness = level_.GetVertexSharpness(originals_[i]);
    if (sharpness <= 0) continue;
    out_.corner_vertices.push_back(to_int(i));
    out_.corner_sharpness.push_back(sharpness);
  }
  out_.point_count = originals_.size();
  return std::move(out_);
}

int Extraction::number(int vertex) {
  int& n = number_[to_size(vertex)];
  if (n < 0) {
    n = to_int(originals_.size());
    originals_.push_back(vertex);
  }
  return n;
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
