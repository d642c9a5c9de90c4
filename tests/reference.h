#pragma once

#include <array>
#include <vector>

#include "taut/surface/model.h"
#include "taut/surface/polygon_mesh.h"

namespace taut_test {

/// Slow, independent answers in long double.
using real = long double;
using rvec3 = glm::vec<3, long double>;
using rvec4 = glm::vec<4, long double>;

/// By de Casteljau's algorithm on the homogeneous points.
rvec3 reference_point(const taut::BezierCurve& curve, real t);
rvec3 reference_point(const taut::BezierPatch& patch, real u, real v);

/// Distance of a point from the convex hull of four points, which may coincide.
real distance_to_tetrahedron(const rvec3& x, const std::array<taut::dvec3, 4>& corners);

/// Between which numbers a support value lies. `lower` is attained by a point of the model.
struct SupportRange {
  real lower = 0;
  real upper = 0;
};

/// Support values by subdivision of control nets and their convex hull property, without
/// hierarchies, hints, derivatives' bounds or Newton steps that anything relies on.
class ReferenceSupport {
 public:
  /// Values are those of (x - origin) . n; differences to the origin are taken exactly.
  explicit ReferenceSupport(const taut::Model& model, const taut::dvec3& origin = taut::dvec3(0.0));

  /// The range is as wide as `accuracy` times the model's size, or wider if that would take more
  /// than 100,000 cells (contact along a whole curve).
  SupportRange operator()(const taut::dvec3& n, real accuracy = 1e-15L) const;

  /// Largest coordinate of a control point, relative to the origin.
  real size() const { return size_; }

 private:
  struct Element {
    int p, q;
    std::vector<rvec4> points;  // homogeneous, relative to the origin
  };
  std::vector<Element> elements_;
  real size_ = 0;
};

/// Topology and exact convexity of a mesh, found the slow way.
struct MeshFacts {
  bool closed_manifold =
      false;                  ///< every edge in two polygons, in opposite directions; one fan each
  long euler = 0;             ///< V - E + F
  bool planar = false;        ///< every polygon, exactly
  bool edges_convex = false;  ///< no corner of a polygon above a neighbour's plane, exactly
  bool strictly = false;      ///< neighbours are never coplanar, corners never straight
  bool no_zero_area = false;
  bool all_points_used = false;

  bool is_convex_polytope() const {
    return closed_manifold && euler == 2 && planar && edges_convex && no_zero_area &&
           all_points_used;
  }
};
MeshFacts mesh_facts(const taut::PolygonMesh& mesh);

/// max over the mesh's points of (x - origin) . n.
real mesh_support(const taut::PolygonMesh& mesh, const taut::dvec3& n, const taut::dvec3& origin);

}  // namespace taut_test
