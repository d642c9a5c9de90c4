#pragma once

#include <optional>
#include <span>

#include "taut/core/geometry.h"
#include "taut/surface/control_cage.h"

namespace taut {

/// Where the limit surface is at a vertex, and its tangent plane there.
struct VertexLimit {
  dvec3 x;
  dvec3 normal;  ///< unit
};

/// The limit at a dart: an inner vertex at which one infinitely sharp edge ends. By the
/// eigenvectors of its own subdivision matrix, in which the points about the vertex are those of a
/// smooth one but for the middle of that edge. Their part that is even and their part that is odd
/// over the edge tell one tangent each. (OpenSubdiv has the limit of a smooth vertex there.)
///
/// `ring`: the vertex; the other ends of its n edges, the sharp one first, counter-clockwise; in
/// cages of quads then the corners between each edge and the next. None where the ring has no
/// tangent plane.
/// @pre n >= 3; the scheme is catmark or loop
std::optional<VertexLimit> dart_limit(CageScheme scheme, std::span<const dvec3> ring);

}  // namespace taut
