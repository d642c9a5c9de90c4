#pragma once

#include <span>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// @name Crests
/// A crest is a curve u = const or v = const of a patch that is not straight and along which the
/// surface has one tangent plane: the top circle of a torus, the rim of a crater. One direction
/// supports all of it at once.
/// @{

/// Whether the curve u = s (direction u) or v = s is one: normals agree within crest_angle, heights
/// over their plane within crest_height of the patch's size, rounding apart: that of doubles, or
/// what the numbers were rounded by before, `grid`.
bool is_crest(const BezierPatch& patch, Direction direction, double s, double grid = 0);

/// Whether the crest's plane may support a surface with these points: none lies above it, or none
/// below, up to the tolerance or to what rounding to the grid does.
bool may_support(const BezierPatch& patch, Direction direction, double s,
                 std::span<const dvec3> points, double tolerance, double grid = 0);

/// Parameters inside of ]0, 1[, ascending, of the crests across which the slope over their plane
/// changes its sign; others (the flat circle of z = r^3) carry no support points of a ridge.
/// Nearer to a border than least_crest_share of the patch there is none. `grid`: see is_crest.
std::vector<double> inner_crests(const BezierPatch& patch, Direction direction, double grid = 0);
/// @}

}  // namespace taut
