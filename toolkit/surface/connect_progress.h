#pragma once

#include <cstddef>

#include "taut/core/progress.h"

namespace taut {

/// At a patch, join or the like of a part's, by number: checks, and tells at a few of them the
/// share that is done. A part of few patches tells nothing.
inline void report_connect(const Progress& progress, std::size_t k, std::size_t count) {
  constexpr std::size_t stride = 256;
  progress.check();
  if (k > 0 && k % stride == 0) progress.update("connect", double(k) / double(count));
}

}  // namespace taut
