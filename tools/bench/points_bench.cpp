// Hulls of points, in a ball and on a sphere, against CGAL and Qhull. One thread; the programs take
// turns within one run, and the medians of the paired ratios are printed. Taut's time is that of
// the whole result: labels, half-edge mesh and certificate included.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "peers.h"
#include "taut/hull/convex_hull.h"

namespace {

using namespace taut;        // NOLINT: a program
using namespace taut_bench;  // NOLINT

std::vector<dvec3> random_points(std::size_t count, bool on_sphere) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> share;
  std::vector<dvec3> points;
  while (points.size() < count) {
    const double x = gaussian(random);
    const double y = gaussian(random);
    const dvec3 n = unit({x, y, gaussian(random)});
    points.push_back(on_sphere ? n : std::cbrt(share(random)) * n);
  }
  return points;
}

void compare(std::size_t count, bool on_sphere, int runs) {
  const std::vector<dvec3> points = random_points(count, on_sphere);
  Part part;
  part.add_points(points);
  Model model;
  model.add_part(std::move(part), 0);
  std::printf("\n%zu points %s\n", count, on_sphere ? "on a sphere" : "in a ball");
  compare_with_peers(
      points, runs,
      {{"taut",
        [&] { return long(convex_hull(model, {.threads = 1, .progress = {}}).mesh.n_faces()); }}});
}

}  // namespace

/// points_bench [POINTS [RUNS]]
int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 3;
  compare(count, false, runs);
  compare(count, true, runs);
}
