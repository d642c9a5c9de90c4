#pragma once

#include <memory>
#include <string>
#include <utility>

#include "taut/core/error.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_mesh.h"
#include "taut/hull/result/hull_statistics.h"
#include "taut/surface/resolution.h"

namespace taut {

/// What a convex hull is. The value is its dimension.
enum class HullKind { empty = -1, point, segment, planar, solid };

/// A convex hull with its certificate.
struct Hull {
  HullKind kind = HullKind::empty;  ///< of which dimension it is
  HullMesh mesh;                    ///< labelled; in model units
  /// Proven upper bound of the Hausdorff distance between the mesh and the true convex hull of the
  /// model as it stands, in model units, rounding included. What patches that stand for other
  /// surfaces miss (Model::deviation_bound, of control cages) comes on top.
  double distance_bound = 0;
  /// What is nearer than this may be taken for one: as the options ask, or as the model tells, or
  /// coarser than that (Resolution::raised_from).
  Resolution resolution;
  /// Extreme points of points and polygons that are no vertices, since rounding of coordinates may
  /// have made them: they are within distance_bound.
  long points_left_out = 0;
  /// The exact boundary, where the method finds it.
  std::shared_ptr<const HullBoundary> boundary;
  HullStatistics statistics;  ///< what it took

  /// -1 if empty, else 0 to 3.
  int dimension() const { return static_cast<int>(kind); }
};

/// The tolerance was not reached; `best` is the hull found, a valid one whose distance_bound says
/// how far it came (no farther than the diagonal where nothing could be certified).
class HullNotConverged : public NotConverged {
 public:
  /// The message and the hull that was found.
  HullNotConverged(const std::string& message, Hull hull)
      : NotConverged(message, hull.distance_bound),
        best(std::make_shared<const Hull>(std::move(hull))) {}
  std::shared_ptr<const Hull> best;  ///< see HullNotConverged
};

/// A limit of time or memory was met (HullOptions::max_seconds, max_memory); `best` is the best
/// hull found until then, a valid one whose distance_bound says how far it came, and its boundary,
/// where it has one, is closed.
class HullLimitExceeded : public LimitExceeded {
 public:
  /// The message, which names the limit, and the hull that was found.
  HullLimitExceeded(const std::string& message, Hull hull)
      : LimitExceeded(message), best(std::make_shared<const Hull>(std::move(hull))) {}
  std::shared_ptr<const Hull> best;  ///< see HullLimitExceeded
};

}  // namespace taut
