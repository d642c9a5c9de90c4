#pragma once

#include <functional>
#include <string>
#include <vector>

#include "taut/core/geometry.h"

namespace taut_bench {

/// A program that computes the convex hull of points, and returns how many faces it has.
struct Peer {
  std::string name;
  std::function<long(const std::vector<taut::dvec3>&)> faces;
};

/// Taut's own point hull without labels and mesh; CGAL and Qhull where they were found.
std::vector<Peer> peers();

/// A way in which Taut computes the hull, and returns how many faces it has.
struct Method {
  std::string name;
  std::function<long()> faces;
};

/// Runs Taut and the peers on the points by turns, and prints a table: median times, and for each
/// method the median of its time as a ratio to each peer's in the same turn.
void compare_with_peers(const std::vector<taut::dvec3>& points, int runs,
                        const std::vector<Method>& methods);

}  // namespace taut_bench
