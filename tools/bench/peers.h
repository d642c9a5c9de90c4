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

double seconds(const std::function<void()>& work);
double median(std::vector<double> values);

}  // namespace taut_bench
