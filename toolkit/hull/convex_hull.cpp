#include "taut/hull/convex_hull.h"

#include "taut/hull/polyhedral/polyhedral_hull.h"
#include "taut/hull/precise_hull.h"

namespace taut {

Hull convex_hull(const Model& model, const HullOptions& options) {
  if (model.empty()) {
    tolerance_for(options, 0);
    resolution_for(options, model, 0);
    within_limits(options);
    return {};
  }
  if (model.polyhedral()) return polyhedral_hull(model, options);
  const HullOptions own = within_limits(options);
  const Scene scene(model, {own.threads, own.progress});
  return precise_hull(scene, own);
}

Hull convex_hull(const Scene& scene, const HullOptions& options) {
  return scene.model().polyhedral() ? polyhedral_hull(scene.model(), options)
                                    : precise_hull(scene, options);
}

}  // namespace taut
