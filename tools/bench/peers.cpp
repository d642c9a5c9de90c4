#include "peers.h"

#include <algorithm>
#include <cstdio>

#include "taut/core/stopwatch.h"
#include "taut/hull/polytope/point_hull.h"

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
                        const std::vector<Method>& methods) {
  struct Result {
    long faces = 0;
    std::vector<double> times;
  };
  const auto timed = [](Result& result, const std::function<long()>& run) {
    const Stopwatch watch;
    result.faces = run();
    result.times.push_back(watch.seconds());
  };
  const std::vector<Peer> others = peers();
  std::vector<Result> own(methods.size()), theirs(others.size());
  for (int run = 0; run < runs; ++run) {
    for (std::size_t m = 0; m < methods.size(); ++m) timed(own[m], methods[m].faces);
    for (std::size_t k = 0; k < others.size(); ++k) {
      timed(theirs[k], [&] { return others[k].faces(points); });
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::printf("  %-20s %10.2f ms  %9ld faces\n", methods[m].name.c_str(),
                1e3 * median(own[m].times), own[m].faces);
  }
  for (std::size_t k = 0; k < others.size(); ++k) {
    std::printf("  %-20s %10.2f ms  %9ld faces  %9zu points\n", others[k].name.c_str(),
                1e3 * median(theirs[k].times), theirs[k].faces, points.size());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      std::vector<double> ratios;
      for (std::size_t run = 0; run < own[m].times.size(); ++run) {
        ratios.push_back(own[m].times[run] / theirs[k].times[run]);
      }
      std::printf("    %s to it: time ratio %.3f, faces ratio %.3f\n", methods[m].name.c_str(),
                  median(ratios), double(own[m].faces) / double(theirs[k].faces));
    }
  }
}

}  // namespace taut_bench
