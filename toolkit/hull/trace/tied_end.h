#pragma once

#include <optional>

#include "taut/hull/trace/merging.h"

namespace taut {

/// The end of two contacts of one smooth surface or curve that support values do not tell apart any
/// more (level_way): where they are, without a free end that is known.
std::optional<MergedEnd> tied_end(const CurvePoint& point);

}  // namespace taut
