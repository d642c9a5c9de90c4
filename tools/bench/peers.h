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

/// Runs Taut, which returns the faces of its hull, and the peers on the points by turns, and prints
/// a table: median times, and the medians of Taut's time as a ratio to each peer's in the same
/// turn.
void compare_with_peers(const std::vector<taut::dvec3>& points, int runs,
                        const std::function<long()>& taut);

}  // namespace taut_bench
