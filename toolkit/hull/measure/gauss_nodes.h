#pragma once

#include <type_traits>

namespace taut {

/// Nodes of the Gauss rules for patches, of which the first one that is accurate serves: few do
/// where a patch is small beside its radii of curvature.
inline constexpr int few_nodes = 6;
inline constexpr int some_nodes = 10;
inline constexpr int many_nodes = 16;

/// Calls `f` with one of these numbers as an integral constant.
template <class Function>
void with_nodes(int nodes, const Function& f) {
  if (nodes == few_nodes) {
    f(std::integral_constant<int, few_nodes>());
  } else if (nodes == some_nodes) {
    f(std::integral_constant<int, some_nodes>());
  } else {
    f(std::integral_constant<int, many_nodes>());
  }
}

}  // namespace taut
