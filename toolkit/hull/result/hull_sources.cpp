#include "taut/hull/result/hull_sources.h"

#include "taut/core/integers.h"

namespace taut {

HullDocument::Source HullSources::source(int id) const {
  const Source own = model_.source(id);
  const Instance& instance = model_.instances()[to_size(own.instance)];
  const Part& part = model_.parts()[to_size(instance.part)];
  HullDocument::Source result;
  result.id = id;
  result.kind = own.kind;
  if (to_size(instance.part) < files_.size()) result.file = files_[to_size(instance.part)];
  const auto placed = [&](const std::vector<dvec4>& points) {
    std::vector<dvec4> all;
    for (const dvec4& p : points) {
      const dvec3 x = euclidean(p);
      all.emplace_back(instance.pose.at_rest() ? x : instance.pose(x), p.w);
    }
    return all;
  };
  if (own.kind == SourceKind::vertex) {
    result.patches.push_back(
        {{}, 1, 1, placed({homogeneous(part.vertices()[to_size(own.index)])})});
  } else if (own.kind == SourceKind::edge) {
    const Edge& edge = part.edges()[to_size(own.index)];
    result.name = edge.name;
    for (int k = 0; k < edge.piece_count; ++k) {
      const EdgePiece& piece = part.pieces()[to_size(edge.first_piece + k)];
      result.patches.push_back(
          {{piece.t}, 1, int(piece.bezier.points.size()), placed(piece.bezier.points)});
    }
  } else if (to_size(own.index) < part.faces().size()) {
    const Face& face = part.faces()[to_size(own.index)];
    result.name = face.name;
    for (int k = 0; k < face.patch_count; ++k) {
      const Patch& patch = part.patches()[to_size(face.first_patch + k)];
      result.patches.push_back({{patch.u, patch.v},
                                patch.bezier.degree_u + 1,
                                patch.bezier.degree_v + 1,
                                placed(patch.bezier.points)});
    }
  }
  return result;
}

}  // namespace taut
