#include "taut/bounds/scene_frame.h"

#include <algorithm>
#include <cmath>

namespace taut {

SceneFrame scene_frame(const Box& box) {
  const dvec3 half = 0.5 * box.upper - 0.5 * box.lower;
  const double size = std::max({half.x, half.y, half.z});
  int exponent = 0;
  std::frexp(size, &exponent);
  if (size == 0) exponent = 0;
  // 2^1023 is the largest power of two: below 2^-1023 the frame stays smaller than one.
  return {box.center(), std::ldexp(1.0, std::min(-exponent, 1023))};
}

}  // namespace taut
