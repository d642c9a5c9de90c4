#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <optional>
#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// A Loop surface's triangle alone between two creases: its quartic triangle, as CellPatch has it.
///
/// Where a smooth crease or boundary goes through a vertex with one triangle (v, a, b) on its side,
/// the surface is a box spline there, of a lattice that goes on around v with the points
///     v + a - b,  a,  b,  v + b - a
/// from beyond (v, a) to beyond (v, b): the rules of the crease are those of the lattice with them,
/// on this level and, since they are the same points of the next one, on all. None if the face has
/// no such vertex v with the others vertices of three triangles on the crease's side, or if rules
/// nearby are semi-sharp ones.
std::optional<std::vector<dvec3>> lone_triangle(const OpenSubdiv::Far::TopologyLevel& level,
                                                std::span<const dvec3> points, int face);

}  // namespace taut
