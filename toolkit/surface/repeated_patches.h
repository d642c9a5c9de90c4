#pragma once

#include <vector>

#include "taut/surface/model.h"

namespace taut {

/// Sets Patch::repeats and its mapping: control points agree within repeated_patch_distance of the
/// box's diagonal, and weights, up to a common factor, by as much. Of patches that are much larger
/// than `apart` points may be as far apart. Takes time linear in the number of patches, unless very
/// many crowd in one place.
/// @pre the box contains the patches @throws Cancelled
void find_repeated_patches(std::vector<Patch>& patches, const Box& box, double apart,
                           const Progress& progress);

/// The side of the patch it repeats on which a side lies, and whether it runs the other way there.
struct RepeatedSide {
  Side side = Side::u0;
  bool reversed = false;
};
RepeatedSide side_in_repeated(const Patch& patch, Side side);

}  // namespace taut
