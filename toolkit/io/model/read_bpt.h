#pragma once

#include <string>
#include <string_view>

#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// Reads Bezier patches: their number, then for each its degrees m n and (m+1)(n+1) points x y z,
/// the index of the first direction running fastest. Every patch is a face, "patch 1" onwards.
/// `data` is the whole file, `file` its name for messages.
///
/// Source: R. Holmes, PatchOff, "BPT Bezier patch file format" (2003).
/// @throws as read_model()
Part read_bpt(const std::string& file, std::string_view data, const Progress& progress);

}  // namespace taut
