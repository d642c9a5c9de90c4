#include "taut/verify/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "hull_checks.h"
#include "taut/core/error.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// The box (0, 1) x (0, 2) x (0, 3) in hexahedron order: vertex k has the bits of k as coordinates.
PolygonMesh box_mesh() {
  PolygonMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.points.emplace_back(k & 1, 2 * (k >> 1 & 1), 3 * (k >> 2 & 1));
  mesh.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

/// The octahedron with corners on the axes.
PolygonMesh octahedron_mesh() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

Shape points_of(const PolygonMesh& mesh) { return {{}, {}, mesh.points}; }

PolygonMesh scaled(PolygonMesh mesh, double size) {
  for (dvec3& p : mesh.points) p *= size;
  return mesh;
}

PolygonMesh hull_of(const Scene& scene, double tolerance) {
  return polygons(sampled_hull(scene, {.tolerance = tolerance, .threads = 1, .progress = {}}).mesh);
}

Verification verified_mesh(const PolygonMesh& mesh, const Scene& scene, int directions = 500) {
  return verify(mesh, scene,
                {.random_directions = directions, .seed = 1, .threads = 1, .progress = {}});
}

/// Closed, manifold, oriented, convex, without faces of zero area.
void expect_flags(const Verification& v, const std::string& flags, const std::string& name) {
  std::string found;
  for (const bool flag : {v.closed, v.manifold, v.oriented, v.convex, v.no_zero_area}) {
    found += flag ? '1' : '0';
  }
  EXPECT_EQ(found, flags) << name;
}

void expect_good(const PolygonMesh& mesh, const Scene& scene, double tolerance,
                 const std::string& name) {
  const Verification v = verified_mesh(mesh, scene);
  expect_flags(v, "11111", name);
  const double rounding = 1e-12 * scene.diagonal();
  EXPECT_LE(v.largest_violation, rounding) << name;
  EXPECT_LE(v.model_outside, tolerance) << name;
  EXPECT_LE(v.mesh_outside, rounding) << name;
  EXPECT_TRUE(v.is_hull(tolerance)) << name;
}

TEST(Verify, GoodHullsPass) {
  const std::vector<std::pair<std::string, Shape>> shapes = {
      {"box", box(1, 2, 3)},        {"sphere", sphere()},
      {"torus", torus(2, 0.5)},     {"oloid", oloid()},
      {"teapot", teapot()},         {"filleted box", filleted_box(1, 2, 3, 0.2)},
      {"saddle", bilinear_saddle()}};
  for (const auto& [name, shape] : shapes) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const Scene scene = make_scene(mapped(shape, turn));
      const double tolerance = 1e-3 * scene.diagonal();
      expect_good(hull_of(scene, tolerance), scene, tolerance, name);
    }
  }
}

TEST(Verify, HandMadeHullsPassAtAnySize) {
  for (const double size : {1e-300, 1e-200, 1e-100, 1e-3, 1.0, 1e3, 1e100, 1e200, 1e300}) {
    const std::string name = "size " + std::to_string(std::log10(size));
    expect_good(scaled(box_mesh(), size), make_scene(scaled(box(1, 2, 3), size)), 1e-12 * size,
                "box, " + name);
    const PolygonMesh mesh = scaled(octahedron_mesh(), size);
    expect_good(mesh, make_scene(points_of(mesh)), 1e-12 * size, "octahedron, " + name);
  }
}

TEST(Verify, ModelFarFromTheOrigin) {
  const dvec3 far(0x1p40, -0x1p40, 0x1p41);
  PolygonMesh mesh = box_mesh();
  for (dvec3& p : mesh.points) p += far;
  const Scene scene = make_scene(shifted(box(1, 2, 3), far));
  const Verification v = verified_mesh(mesh, scene);
  expect_flags(v, "11111", "far box");
  EXPECT_TRUE(v.is_hull(1e-10));
}

/// A fault in a mesh of size about one, and the flags that show it.
struct Fault {
  std::string name;
  std::function<void(PolygonMesh&)> damage;
  std::string flags;
};

const std::vector<Fault>& faults_of_the_box() {
  using Mesh = PolygonMesh;
  static const std::vector<Fault> faults = {
      {"flipped face", [](Mesh& m) { std::reverse(m.polygons[3].begin(), m.polygons[3].end()); },
       "11001"},
      {"missing face", [](Mesh& m) { m.polygons.pop_back(); }, "01001"},
      {"inward",
       [](Mesh& m) {
         for (auto& p : m.polygons) std::reverse(p.begin(), p.end());
       },
       "11001"},
      {"vertex moved out", [](Mesh& m) { m.points[7] += 1e-3; }, "11101"},
      {"vertex moved in", [](Mesh& m) { m.points[7] -= 1e-3; }, "11101"},
      {"quad that is not planar", [](Mesh& m) { m.points[7].z += 1e-12; }, "11101"},
      {"face twice", [](Mesh& m) { m.polygons.push_back(m.polygons[0]); }, "00001"},
      {"second component",
       [](Mesh& m) {
         const Mesh other = m;
         for (dvec3 p : other.points) m.points.push_back(0.5 * p + 0.25);
         for (auto p : other.polygons) {
           for (int& v : p) v += 8;
           m.polygons.push_back(p);
         }
       },
       "11101"},
      {"the same once more",
       [](Mesh& m) {
         const Mesh other = m;
         m.points.insert(m.points.end(), other.points.begin(), other.points.end());
         for (auto p : other.polygons) {
           for (int& v : p) v += 8;
           m.polygons.push_back(p);
         }
       },
       "11101"},
      {"bow-tie vertex",
       [](Mesh& m) {
         // A tetrahedron inside that hangs on corner 0.
         m.points.insert(m.points.end(), {{0.5, 0.25, 0.25}, {0.25, 0.5, 0.25}, {0.25, 0.25, 0.5}});
         m.polygons.insert(m.polygons.end(), {{0, 9, 8}, {0, 8, 10}, {0, 10, 9}, {8, 9, 10}});
       },
       "10101"},
      {"non-manifold edge",
       [](Mesh& m) {
         // A tetrahedron inside that hangs on edge 0 - 1.
         m.points.insert(m.points.end(), {{0.5, 0.5, 0.25}, {0.5, 0.25, 0.5}});
         m.polygons.insert(m.polygons.end(), {{0, 8, 1}, {0, 1, 9}, {0, 9, 8}, {1, 8, 9}});
       },
       "00001"},
      {"dent",
       [](Mesh& m) {
         m.points.emplace_back(0.5, 1, 3 - 1e-3);
         m.polygons[1] = {4, 5, 8};
         m.polygons.insert(m.polygons.end(), {{5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
       },
       "11101"},
      {"face of zero area",
       [](Mesh& m) {
         // Between corners 4 and 5 and the middle of that edge.
         m.points.emplace_back(0.5, 0, 3);
         m.polygons[1] = {4, 8, 5, 7, 6};
         m.polygons.push_back({4, 5, 8});
       },
       "11100"},
      {"face of one point thrice",
       [](Mesh& m) {
         m.points.insert(m.points.end(), 3, dvec3(0, 0, 0));
         m.polygons.push_back({8, 9, 10});
       },
       "01000"},
  };
  return faults;
}

TEST(Verify, FindsFaults) {
  for (const double size : {1.0, 1e-300, 1e300}) {
    const Scene scene = make_scene(taut_test::scaled(box(1, 2, 3), size));
    for (const Fault& fault : faults_of_the_box()) {
      const std::string name = fault.name + " at size 1e" + std::to_string(std::log10(size));
      PolygonMesh mesh = box_mesh();
      fault.damage(mesh);
      const Verification v = verified_mesh(scaled(mesh, size), scene);
      expect_flags(v, fault.flags, name);
      for (const double length : {v.largest_violation, v.model_outside, v.mesh_outside}) {
        EXPECT_TRUE(std::isfinite(length)) << name;
        EXPECT_GE(length, 0) << name;
      }
    }
  }
}

TEST(Verify, NoneOfTheFaultsIsAHull) {
  const Scene scene = make_scene(box(1, 2, 3));
  for (const Fault& fault : faults_of_the_box()) {
    // Rounded files are convex within the tolerance only.
    if (fault.name == "quad that is not planar" || fault.name == "face of zero area") continue;
    PolygonMesh mesh = box_mesh();
    fault.damage(mesh);
    EXPECT_FALSE(verified_mesh(mesh, scene).is_hull(0.9e-4)) << fault.name;
  }
}

TEST(Verify, MeasuresHowFarAVertexHasMoved) {
  for (const double size : {1e-300, 1e-100, 1.0, 1e100, 1e300}) {
    const Scene scene = make_scene(taut_test::scaled(box(1, 2, 3), size));
    const double d = 1e-3 * size;
    const dvec3 corner(1 / std::sqrt(3.0));
    PolygonMesh mesh = scaled(box_mesh(), size);
    mesh.points[7] += d * corner;
    const Verification out = verified_mesh(mesh, scene, 5000);
    EXPECT_NEAR(out.mesh_outside / size, 1e-3, 1e-5) << size;
    EXPECT_LE(out.model_outside, 1e-11 * size) << size;
    EXPECT_FALSE(out.is_hull(0.9 * d)) << size;

    mesh = scaled(box_mesh(), size);
    mesh.points[7] -= d * corner;
    const Verification in = verified_mesh(mesh, scene, 5000);
    EXPECT_NEAR(in.model_outside / size, 1e-3, 1e-5) << size;
    EXPECT_LE(in.mesh_outside, 1e-11 * size) << size;
    EXPECT_FALSE(in.is_hull(0.9 * d)) << size;
    EXPECT_TRUE(in.is_hull(1.1 * d)) << size;
  }
}

TEST(Verify, MovedVerticesOfAFineMesh) {
  const Scene scene = make_scene(mapped(sphere(), skew_rotation()));
  const PolygonMesh good = hull_of(scene, 1e-3);
  expect_good(good, scene, 1e-3, "sphere");
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    const auto v = std::size_t(pick(random, 0, int(good.points.size()) - 1));
    PolygonMesh mesh = good;
    mesh.points[v] *= 1 + 1e-2;
    const Verification out = verified_mesh(mesh, scene);
    EXPECT_FALSE(out.is_hull(5e-3));
    EXPECT_NEAR(out.mesh_outside, 1e-2, 1e-3);
    mesh.points[v] = good.points[v] * (1 - 1e-2);
    const Verification in = verified_mesh(mesh, scene);
    EXPECT_FALSE(in.convex);
    EXPECT_FALSE(in.is_hull(1e-3));
    EXPECT_GT(in.largest_violation, 5e-3);
  }
}

TEST(Verify, LargestViolationIsTheDentsDepth) {
  PolygonMesh mesh = octahedron_mesh();
  const Scene scene = make_scene(points_of(mesh));
  mesh.points.emplace_back(0.3, 0.3, 0.3);
  mesh.polygons[0] = {0, 2, 6};
  mesh.polygons.insert(mesh.polygons.end(), {{2, 4, 6}, {4, 0, 6}});
  const Verification v = verified_mesh(mesh, scene);
  expect_flags(v, "11101", "dent");
  real deepest = 0;
  for (const auto& p : mesh.polygons) {
    const auto at = [&](std::size_t k) { return rvec3(mesh.points[std::size_t(p[k])]); };
    const rvec3 n = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
    for (const dvec3& x : mesh.points) deepest = std::max(deepest, glm::dot(rvec3(x) - at(0), n));
  }
  EXPECT_NEAR(v.largest_violation, double(deepest), 1e-14);
  EXPECT_LE(v.mesh_outside, 1e-12);
  EXPECT_LE(v.model_outside, 1e-12);
}

TEST(Verify, HullOfAnotherModel) {
  const Scene one = make_scene(sphere());
  const Scene two = make_scene(two_spheres(1, 0.5, 2));
  const Verification small = verified_mesh(hull_of(one, 1e-3), two, 5000);
  expect_flags(small, "11111", "one sphere");
  EXPECT_NEAR(small.model_outside, 1.5, 2e-3);
  EXPECT_LE(small.mesh_outside, 1e-12);
  const Verification large = verified_mesh(hull_of(two, 1e-3), one, 5000);
  expect_flags(large, "11111", "two spheres");
  EXPECT_NEAR(large.mesh_outside, 1.5, 2e-3);
  EXPECT_LE(large.model_outside, 1e-3);
}

TEST(Verify, TorusIsNoHullOfItself) {
  // A closed manifold that is not convex: handles count.
  PolygonMesh mesh;
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = 0.5235987755982988 * i;
      const double v = 0.5235987755982988 * j;
      const double r = 2 + 0.5 * std::cos(v);
      mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), 0.5 * std::sin(v));
      const auto at = [](int a, int b) { return a % n * n + b % n; };
      mesh.polygons.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.polygons.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const Verification v = verified_mesh(mesh, make_scene(torus(2, 0.5)));
  expect_flags(v, "11101", "torus");
  EXPECT_GT(v.largest_violation, 0.5);
  EXPECT_LE(v.mesh_outside, 1e-12);
}

TEST(Verify, StarPolygonsAreNotConvex) {
  // Five-sided prism whose bottom and top wind about their centre twice: each edge is convex.
  PolygonMesh mesh;
  std::vector<int> bottom, top;
  for (int k = 0; k < 5; ++k) {
    const double t = 4 * 3.141592653589793 / 5 * k;
    mesh.points.emplace_back(std::cos(t), std::sin(t), 0);
    mesh.points.emplace_back(std::cos(t), std::sin(t), 1);
    const int next = 2 * ((k + 1) % 5);
    mesh.polygons.push_back({2 * k, next, next + 1, 2 * k + 1});
    top.push_back(2 * k + 1);
    bottom.insert(bottom.begin(), 2 * k);
  }
  mesh.polygons.push_back(bottom);
  mesh.polygons.push_back(top);
  const Verification v = verified_mesh(mesh, make_scene(points_of(mesh)));
  EXPECT_FALSE(v.convex);
  EXPECT_FALSE(v.is_hull(1e-3));
}

TEST(Verify, CountsItsDirections) {
  const Scene scene = make_scene(box(1, 2, 3));
  EXPECT_EQ(verified_mesh(box_mesh(), scene, 123).directions, 6 + 8 + 123);
  EXPECT_EQ(verified_mesh(box_mesh(), scene, 0).directions, 6 + 8);
}

TEST(Verify, SameForAnyNumberOfThreads) {
  const Scene scene = make_scene(teapot());
  const PolygonMesh mesh = hull_of(scene, 1e-2);
  const Verification one = verified_mesh(mesh, scene, 2000);
  for (const int threads : {2, 0}) {
    const Verification other = verify(
        mesh, scene, {.random_directions = 2000, .seed = 1, .threads = threads, .progress = {}});
    EXPECT_EQ(other.largest_violation, one.largest_violation);
    EXPECT_NEAR(other.model_outside, one.model_outside, 1e-11);
    EXPECT_NEAR(other.mesh_outside, one.mesh_outside, 1e-11);
    EXPECT_EQ(other.directions, one.directions);
  }
}

TEST(Verify, FlatMeshes) {
  // Two-sided: closed, but without volume.
  const PolygonMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  const Verification v = verified_mesh(mesh, make_scene(points_of(mesh)));
  expect_flags(v, "11111", "flat");
  EXPECT_LE(v.model_outside, 1e-12);
  const PolygonMesh single = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  expect_flags(verified_mesh(single, make_scene(points_of(single))), "01001", "one triangle");
  const PolygonMesh segment = {{{0, 0, 0}, {1, 2, 3}}, {}};
  expect_flags(verified_mesh(segment, make_scene(points_of(segment))), "11111", "segment");
  const Verification half = verified_mesh({{{0, 0, 0}}, {}}, make_scene(points_of(segment)));
  EXPECT_GT(half.model_outside, 3.7);
}

TEST(Verify, RefusesMeshesThatAreNone) {
  const Scene scene = make_scene(box(1, 2, 3));
  EXPECT_THROW(verified_mesh({}, scene), InvalidInput);
  EXPECT_THROW(verified_mesh({{{0, 0, 0}}, {{0, 1, 2}}}, scene), InvalidInput);
  EXPECT_THROW(verified_mesh({{{0, 0, 0}}, {{0, 0, -1}}}, scene), InvalidInput);
  EXPECT_THROW(verified_mesh({{{0, 0, 0}, {1, 0, 0}}, {{0, 1}}}, scene), InvalidInput);
}

TEST(Verify, CanBeCancelled) {
  const Scene scene = make_scene(box(1, 2, 3));
  std::stop_source stop;
  stop.request_stop();
  VerifyOptions options;
  options.progress.stop = stop.get_token();
  EXPECT_THROW(verify(box_mesh(), scene, options), Cancelled);
}

}  // namespace
}  // namespace taut
