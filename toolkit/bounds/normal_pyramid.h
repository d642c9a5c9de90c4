#pragma once

#include <array>
#include <optional>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// A convex cone of directions with four sides, narrower than a half space: bounds the normals of a
/// piece of surface (Sederberg and Zundel 1996).
struct NormalPyramid {
  /// Unit vector inside: the mean direction of what is bounded.
  dvec3 axis = dvec3(0.0);
  /// Its edges, counter-clockwise about the axis, with corner . axis = 1: every direction inside is
  /// a multiple of a convex combination of them.
  std::array<dvec3, 4> corners = {};

  /// False is certain: the direction is not inside. @pre not zero
  bool may_contain(const dvec3& n) const;
};

/// A pyramid that contains all non-negative combinations of the vectors: the bounding box of their
/// gnomonic images about their mean direction, with the first of its sides along `along` if that
/// is not zero (the direction in which they spread most makes it tight).
///
/// Vectors no longer than `vector_error` are rounding and skipped; the others may be off by it, and
/// the pyramid is widened by that and by the rounding of the computation. None if the vectors do
/// not lie well inside an open half space about their mean (within pyramid_limit), or are all
/// skipped.
std::optional<NormalPyramid> normal_pyramid(std::span<const dvec3> vectors, double vector_error,
                                            const dvec3& along = dvec3(0.0));

/// Smallest cosine between a pyramid's mean direction and what it contains, 2^-4: within some 86
/// degrees. Wider pyramids tell nothing, and their corners grow without bound.
inline constexpr double pyramid_limit = 1.0 / 16;

}  // namespace taut
