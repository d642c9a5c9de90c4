#include "peers.h"

#include <algorithm>
#include <chrono>

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

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

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

}  // namespace taut_bench
