#include "taut/bounds/model_support.h"

#include <cmath>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"

namespace taut {

ModelSupport support(SupportQuery& query, const Scene& scene, const dvec3& direction) {
  const dvec3 n = unit(direction);
  if (!(std::abs(glm::length(n) - 1) < 0.5)) {
    throw InvalidInput("a direction must be finite and not zero");
  }
  const Support s = query(n);
  const SceneFrame& frame = scene.frame();
  // h = h_frame / scale + center . n: three products and sums of the centre's size.
  const double shift = glm::dot(frame.center, n);
  const double rounding = 8 * rounding_unit * glm::length(frame.center);
  return {frame.length_to_model(s.h) + shift, frame.length_to_model(s.h_bound) + shift + rounding,
          frame.to_model(s.point), scene.source(s.contact)};
}

}  // namespace taut
