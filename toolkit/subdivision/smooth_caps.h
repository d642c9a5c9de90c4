#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/subdivision/dart_limit.h"

namespace taut {

/// @name Caps about an extraordinary vertex with common tangent planes
/// The end caps of all n cells about an inner vertex, in their counter-clockwise order, made to
/// meet along the spokes, the sides that they share, with one tangent plane at each point: of the
/// first cell's spoke c, with r and l the derivatives from it into the cells on both sides,
///     r(t) + l(t) = w(t) c'(t),  w(0) = 2 cos(2 pi / n)
/// (Peters, Geometric continuity, in Farin, Hoschek, Kim, Handbook of CAGD, 2002). What is given at
/// the outer sides, where regular cells go on, is kept: the positions, the tangent planes, and the
/// first derivatives of both along the sides; so are the vertex, and its tangent plane. Second
/// derivatives at the vertex are those of one quadratic form where the caps' own tell more than it
/// (n > 5). At a dart the first spoke is the sharp edge, along which the caps meet with two tangent
/// planes, and the vertex's place and tangent plane are the given ones. The caps may differ from
/// the given ones by as much as these are not smooth. Mirrored and rotated cells give mirrored and
/// rotated caps, to within rounding.
/// @pre n >= 3; the tangents of the spokes in the vertex are an affine image of those of a regular
/// polygon; the cells are a regular lattice around the spokes' other ends
/// @{

/// Bicubic nets, 16 points along v within along u, with the vertex at (0, 0), along u to the first
/// spoke's end. Gives nets of degree (5, 5), 36 points in the same order.
std::vector<std::vector<dvec3>> smooth_quad_caps(std::span<const std::vector<dvec3>> nets,
                                                 const std::optional<VertexLimit>& dart);

/// Quartic triangles, 15 points as CellPatch has them, the vertex their first corner, the first
/// spoke towards the second one. Gives triangles of degree 6, 28 points: (0,0) .. (6,0), (0,1) ..
/// (5,1), .. (0,6).
std::vector<std::vector<dvec3>> smooth_triangle_caps(std::span<const std::vector<dvec3>> nets,
                                                     const std::optional<VertexLimit>& dart);
/// @}

}  // namespace taut
