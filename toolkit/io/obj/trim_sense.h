#pragma once

#include "taut/surface/model.h"

namespace taut {

/// Whether a loop runs counter-clockwise in its face's parameters, by the signed area of a polygon
/// of many points on it. False where that is zero. @pre its curves are valid
bool runs_counter_clockwise(const TrimLoop& loop);

/// The loop run through in the other sense, over the same ranges of its curves' parameters.
TrimLoop reversed(const TrimLoop& loop);

}  // namespace taut
