#pragma once

#include <optional>

#include "taut/core/progress.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/add_cage.h"

namespace taut {

/// What the polygons of a file stand for.
enum class Scheme {
  bilinear,  ///< themselves
  catmark,   ///< the control cage of a Catmull-Clark surface
  loop,      ///< the control cage of a Loop surface
};

/// How files are read.
struct ReadOptions {
  /// Borders whose tangent planes differ by less are smooth joins; radians.
  double smooth_angle = smooth_join_angle;
  /// If not given, polygons are bilinear unless their file has the tags of a subdivision cage: then
  /// they are one of a Loop surface if all are triangles, else of a Catmull-Clark surface.
  std::optional<Scheme> scheme;
  /// CageOptions::accuracy of cages.
  double cage_accuracy = default_cage_accuracy;
  /// Receives a warning for each part of a file that is named but not supported.
  Progress progress;
};

}  // namespace taut
