#pragma once

#include <array>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/bounds/scene_content.h"
#include "taut/containment/triangle_rays.h"
#include "taut/surface/bezier.h"

namespace taut {

/// A patch of an instance, in the scene's frame.
struct PlacedPatch {
  BezierPatch bezier;
  Box box;   ///< of the control points
  int body;  ///< the instance that it bounds
};

/// A triangle of an instance's polygons, in the scene's frame.
struct PlacedTriangle {
  std::array<dvec3, 3> corner;
  int body;
};

/// All surfaces of a model in the scene's frame, those that repeat others left out.
struct PlacedSurface {
  std::vector<PlacedPatch> patches;
  std::vector<PlacedTriangle> triangles;
  int bodies = 0;
  /// Over the boxes of the patches, and over those of the triangles.
  BoxTree patch_tree, triangle_tree;
  /// How far patches that are joined may be apart, and what rounding may do to points.
  double crack = 0;
  double rounding = 0;
};
PlacedSurface placed_surface(const Scene& scene);

/// What rounding adds to the coefficients of a patch's net over a cell of that size, as a share of
/// the largest: a unit for each of the averages that the halvings took (see certificate_rounding()
/// of the support query), twice.
double halving_rounding(const BezierPatch& patch, double size_u, double size_v);

/// Triangles through points of a placed surface, patches first.
struct Tessellation {
  std::vector<dvec3> points;
  std::vector<Triangle> triangles;
  std::vector<int> body;  ///< per triangle
  /// Proven bound of the distance of a point of the surface from the point of its triangle.
  double deviation = 0;
};

/// Patches are tessellated over grids that agree along joined sides, fine enough for the tolerance
/// (in the scene's frame) or as fine as `most_triangles` allows.
Tessellation tessellation(const Scene& scene, const PlacedSurface& surface, double tolerance,
                          std::size_t most_triangles);

}  // namespace taut
