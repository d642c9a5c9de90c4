#pragma once

#include <vector>

#include "taut/core/progress.h"
#include "taut/subdivision/conforming.h"
#include "taut/surface/control_cage.h"

namespace taut {

struct LimitOptions {
  /// What the stand-ins of small neighbourhoods may change the support function by, as a fraction
  /// of the diagonal of the cage's box.
  double accuracy = 1e-9;
  Progress progress;  ///< of the step "refine"
};

/// The limit surface of a control cage as patches.
struct LimitSurface {
  /// By cage face; those of a face one after the other.
  std::vector<SurfacePatch> patches;
  /// Proven bound of what the stand-ins change the support function by.
  double deviation_bound = 0;
  /// The accuracy asked for, as a length. The bound is more where cells would become too small.
  double accuracy = 0;
  /// Faces of the cage whose surface is no single polynomial, and those of them that were refined.
  long irregular_faces = 0;
  long refined_faces = 0;
  /// Levels of the finest patches.
  int levels = 0;
  /// What OpenSubdiv treats by rules of its own.
  long non_manifold_edges = 0;
  long non_manifold_vertices = 0;
};

/// The limit surface of a control cage.
///
/// Where the cage is regular, patches are exactly the surface: bicubic ones of Catmull-Clark cages,
/// of Loop cages three of degree (4, 4) for each quartic triangle. The neighbourhoods of
/// extraordinary vertices, of semi-sharp creases and of other irregular features are refined level
/// by level, each of which leaves exact patches, until what remains has a bound within the accuracy
/// or is so small that its sides would be taken for points; OpenSubdiv's polynomial end caps stand
/// for the rest. Those that surely do not touch the convex hull of the surface are not refined at
/// all (but faces that are no quads, once), unless cells at one of their vertices are: with these
/// go all others in the vertex's sector between sharp edges, and beyond such edges even regular
/// ones. So patches meet along whole sides: each side has, as far as the cage is a manifold, one
/// other with the same vertices, which agrees with it up to rounding.
///
/// The bound: limit surface and end cap lie within the convex hull of the control points and the
/// cap's, no farther than that from the convex hull of known points of the surface around.
/// @pre validate() passes @throws BackendError, InvalidInput (CageLevel), Cancelled
LimitSurface limit_patches(const ControlCage& cage, const LimitOptions& options = {});

}  // namespace taut
