#include "peers.h"

#include <algorithm>
#include <cstdio>

#include "taut/core/stopwatch.h"
#include "taut/hull/point_hull.h"

#ifdef TAUT_WITH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#endif
#ifdef TAUT_WITH_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

namespace taut_bench {

using taut::Box;
using taut::dvec3;
using taut::PointHull;
using taut::Stopwatch;

namespace {

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

std::vector<Peer> peers() {
  std::vector<Peer> result;
  result.push_back({"point hull of Taut", [](const std::vector<dvec3>& points) {
                      Box box;
                      for (const dvec3& p : points) box.include(p);
                      PointHull hull(box);
                      hull.add(points);
                      return long(hull.facet_count());
                    }});
#ifdef TAUT_WITH_CGAL
  result.push_back({"CGAL", [](const std::vector<dvec3>& points) {
                      using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
                      std::vector<Kernel::Point_3> input;
                      for (const dvec3& p : points) input.emplace_back(p.x, p.y, p.z);
                      CGAL::Surface_mesh<Kernel::Point_3> mesh;
                      CGAL::convex_hull_3(input.begin(), input.end(), mesh);
                      return long(mesh.number_of_faces());
                    }});
#endif
#ifdef TAUT_WITH_QHULL
  result.push_back({"Qhull", [](const std::vector<dvec3>& points) {
                      std::vector<double> input;
                      for (const dvec3& p : points) input.insert(input.end(), {p.x, p.y, p.z});
                      qhT qhull;
                      qh_zero(&qhull, stderr);
                      char options[] = "qhull Qt";
                      const int failed = qh_new_qhull(&qhull, 3, int(points.size()), input.data(),
                                                      False, options, nullptr, stderr);
                      const long faces = failed ? 0 : long(qhull.num_facets);
                      qh_freeqhull(&qhull, !qh_ALL);
                      int left = 0;
                      int total = 0;
                      qh_memfreeshort(&qhull, &left, &total);
                      return faces;
                    }});
#endif
  return result;
}

void compare_with_peers(const std::vector<dvec3>& points, int runs,
                        const std::function<long()>& taut) {
  const std::vector<Peer> others = peers();
  long faces = 0;
  std::vector<long> other_faces(others.size());
  std::vector<double> times;
  std::vector<std::vector<double>> other_times(others.size()), ratios(others.size());
  for (int run = 0; run < runs; ++run) {
    const Stopwatch watch;
    faces = taut();
    times.push_back(watch.seconds());
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Stopwatch other;
      other_faces[k] = others[k].faces(points);
      other_times[k].push_back(other.seconds());
      ratios[k].push_back(times.back() / other_times[k].back());
    }
  }
  std::printf("  %-20s %10.2f ms  %9ld faces\n", "taut", 1e3 * median(times), faces);
  for (std::size_t k = 0; k < others.size(); ++k) {
    std::printf("  %-20s %10.2f ms  %9ld faces  %9zu points    time ratio %.3f, faces ratio %.3f\n",
                others[k].name.c_str(), 1e3 * median(other_times[k]), other_faces[k], points.size(),
                median(ratios[k]), double(faces) / double(other_faces[k]));
  }
}

}  // namespace taut_bench
