#pragma once

#include <array>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// A Bezier patch of a cage's limit surface.
struct SurfacePatch {
  BezierPatch bezier;
  int cage_face = 0;
  /// Indexed by Side: the surface goes on smoothly there.
  std::array<bool, 4> smooth = {};
  bool exact = true;  ///< otherwise it stands for the surface there
};

/// A triangle of it, quartic or of degree six; points as CellPatch has them, sides from each corner
/// to the next.
struct SurfaceTriangle {
  std::vector<dvec3> points;
  int cage_face = 0;
  std::array<bool, 3> smooth = {};
  bool exact = true;
};

/// @name Patches that meet along whole sides
/// Where adaptive refinement leaves the middle of a patch's side as corner of its neighbours, the
/// patch is split, exactly, so that whole sides meet.
/// @{

/// A quad with two such sides becomes two rectangles, or a rectangle and two trapezoids; with four,
/// four. One with an odd number gets another one, which is passed on from neighbour to neighbour
/// to the next that needs one or to a boundary. (Where there is neither, the quad stays whole.)
/// Patches that are not exact take over the sides of their neighbours. Patches stay in their order.
std::vector<SurfacePatch> conforming(std::vector<SurfacePatch> patches);
/// Every triangle, bisected through the middles of such sides first, becomes three quads about its
/// centre. Triangles that are not exact take over the sides of their neighbours.
std::vector<SurfacePatch> conforming(std::vector<SurfaceTriangle> triangles);
/// @}

}  // namespace taut
