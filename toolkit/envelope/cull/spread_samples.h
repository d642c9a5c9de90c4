#pragma once

#include <vector>

#include "taut/bounds/normal_pyramid.h"
#include "taut/bounds/scene.h"
#include "taut/envelope/cull/culling.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// Support points of directions spread over the sphere, one for each of its cells: the more, the
/// more patches there are.
class SpreadSamples {
 public:
  /// @throws Cancelled
  SpreadSamples(const Scene& scene, std::size_t patches, const CullingOptions& options);

  const std::vector<Sample>& samples() const { return samples_; }
  /// Of the samples, in the scene's frame.
  const std::vector<dvec3>& points() const { return points_; }
  /// Index of the sample whose cell holds the direction.
  std::size_t nearest(const dvec3& n) const;
  /// The pyramid is so wide that its axis has a sample that is as good as its own.
  bool is_dense_in(const NormalPyramid& pyramid) const;

 private:
  int level_;
  std::vector<Sample> samples_;
  std::vector<dvec3> points_;
};

}  // namespace taut
