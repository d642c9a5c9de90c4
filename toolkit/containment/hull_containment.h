#pragma once

#include <memory>
#include <span>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/containment/location.h"
#include "taut/core/progress.h"

namespace taut {

/// How points are located in hulls.
struct HullContainmentOptions {
  /// How near the mesh is to the hull that decides the points far from the boundary, as a fraction
  /// of the diagonal. A finer one leaves fewer points to the exact search and takes longer to make.
  double mesh_relative = 1e-4;
  /// Points nearer to the boundary are on it, in model units; negative: default_on_tolerance of the
  /// diagonal.
  double on_tolerance = -1;
  /// How well distances are to be known, in model units; negative: default_distance_accuracy of the
  /// diagonal. What cannot be reached is told by their bounds.
  double accuracy = -1;
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
};

/// Tells whether points lie inside, on or outside a scene's convex hull, and how far from its
/// boundary. The hull is the exact one, not a mesh of it.
///
/// Points far from the boundary are decided by a mesh of certified distance: Embree proposes the
/// facet through which the ray from the middle leaves, and in double precision either the facet's
/// supporting plane has the point outside (no point of the model is beyond it), or the tetrahedron
/// of the middle and the facet's corners, which are support points, has it inside. All others are
/// decided by the exact support function (hull_distance.h). So an answer other than `on` is proven,
/// whatever Embree says.
///
/// A flat hull (planar, a segment, a point) has no inside. Where surfaces stand for the limit
/// surface of a cage, answers hold for these (Model::deviation_bound tells what that may change).
///
/// Immutable, safe to query concurrently. Same bits for any number of threads.
class HullContainment {
 public:
  /// The scene must outlive it. @throws InvalidInput if a tolerance is no number or mesh_relative
  /// is not positive, BackendError or LimitExceeded if Embree fails, Cancelled
  explicit HullContainment(const Scene& scene, const HullContainmentOptions& options = {});
  ~HullContainment();
  /// Leaves the other one to be destroyed.
  HullContainment(HullContainment&&) noexcept;

  /// @name One point, in model coordinates @throws InvalidInput if it is not finite
  /// @{

  /// Whether the point is proven to lie inside or outside.
  Location locate(const dvec3& x) const;
  /// From the boundary, negative inside.
  SignedDistance distance(const dvec3& x) const;
  /// @}

  /// @name Many points, in their order, on the threads of the options
  /// What it took is added to `counts`, where given. @throws InvalidInput as above, Cancelled
  /// @{

  /// As locate() of one point.
  std::vector<Location> locate(std::span<const dvec3> points,
                               ContainmentCounts* counts = nullptr) const;
  /// As distance() of one point.
  std::vector<SignedDistance> distances(std::span<const dvec3> points,
                                        ContainmentCounts* counts = nullptr) const;
  /// @}

  /// In model units.
  double on_tolerance() const;
  /// Proven distance of the mesh from the hull, in model units; infinite where the hull is flat.
  double mesh_distance() const;

 private:
  struct Content;
  class Worker;
  std::unique_ptr<const Content> content_;
};

}  // namespace taut
