#pragma once

#include <vector>

#include "taut/hull/polytope/model_points.h"
#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// The hull faces of a polyhedral hull's mesh: which of its faces are one, and on which polygon of
/// the input they lie. All must outlive it.
class PolyhedralFaces {
 public:
  /// `corners`: of the points, per vertex of the mesh; `normals`: per face of it. Heights up to
  /// `width` are put down to rounding, zero: none.
  PolyhedralFaces(const ModelPoints& points, const std::vector<int>& corners,
                  const std::vector<dvec3>& normals, double width, HullMesh& mesh)
      : points_(points), corners_(corners), normals_(normals), width_(width), mesh_(mesh) {}

  /// Numbers as one hull face what rounding keeps from being coplanar.
  void join_coplanar();
  /// Numbers faces that are too narrow for their normals to mean anything as one with what lies
  /// across from their longest sides.
  void join_slivers();
  /// Finds for every face the first polygon of the input that lies in it and touches a corner of
  /// its hull face.
  void label();

 private:
  /// Marks the edges between hull faces.
  void mark_features();
  /// Above a face, up to rounding.
  double height(const dvec3& p, OpenMesh::FaceHandle f) const;
  const dvec3& point_at(OpenMesh::VertexHandle v) const {
    return points_.points()[std::size_t(corners_[std::size_t(v.idx())])];
  }

  const ModelPoints& points_;
  const std::vector<int>& corners_;
  const std::vector<dvec3>& normals_;
  double width_;
  HullMesh& mesh_;
};

}  // namespace taut
