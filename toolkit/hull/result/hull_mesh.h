#pragma once

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/progress.h"
#include "taut/hull/result/face_kind.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// Traits of HullMesh: double coordinates, and the origin of every vertex and face.
struct HullMeshTraits : public OpenMesh::DefaultTraitsDouble {
  /// Vertices have normals that support there.
  VertexAttributes(OpenMesh::Attributes::Normal);

  /// What is known of a vertex.
  VertexTraits {
   public:
    /// Source of the contact (Model::source), -1 if unknown.
    int source = -1;
    /// Parameters on the source: (u, v) of a face, (t, 0) of an edge, (0, 0) of a vertex.
    double u = 0;
    double v = 0;  ///< see u
    /// Proven upper bound of the distance of the true hull from the mesh about this vertex.
    float quality = 0;
  };

  /// What is known of a face.
  FaceTraits {
   public:
    FaceKind kind = FaceKind::facet;
    /// Source that the face lies on, -1 where it spans between several.
    int source = -1;
    /// The face of the hull that this mesh face is part of; numbered from 0.
    int hull_face = -1;
  };

  /// What is known of an edge.
  EdgeTraits {
   public:
    /// The edge separates two hull faces.
    bool feature = false;
  };
};

/// A convex hull as a half-edge mesh: closed, outward, vertices numbered from 0 without gaps.
/// Coplanar facets are polygons.
///
/// A planar hull is its outline, one polygon each side; a segment two vertices and an edge; a point
/// one vertex.
using HullMesh = OpenMesh::PolyMesh_ArrayKernelT<HullMeshTraits>;

inline dvec3 position(const HullMesh& mesh, OpenMesh::VertexHandle v) {
  const auto& p = mesh.point(v);
  return {p[0], p[1], p[2]};
}

/// The mesh of these vertices and polygons, unlabelled; without polygons, two vertices are joined
/// by an edge. @pre the polygons bound a surface: every side belongs to two, in opposite directions
/// @throws Cancelled
HullMesh make_hull_mesh(const std::vector<dvec3>& vertices,
                        const std::vector<std::vector<int>>& polygons,
                        const Progress& progress = {});

/// The smallest float that is not below x.
float float_above(double x);

/// The bare polygons.
PolygonMesh polygons(const HullMesh& mesh);

}  // namespace taut
