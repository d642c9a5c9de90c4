#include "taut/io/model/affine_map.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "taut/core/predicates.h"
#include "taut/core/tolerances.h"
#include "taut/surface/piecewise.h"

namespace taut {
namespace {

dvec3 image(const dvec3& p, const AffineMap& map) { return map.linear * p + map.translation; }

void transform(std::vector<dvec4>& points, const AffineMap& map) {
  for (dvec4& p : points) p = {map.linear * dvec3(p) + p.w * map.translation, p.w};
}

/// As decompose() gave them.
std::vector<PatchPiece> pieces(const Part& part, const Face& face) {
  std::vector<PatchPiece> result;
  for (int i = 0; i < face.patch_count; ++i) {
    const Patch& patch = part.patches()[static_cast<std::size_t>(face.first_patch + i)];
    result.push_back({patch.bezier, patch.u, patch.v});
  }
  return result;
}

std::vector<CurvePiece> pieces(const Part& part, const Edge& edge) {
  std::vector<CurvePiece> result;
  for (int i = 0; i < edge.piece_count; ++i) {
    const EdgePiece& piece = part.pieces()[static_cast<std::size_t>(edge.first_piece + i)];
    result.push_back({piece.bezier, piece.t});
  }
  return result;
}

/// What a face is that is given by patches.
std::vector<FacePatch> transformed_patches(const Part& part, const Face& face,
                                           const AffineMap& map) {
  std::vector<FacePatch> result;
  result.reserve(static_cast<std::size_t>(face.patch_count));
  for (int i = 0; i < face.patch_count; ++i) {
    const Patch& patch = part.patches()[static_cast<std::size_t>(face.first_patch + i)];
    result.push_back({patch.bezier, patch.smooth_sides, patch.stand_in});
    transform(result.back().bezier.points, map);
  }
  return result;
}

/// Which faces of the result are whose is told by those of the part.
void add_cages(const Part& part, const AffineMap& map, Part& result) {
  int first_face = 0;
  for (int c = 0; c < static_cast<int>(part.cages().size()); ++c) {
    CageOfPart cage = part.cages()[static_cast<std::size_t>(c)];
    ControlCage image_of_cage = *cage.cage;
    for (dvec3& p : image_of_cage.points) p = image(p, map);
    cage.cage = std::make_shared<const ControlCage>(std::move(image_of_cage));
    const auto& faces = part.faces();
    while (first_face < static_cast<int>(faces.size()) &&
           faces[static_cast<std::size_t>(first_face)].cage != c) {
      ++first_face;
    }
    result.add_cage(std::move(cage), first_face);
  }
}

}  // namespace

bool is_rigid(const AffineMap& map) {
  const dmat3 residual = glm::transpose(map.linear) * map.linear - dmat3(1.0);
  bool rigid = std::abs(glm::determinant(map.linear) - 1) <= rotation_tolerance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rigid = rigid && std::abs(residual[i][j]) <= rotation_tolerance;
  }
  return rigid;
}

bool is_singular(const AffineMap& map) {
  return orientation(dvec3(0.0), map.linear[0], map.linear[1], map.linear[2]) == Sign::zero;
}

Part transformed(const Part& part, const AffineMap& map) {
  assert(!part.connected());
  Part result;
  result.name = part.name;
  for (const Face& face : part.faces()) {
    if (face.cage >= 0) {
      result.add_patches(transformed_patches(part, face, map), face.name);
      continue;
    }
    NurbsSurface surface = joined(pieces(part, face));
    transform(surface.points, map);
    result.add_surface(surface, face.name, face.loops);
  }
  add_cages(part, map, result);
  // No vector grows by more than the Frobenius norm.
  double norm = 0;
  for (int i = 0; i < 3; ++i) norm += glm::dot(map.linear[i], map.linear[i]);
  result.include_deviation(part.deviation_bound() * std::sqrt(norm));
  for (const Edge& edge : part.edges()) {
    NurbsCurve curve = joined(pieces(part, edge));
    transform(curve.points, map);
    result.add_curve(curve, edge.name);
  }
  PolygonMesh mesh{part.vertices(), part.polygons()};
  for (dvec3& p : mesh.points) p = image(p, map);
  result.add_polygons(mesh);
  return result;
}

}  // namespace taut
