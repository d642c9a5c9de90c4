#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// @name Parts of polynomial patches in other parameters
/// Exact up to the rounding of convex combinations: new control points lie in the convex hull of
/// the old ones.
/// @{

/// (s, t) -> patch(s w(t), t) with w linear from w0 to w1: of the unit square the trapezoid with
/// the parallel sides t = 0 and t = 1. Of degree (degree_u, degree_u + degree_v).
/// @pre polynomial with weights one; w0 and w1 in [0, 1]
BezierPatch tapered(const BezierPatch& patch, double w0, double w1);

/// The quadrilateral of a triangular patch of degree n (points as CellPatch has them) with these
/// barycentric corners, (0, 0), (0, 1), (1, 0) and (1, 1), weights of the patch's first, second and
/// third corner. Of degree (n, n).
BezierPatch quad_of_triangle(std::span<const dvec3> triangle, const std::array<dvec3, 4>& corners);

/// The triangle of a triangular patch with these barycentric corners, and the same patch in one
/// degree more.
std::vector<dvec3> sub_triangle(std::span<const dvec3> triangle,
                                const std::array<dvec3, 3>& corners);
std::vector<dvec3> elevated_triangle(std::span<const dvec3> triangle);

/// Its point at barycentric coordinates.
dvec3 value_of_triangle(std::span<const dvec3> triangle, const dvec3& at);

/// The polynomial curve of these control points in a degree as high at least.
std::vector<dvec3> elevated_curve(std::vector<dvec3> points, std::size_t degree);

BezierPatch reversed_u(const BezierPatch& patch);
BezierPatch reversed_v(const BezierPatch& patch);
/// @}

}  // namespace taut
