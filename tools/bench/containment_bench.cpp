// Points in the teapot's hull, far from its boundary and next to it, against CGAL's
// Side_of_triangle_mesh on a hull mesh and a loop over that mesh's half-spaces. One thread; the
// programs take turns within one run, and the medians of the paired ratios are printed. Only Taut
// answers for the exact hull: the others answer for the mesh, so next to the boundary they are no
// peers.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "taut/bounds/model_support.h"
#include "taut/containment/hull_containment.h"
#include "taut/core/stopwatch.h"
#include "taut/hull/convex_hull.h"
#include "teapot.h"

#ifdef TAUT_WITH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#endif

namespace {

using namespace taut;  // NOLINT: a program

/// Counts the points inside.
using Count = std::function<long(const std::vector<dvec3>&)>;

struct Program {
  std::string name;
  Count inside;
};

Count half_spaces(const PolygonMesh& mesh) {
  struct Plane {
    dvec3 n;
    double offset;
  };
  std::vector<Plane> planes;
  for (const std::vector<int>& polygon : mesh.polygons) {
    const auto at = [&](std::size_t k) { return mesh.points[std::size_t(polygon[k])]; };
    const dvec3 n = unit(glm::cross(at(1) - at(0), at(2) - at(0)));
    planes.push_back({n, glm::dot(n, at(0))});
  }
  return [planes](const std::vector<dvec3>& points) {
    return std::count_if(points.begin(), points.end(), [&](const dvec3& x) {
      return std::all_of(planes.begin(), planes.end(),
                         [&](const Plane& p) { return glm::dot(p.n, x) <= p.offset; });
    });
  };
}

#ifdef TAUT_WITH_CGAL
Count side_of_mesh(const PolygonMesh& polygons) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  const auto mesh = std::make_shared<Mesh>();
  for (const dvec3& p : polygons.points) mesh->add_vertex({p.x, p.y, p.z});
  for (const std::vector<int>& polygon : polygons.polygons) {
    std::vector<Mesh::Vertex_index> corners;
    corners.reserve(polygon.size());
    for (const int v : polygon) corners.emplace_back(Mesh::size_type(v));
    mesh->add_face(corners);
  }
  CGAL::Polygon_mesh_processing::triangulate_faces(*mesh);
  const auto side = std::make_shared<CGAL::Side_of_triangle_mesh<Mesh, Kernel>>(*mesh);
  return [mesh, side](const std::vector<dvec3>& points) {
    return std::count_if(points.begin(), points.end(), [&](const dvec3& x) {
      return (*side)(Kernel::Point_3(x.x, x.y, x.z)) == CGAL::ON_BOUNDED_SIDE;
    });
  };
}
#endif

template <class Containment>
Count inside_of(const Containment& containment) {
  return [&](const std::vector<dvec3>& points) {
    const std::vector<Location> found = containment.locate(points);
    return std::count(found.begin(), found.end(), Location::inside);
  };
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// The first program against the others, by turns.
void compare(const char* title, const std::vector<Program>& programs,
             const std::vector<dvec3>& points, int runs) {
  std::printf("\n%s: %zu points\n", title, points.size());
  std::vector<std::vector<double>> times(programs.size());
  std::vector<long> inside(programs.size());
  for (int run = 0; run < runs; ++run) {
    for (std::size_t k = 0; k < programs.size(); ++k) {
      const Stopwatch watch;
      inside[k] = programs[k].inside(points);
      times[k].push_back(watch.seconds());
    }
  }
  for (std::size_t k = 0; k < programs.size(); ++k) {
    std::vector<double> ratios;
    ratios.reserve(std::size_t(runs));
    for (int run = 0; run < runs; ++run) {
      ratios.push_back(times[0][std::size_t(run)] / times[k][std::size_t(run)]);
    }
    std::printf("  %-28s %9.3f M points/s  %9ld inside", programs[k].name.c_str(),
                1e-6 * double(points.size()) / median(times[k]), inside[k]);
    if (k > 0) std::printf("  time ratio %.4f", median(ratios));
    std::printf("\n");
  }
}

/// Random ones in the box and next to it that are not on the boundary.
std::vector<dvec3> far_points(const HullContainment& hull, const Scene& scene, std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  std::vector<dvec3> points;
  while (points.size() < count) {
    const double a = uniform(random);
    const double b = uniform(random);
    const dvec3 x =
        scene.box().lower + dvec3(a, b, uniform(random)) * (scene.box().upper - scene.box().lower);
    if (hull.locate(x) != Location::on) points.push_back(x);
  }
  return points;
}

/// On either side of the boundary.
std::vector<dvec3> near_points(const Scene& scene, double share, std::size_t count) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> gaussian;
  SupportQuery query(scene);
  std::vector<dvec3> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = gaussian(random);
    const double b = gaussian(random);
    const dvec3 n = unit({a, b, gaussian(random)});
    const double d = share * scene.diagonal();
    points.push_back(support(query, scene, n).point + (k % 2 == 0 ? d : -d) * n);
  }
  return points;
}

}  // namespace

/// containment_bench [POINTS [RUNS]]
int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 5;
  const Scene& scene = teapot_scene();
  HullContainmentOptions options;
  options.threads = 1;
  const Stopwatch watch;
  const HullContainment hull(scene, options);
  std::printf("teapot: prepared in %.3f s\n", watch.seconds());
  options.on_tolerance = 1e-3 * scene.diagonal();
  const HullContainment loose(scene, options);
  const std::vector<dvec3> far = far_points(loose, scene, count);

  const Hull mesh = convex_hull(scene, {.relative = 1e-4, .threads = 1, .progress = {}});
  const PolygonMesh triangles = polygons(mesh.mesh);
  std::vector<Program> programs = {{"taut, the exact hull", inside_of(hull)},
                                   {"half-spaces of its mesh", half_spaces(triangles)}};
#ifdef TAUT_WITH_CGAL
  programs.push_back({"CGAL, side of its mesh", side_of_mesh(triangles)});
#endif
  std::printf("the mesh has %zu faces\n", triangles.polygons.size());
  compare("farther than 1e-3 from the boundary", programs, far, runs);
  const std::vector<Program> alone(programs.begin(), programs.begin() + 1);
  const std::vector<std::pair<const char*, double>> shares = {
      {"at 1e-3 of the diagonal from it", 1e-3},
      {"at 1e-6", 1e-6},
      {"at 1e-9", 1e-9},
      {"at 1e-12", 1e-12}};
  for (const auto& [title, share] : shares) {
    compare(title, alone, near_points(scene, share, count / 20), 1);
  }
  const std::vector<dvec3> some(far.begin(), far.begin() + std::ptrdiff_t(count / 100));
  const Program distances{"taut", [&](const std::vector<dvec3>& points) {
                            const std::vector<SignedDistance> found = hull.distances(points);
                            return std::count_if(found.begin(), found.end(),
                                                 [](const auto& d) { return d.value < 0; });
                          }};
  compare("signed distances, certified to 1e-12", {distances}, some, 1);
}
