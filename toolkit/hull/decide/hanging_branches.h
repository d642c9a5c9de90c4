#pragma once

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/cell_view.h"

namespace taut {

/// All branches that a cell sees are joined, one to the next, where two of their points, corners of
/// their pieces, are no farther apart than the resolution.
bool hang_together(const CellView& view, const Branches& branches, double resolution);

}  // namespace taut
