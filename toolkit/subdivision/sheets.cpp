#include "taut/subdivision/sheets.h"

#include <algorithm>
#include <cstddef>

#include "taut/core/integers.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

}  // namespace

Sheets::Sheets(const Far::TopologyLevel& level) : level_(level) {
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    const auto vertices = level.GetFaceVertices(f);
    description_.sizes.push_back(vertices.size());
    first_.push_back(to_int(description_.vertices.size()));
    description_.vertices.insert(description_.vertices.end(), to_size(vertices.size()), -1);
    if (level.IsFaceHole(f)) description_.holes.push_back(f);
  }
  for (int v = 0; v < level.GetNumVertices(); ++v) part_vertex(v);
  add_creases();
  description_.point_count = originals_.size();
}

/// A copy for each set of faces about the vertex that manifold edges connect.
void Sheets::part_vertex(int v) {
  const auto faces = level_.GetVertexFaces(v);
  const auto places = level_.GetVertexFaceLocalIndices(v);
  std::vector<int> copy(to_size(faces.size()), -1);
  for (int i = 0; i < faces.size(); ++i) {
    if (copy[to_size(i)] >= 0) continue;
    const int number = add_copy(v);
    std::vector<int> reached = {i};
    copy[to_size(i)] = number;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      for (int j = 0; j < faces.size(); ++j) {
        if (copy[to_size(j)] >= 0 || !are_joined(v, faces[reached[k]], faces[j])) continue;
        copy[to_size(j)] = number;
        reached.push_back(j);
      }
    }
  }
  for (int i = 0; i < faces.size(); ++i) {
    description_.vertices[to_size(first_[to_size(faces[i])] + places[i])] = copy[to_size(i)];
  }
}

int Sheets::add_copy(int v) {
  const int number = to_int(originals_.size());
  originals_.push_back(v);
  const bool corner =
      level_.IsVertexNonManifold(v) && level_.GetVertexRule(v) == Sdc::Crease::RULE_CORNER;
  const float sharpness = corner ? float(infinite_sharpness) : level_.GetVertexSharpness(v);
  if (sharpness > 0) {
    description_.corner_vertices.push_back(number);
    description_.corner_sharpness.push_back(sharpness);
  }
  return number;
}

/// By a manifold edge at the vertex; one face is joined to itself.
bool Sheets::are_joined(int v, int a, int b) const {
  if (a == b) return true;
  const auto edges = level_.GetVertexEdges(v);
  return std::any_of(edges.begin(), edges.end(), [&](int e) {
    const auto faces = level_.GetEdgeFaces(e);
    return !level_.IsEdgeNonManifold(e) && faces.size() == 2 &&
           ((faces[0] == a && faces[1] == b) || (faces[0] == b && faces[1] == a));
  });
}

void Sheets::add_creases() {
  for (int f = 0; f < level_.GetNumFaces(); ++f) {
    const auto edges = level_.GetFaceEdges(f);
    for (int k = 0; k < edges.size(); ++k) {
      const float sharpness = level_.GetEdgeSharpness(edges[k]);
      if (sharpness <= 0) continue;
      const int first = first_[to_size(f)];
      for (const int corner : {k, (k + 1) % edges.size()}) {
        description_.crease_vertices.push_back(description_.vertices[to_size(first + corner)]);
      }
      description_.crease_sharpness.push_back(sharpness);
    }
  }
}

}  // namespace taut
