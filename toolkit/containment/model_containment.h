#pragma once

#include <memory>
#include <span>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/containment/location.h"
#include "taut/core/progress.h"

namespace taut {

/// How points are located in closed models.
struct ModelContainmentOptions {
  /// How near the tessellation is to the surface that decides the points far from it, as a fraction
  /// of the diagonal. A finer one leaves fewer points to exact tests.
  double mesh_relative = 1e-3;
  /// Points nearer to the surface are on it, in model units; negative: default_on_tolerance of the
  /// diagonal, or how far joined sides of patches are apart if that is more.
  double on_tolerance = -1;
  /// How well distances are to be known, in model units; negative: default_distance_accuracy of the
  /// diagonal.
  double accuracy = -1;
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
};

/// Tells whether points lie inside, on or outside a closed freeform model, and how far from its
/// surface.
///
/// Each instance is a body of its own: inside are the points from which rays cross its surface an
/// odd number of times, so a shell within a shell is a hollow. A point is inside the model if it is
/// inside one of its bodies. Curves, points and what repeats a patch do not count.
///
/// Far from a tessellation of proven deviation Embree counts the crossings, with two random rays
/// that must agree and are shot anew where one passes next to a triangle's side. Near it, and in
/// doubt, the patches themselves decide in double precision: their distance by branch and bound,
/// proven, and a ray's crossings with them (ray_crossings.h).
///
/// Where surfaces stand for the limit surface of a cage (CageOfPart), answers hold for these.
///
/// Immutable, safe to query concurrently. Same bits for any number of threads.
class ModelContainment {
 public:
  /// The scene must outlive it. @throws InvalidInput with the reason if the model is not closed
  /// (every side of a patch or polygon must be joined with exactly one other), has polygons that
  /// are not planar, or an option is no number; BackendError or LimitExceeded if Embree fails
  explicit ModelContainment(const Scene& scene, const ModelContainmentOptions& options = {});
  ~ModelContainment();
  /// Leaves the other one to be destroyed.
  ModelContainment(ModelContainment&&) noexcept;

  /// @name One point, in model coordinates @throws InvalidInput if it is not finite
  /// @{

  /// Whether the point is proven to lie inside or outside.
  Location locate(const dvec3& x) const;
  /// Inside several bodies the distance to the surface of the one in which the point is deepest;
  /// `lower` accounts for what lies beyond.
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

 private:
  struct Content;
  class Worker;
  std::unique_ptr<const Content> content_;
};

}  // namespace taut
