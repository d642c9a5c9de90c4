#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <optional>
#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// @name A Loop surface's triangle alone between two creases
/// Where a smooth crease or boundary goes through a vertex with one triangle (v, a, b) on its side,
/// the surface is a box spline there, of a lattice that goes on around v with the points
///     v + a - b,  a,  b,  v + b - a
/// from beyond (v, a) to beyond (v, b): the rules of the crease are those of the lattice with them,
/// on this level and, since they are the same points of the next one, on all.
/// @{

/// The corner of the triangle that is such a vertex v, the others being vertices of three triangles
/// on the crease's side; none if there is none, or if rules nearby are semi-sharp ones.
std::optional<int> lone_corner(const OpenSubdiv::Far::TopologyLevel& level, int face);

/// Its quartic triangle, as CellPatch has it. @pre the corner is its lone_corner
std::vector<dvec3> lone_triangle(const OpenSubdiv::Far::TopologyLevel& level,
                                 std::span<const dvec3> points, int face, int corner);
/// @}

}  // namespace taut
