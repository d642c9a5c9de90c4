#pragma once

#include <vector>

#include "taut/bounds/scene_content.h"

namespace taut {

/// An element's homogeneous control points in the scene's frame.
inline std::vector<dvec4> placed_net(const SceneContent& content, int instance,
                                     const SceneElement& element) {
  const SceneInstance& placed = content.instances[std::size_t(instance)];
  const SceneNet& net = element.net;
  std::vector<dvec4> result;
  result.reserve(net.x.size());
  for (std::size_t k = 0; k < net.x.size(); ++k) {
    const dvec3 p(net.x[k], net.y[k], net.z[k]);
    const dvec3 x = placed.rotated ? placed.rotation * p : p;
    result.emplace_back(x + net.w[k] * placed.translation, net.w[k]);
  }
  return result;
}

}  // namespace taut
