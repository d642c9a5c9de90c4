#pragma once

#include <array>
#include <memory>
#include <span>

#include "taut/bounds/scene.h"
#include "taut/core/stop.h"

namespace taut {

/// A closed rectangle of a patch of one instance.
struct PatchRectangle {
  int instance = -1;
  int patch = -1;
  Interval u, v;
};

/// Proves that a scene does not reach beyond some points of it, in all directions of a pyramid at
/// once: directions inside are combinations of the corners, and a sum of negative terms is
/// negative.
///
/// Holds scratch memory, so use one object a thread; the scene must outlive it.
class ReachTest {
 public:
  /// `stop`: makes what follows throw Cancelled.
  explicit ReachTest(const Scene& scene, Stop stop = {});
  ~ReachTest();

  /// True is certain: for every point x of the scene, those of the rectangles apart, one of the
  /// points p has (x - p) . n < 0 for all n of the pyramid. Points and directions in the scene's
  /// frame, each p within the rounding of a Support's point.
  ///
  /// Cells that would have to be smaller than 2^-finest of their patch are not tried: then the
  /// answer is false. @pre points are not empty
  bool surely_below(std::span<const dvec3> points, const std::array<dvec3, 4>& corners,
                    std::span<const PatchRectangle> except, int finest);

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace taut
