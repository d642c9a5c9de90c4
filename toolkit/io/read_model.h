#pragma once

#include <filesystem>

#include "taut/core/progress.h"
#include "taut/core/tolerances.h"
#include "taut/surface/model.h"

namespace taut {

struct ReadOptions {
  /// Borders whose tangent planes differ by less are smooth joins; radians.
  double smooth_angle = smooth_join_angle;
  /// Receives a warning for each part of a file that is named but not supported.
  Progress progress;
};

/// Reads a file into the model as one more part, by the file name's extension: `.bpt` (Bezier
/// patches) or `.obj` (the free-form statements of the format).
///
/// Nothing that a file says is trusted: counts, indices and numbers are checked before memory is
/// taken, and the model is unchanged if anything is wrong.
/// @throws IoError (FILE:LINE: ...) if the file cannot be read or is not what its format says,
/// InvalidInput (likewise with place) if its numbers are no valid geometry, LimitExceeded for files
/// above 2 GiB or surfaces with more than 2^26 control points once decomposed, Cancelled
void read_model(const std::filesystem::path& path, Model& model, const ReadOptions& options = {});

}  // namespace taut
