#pragma once

#include <cstdint>
#include <optional>

#include "taut/bounds/normal_pyramid.h"

namespace taut {

/// A rectangle [i, i + 1] / 2^level x [j, j + 1] / 2^level of a patch's unit square.
struct PatchCell {
  int level = 0;        ///< 0: the whole patch
  std::uint32_t i = 0;  ///< along u, 0 .. 2^level - 1
  std::uint32_t j = 0;  ///< along v, 0 .. 2^level - 1

  /// Its range of the patch's u.
  Interval u() const { return interval(i); }
  /// Its range of the patch's v.
  Interval v() const { return interval(j); }
  /// k-th quarter, in the order (u0,v0), (u0,v1), (u1,v0), (u1,v1).
  PatchCell child(std::uint32_t k) const { return {level + 1, 2 * i + k / 2, 2 * j + k % 2}; }

 private:
  Interval interval(std::uint32_t k) const {
    const double size = 1.0 / double(std::uint64_t{1} << level);
    return {k * size, (k + 1) * size};
  }
};

/// Which of its two unit normals a piece of surface can touch a supporting plane with: n of the
/// pyramid or the opposite. By curvature alone, so unchanged by rigid motions and mirrors.
struct ContactSigns {
  bool plus = true;   ///< with the pyramid's normals
  bool minus = true;  ///< with their opposites
  /// Not proven to touch none.
  bool any() const { return plus || minus; }
};

/// What a cell of a patch can do as the place of a supporting plane's contact.
struct NormalBounds {
  /// Contains the normals Su x Sv; none where they are not within a half space, or all zero.
  std::optional<NormalPyramid> pyramid;
  ContactSigns signs;  ///< with which of its normals it may
  /// Certain: both principal curvatures have one sign, not zero, so one of `signs` is set.
  bool definite = false;
};

}  // namespace taut
