#pragma once

#include <vector>

#include "taut/hull/decide/branches.h"

namespace taut {

/// The convex hull in the parameters of a patch's chart of its pieces and what else of the branch
/// lies in it, counterclockwise, where the chart's rectangle is from 0 to 1.
std::vector<dvec2> parameter_hull(const CellView& view, const Branches& branches,
                                  const Branch& branch, int chart);

/// c lies to the right of the way from a over b.
inline bool turns_right(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) < (b.y - a.y) * (c.x - a.x);
}

}  // namespace taut
