#pragma once

#include <opensubdiv/far/patchTable.h>

#include <array>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// @name Bezier points of OpenSubdiv's patches
/// @{

/// A B-spline's 16 control points to the Bezier points of its piece; `boundary`: bits of the sides
/// v = 0, u = 1, v = 1, u = 0, beyond which the spline is continued straight.
std::vector<dvec3> bezier_net(std::array<dvec3, 16> p, int boundary);

constexpr int loop_points = 12;
constexpr int quartic_points = 15;
using LoopMatrix = std::array<std::array<double, loop_points>, quartic_points>;

/// The Bezier points of a box spline's triangle, from its twelve control points, by its basis at as
/// many parameters. The matrix is of 48ths, to which it is rounded.
LoopMatrix loop_to_bezier(const OpenSubdiv::Far::PatchTable& table,
                          const OpenSubdiv::Far::PatchTable::PatchHandle& handle);

/// Of OpenSubdiv's quartic Gregory triangle: of each corner itself, the points next to it on the
/// sides that begin and that end there, and two for the one inside that is next to it, those for
/// the same two sides; then the sides' middle points.
constexpr int gregory_points = 18;

/// The quartic triangle with the Gregory triangle's borders. It has its tangent planes, too, along
/// sides between regular corners; between others the two points inside are averaged.
std::vector<dvec3> quartic_of_gregory(const std::array<dvec3, gregory_points>& net,
                                      const std::array<bool, 3>& regular);
/// @}

}  // namespace taut
