#pragma once

#include <memory>
#include <string>
#include <utility>

#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/hull/hull_boundary.h"
#include "taut/hull/hull_mesh.h"

namespace taut {

/// How convex_hull works and how close it comes.
struct HullOptions {
  /// Largest distance of the mesh from the true hull, in model units. Zero: `relative` counts.
  double tolerance = 0;
  /// The same as a fraction of the diagonal of the model's box.
  double relative = 1e-4;
  /// Threads to use, 0 for all. The result does not depend on it.
  int threads = 0;
  /// Vertices, some thirty to begin with apart, after which refinement gives up (HullNotConverged
  /// is thrown). Each
  /// takes about 700 bytes meanwhile.
  int max_vertices = 4'000'000;
  Progress progress;
};

/// What the computation took.
struct HullStatistics {
  long support_queries = 0;
  long newton_iterations = 0;
  /// Cells of the CBVHs at the finest level of culling, and those that were kept.
  long cells = 0;
  long cells_kept = 0;
  /// Finer cells for which neither a proof nor a known contact accounts (SeparatingGraph).
  long cells_searched = 0;
  double seconds_gauss_map = 0;
  double seconds_sample = 0;
  double seconds_cull = 0;
  double seconds_trace = 0;
  double seconds_stitch = 0;
  double seconds_mesh = 0;

  /// Adds all counts and times; cells are those of either.
  HullStatistics& operator+=(const HullStatistics& other);
};

/// What a convex hull is. The value is its dimension.
enum class HullKind { empty = -1, point, segment, planar, solid };

/// A convex hull with its certificate.
struct Hull {
  HullKind kind = HullKind::empty;
  HullMesh mesh;
  /// Proven upper bound of the Hausdorff distance between the mesh and the true convex hull of the
  /// model as it stands, in model units, rounding included. What patches that stand for other
  /// surfaces miss (Model::deviation_bound, of control cages) comes on top.
  double distance_bound = 0;
  /// The exact boundary, where the method finds it.
  std::shared_ptr<const HullBoundary> boundary;
  HullStatistics statistics;

  int dimension() const { return static_cast<int>(kind); }
};

/// The tolerance was not reached; `best` is the hull found, a valid one whose distance_bound says
/// how far it came (no farther than the diagonal where nothing could be certified).
class HullNotConverged : public NotConverged {
 public:
  HullNotConverged(const std::string& message, Hull hull)
      : NotConverged(message, hull.distance_bound),
        best(std::make_shared<const Hull>(std::move(hull))) {}
  std::shared_ptr<const Hull> best;
};

/// Convex hull of a model: polyhedral_hull() where it is made of points and polygons alone,
/// precise_hull() otherwise. A model without geometry has the empty hull.
/// @throws as these do
Hull convex_hull(const Model& model, const HullOptions& options = {});
/// The same of a scene that is there already.
Hull convex_hull(const Scene& scene, const HullOptions& options = {});

/// Convex hull of points and polygons: its vertices are points of the input as they stand.
///
/// Exact up to the rounding that the input's coordinates carry: of points that stick out less than
/// coordinate_rounding (tolerances.h), and no farther than spurious_share of the diagonal, only
/// enough are kept that no others reach farther than that above any facet, and distance_bound says
/// how far that is. A turned cube of points so has twelve triangles or six squares and a turned
/// polygon is planar, whatever rounding did to them. Where nothing of the kind is there, always
/// where the points are as close as their rounding, and where a vertex has too many neighbours for
/// the search (ten thousand and more), the hull is exact. It is exactly convex and has no face of
/// zero area in any case. The tolerance does not matter.
///
/// Duplicates, points within and empty parts change nothing. Same bits for any number of threads.
/// Faces carry as source the first polygon that lies in them and touches a corner of their hull
/// face.
/// @pre model.polyhedral() @throws InvalidInput if the tolerance is not valid, Cancelled
Hull polyhedral_hull(const Model& model, const HullOptions& options = {});

/// Convex hull of a scene with its exact boundary (method `precise`): trimmed patches of the model,
/// developable scrolls and flat facets in Hull::boundary, and a mesh of it.
///
/// The mesh is one as of sampled_hull(), with the same certificate, but its vertices lie on the
/// boundary's curves too, and its faces are labelled by the boundary's faces. What of the boundary
/// could not be resolved is listed there; the mesh is true all the same. A scene that is flat has
/// no boundary: its hull is that of sampled_hull().
/// @throws as sampled_hull()
Hull precise_hull(const Scene& scene, const HullOptions& options = {});

/// Convex hull of a scene as a polytope of points sampled on the model (method `sampled`).
///
/// The mesh's vertices are support points of the model, rounded to double; the mesh is closed and
/// exactly convex (every orientation predicate holds on the coordinates as stored), has no face of
/// zero area, and its Hausdorff distance from the true hull is at most distance_bound, which is at
/// most the tolerance, rounding apart. Same bits for any number of threads. Safe to call
/// concurrently.
///
/// A scene thinner than flat_width and its like (tolerances.h) in some direction is planar, a
/// segment or a point; its corners are support points too, and a planar outline is convex as seen
/// along the axis that foreshortens it least.
///
/// @throws InvalidInput if the tolerance is not valid, HullNotConverged if it is below what double
/// precision can certify for this scene (about 1e-12 of its size) or max_vertices was met,
/// Cancelled
Hull sampled_hull(const Scene& scene, const HullOptions& options = {});

/// The tolerance that the options ask for, in model units; positive where the diagonal is.
/// @throws InvalidInput if the tolerance is negative or no number, or counts and the relative one
/// is not positive and finite, or leaves the range of doubles
double tolerance_for(const HullOptions& options, double diagonal);

}  // namespace taut
