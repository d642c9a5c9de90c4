#pragma once

#include <string>

#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// See CageOptions.
inline constexpr double default_cage_accuracy = 1e-9;

/// How a control cage becomes patches.
struct CageOptions {
  /// What may be left of the exact limit surface near extraordinary vertices: a bound of the change
  /// of the support function, as a fraction of the diagonal of the cage's box.
  double accuracy = default_cage_accuracy;
  Progress progress;  ///< told of the share done and of warnings, and asked to stop
};

/// Adds the limit surface of a control cage to a part: a face for each face of the cage that has a
/// surface, named "face 0", "face 1", ... by its number in the cage. Infinitely sharp creases and
/// boundaries become edges, and corners and ends of creases vertices, once the part is connected.
///
/// Faces are exact, but for neighbourhoods of extraordinary vertices that are smaller than the
/// accuracy (Part::deviation_bound), and where the surface cannot touch its convex hull: there
/// something simpler stands for it.
///
/// Warns of what OpenSubdiv treats by rules of its own: edges with more than two faces or none of
/// one orientation, vertices about which faces are no fan, and faces with repeated vertices.
/// `place` begins the warnings: what of which the cage is, as "FILE". Errors tell of the cage
/// alone.
/// @throws InvalidInput if the cage is not valid, has a dart of two faces or the part's extent
/// would overflow, BackendError if OpenSubdiv does not take it, Cancelled
void add_cage(Part& part, const ControlCage& cage, const std::string& place,
              const CageOptions& options = {});

}  // namespace taut
