#pragma once

#include <array>
#include <vector>

#include "taut/core/progress.h"
#include "taut/subdivision/edge_middles.h"
#include "taut/surface/bezier.h"

namespace taut {

/// A Bezier patch of a cage's limit surface.
struct SurfacePatch {
  BezierPatch bezier;
  int cage_face = 0;
  /// At the corners (u0,v0), (u0,v1), (u1,v0), (u1,v1), as EdgeMiddles knows them.
  std::array<int, 4> vertices = {-1, -1, -1, -1};
  /// Indexed by Side: the surface goes on smoothly there.
  std::array<bool, 4> smooth = {};
  bool exact = true;      ///< otherwise it stands for the surface there
  bool may_touch = true;  ///< the hull
};

/// A triangle of it, quartic or of degree six; points as CellPatch has them, sides from each corner
/// to the next.
struct SurfaceTriangle {
  std::vector<dvec3> points;
  int cage_face = 0;
  std::array<int, 3> vertices = {-1, -1, -1};
  std::array<bool, 3> smooth = {};
  bool exact = true;
  bool may_touch = true;
  /// Of an exact part of a triangle: the points of that one, and its own corners as barycentric
  /// coordinates there. So what becomes of it is rounded once, however often it is divided.
  std::vector<dvec3> whole = {};
  std::array<dvec3, 3> corners = {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
};

/// @name Patches that meet along whole sides
/// Where adaptive refinement leaves middles of a patch's side as corners of its neighbours, the
/// patch is split, exactly, again and again, until whole sides meet. Which sides meet is known by
/// their vertices. Patches with twice one vertex take no part, nor do sides that their vertices do
/// not tell apart (EdgeMiddles::are_several).
///
/// Patches that are not exact take over the sides, and so the corners, of those that are, and those
/// that may not touch the hull the ones of all others: all their points stay in the convex hull of
/// their own and others' points. Pieces stay in the order of their patches.
/// @throws Cancelled
/// @{

/// A quad with two sides to be split becomes two rectangles, or a rectangle and two trapezoids;
/// with four, four. One with an odd number gets another one, which is passed on from neighbour to
/// neighbour to the next that needs one or to a boundary. (Where there is neither, or trapezoids
/// of trapezoids come to a degree above max_degree, the quad stays whole.)
std::vector<SurfacePatch> conforming(std::vector<SurfacePatch> patches, EdgeMiddles middles,
                                     const Progress& progress = {});
/// Triangles are bisected; in the end, each becomes three quads about its centre.
std::vector<SurfacePatch> conforming(std::vector<SurfaceTriangle> triangles, EdgeMiddles middles,
                                     const Progress& progress = {});
/// @}

}  // namespace taut
