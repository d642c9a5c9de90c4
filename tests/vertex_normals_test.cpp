#include "taut/hull/sample/vertex_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "models.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// What a vertex may lie below its supporting plane, as a fraction of the diagonal.
constexpr double least_share = 1e-12;

using rvec3 = glm::tvec3<long double>;
using SupportFunction = std::function<long double(const rvec3& n)>;

long double across(const rvec3& n) { return std::sqrt(n.x * n.x + n.y * n.y); }

/// A body with its support function.
struct KnownBody {
  const char* name;
  Shape shape;
  SupportFunction h;
};

std::vector<KnownBody> known_bodies() {
  const auto oloid_height = [](const rvec3& n) {
    return std::max(across(n), n.x + std::sqrt(n.x * n.x + n.z * n.z));
  };
  const auto cylinder_height = [](const rvec3& n) { return across(n) + std::max(2 * n.z, 0.0L); };
  const auto cone_height = [](const rvec3& n) { return std::max(across(n), 2 * n.z); };
  const auto torus_height = [](const rvec3& n) { return 2 * across(n) + 0.5L * glm::length(n); };
  const auto capsule_height = [](const rvec3& n) {
    return glm::length(n) + std::max(3 * n.z, 0.0L);
  };
  const auto box_height = [](const rvec3& n) {
    return std::abs(n.x) + 1.5L * std::abs(n.y) + 2 * std::abs(n.z);
  };
  return {{"oloid", oloid(), oloid_height},
          {"cylinder", solid_cylinder(1, 2), cylinder_height},
          {"cone", solid_cone(1, 2), cone_height},
          {"torus", torus(2, 0.5), torus_height},
          {"capsule", two_spheres(1, 1, 3), capsule_height},
          {"box", shifted(box(2, 3, 4), {-1, -1.5, -2}), box_height}};
}

/// Every vertex is, by its normal, as high as the support function, in long double.
void expect_supporting(const HullMesh& mesh, const SupportFunction& h, double diagonal) {
  ASSERT_GT(mesh.n_vertices(), 0U);
  for (const auto v : mesh.vertices()) {
    const auto& normal = mesh.normal(v);
    const rvec3 n(normal[0], normal[1], normal[2]);
    ASSERT_NEAR(double(glm::length(n)), 1, 1e-15);
    const rvec3 x(position(mesh, v));
    ASSERT_LE(double(h(n) - glm::dot(n, x)), least_share * diagonal) << "vertex " << v.idx();
  }
}

TEST(VertexNormals, SupportKnownBodies) {
  const dmat3 R = skew_rotation();
  const dvec3 shift(0.3, -1, 2);
  for (const KnownBody& body : known_bodies()) {
    SCOPED_TRACE(body.name);
    const Scene scene = make_scene(body.shape);
    expect_supporting(precise_hull(scene, {.threads = 1, .progress = {}}).mesh, body.h,
                      scene.diagonal());
    expect_supporting(sampled_hull(scene, {.relative = 1e-3, .threads = 1, .progress = {}}).mesh,
                      body.h, scene.diagonal());
    const Scene turned = make_scene(mapped(body.shape, R, shift));
    const SupportFunction turned_h = [&](const rvec3& n) {
      return body.h(glm::transpose(glm::tmat3x3<long double>(R)) * n) + glm::dot(n, rvec3(shift));
    };
    expect_supporting(precise_hull(turned, {.threads = 1, .progress = {}}).mesh, turned_h,
                      scene.diagonal());
  }
}

/// Rims stay rims where rounding bends them: contacts of one plane are a little above or below it.
TEST(VertexNormals, SupportBodiesRoundedToFloat) {
  for (const Shape& clean : {oloid(), solid_cone(1, 2), filleted_box(4, 3, 2, 0.5)}) {
    Shape shape = mapped(clean, skew_rotation(), {0.3, -1, 2});
    const auto round_all = [](std::vector<dvec4>& points) {
      for (dvec4& p : points) {
        const dvec3 x = euclidean(p);
        p = homogeneous(dvec3(float(x.x), float(x.y), float(x.z)), p.w);
      }
    };
    for (NurbsSurface& s : shape.surfaces) round_all(s.points);
    for (NurbsCurve& c : shape.curves) round_all(c.points);
    for (dvec3& p : shape.points) p = {float(p.x), float(p.y), float(p.z)};
    const Scene scene = make_scene(shape);
    SupportQuery query(scene);
    const SupportFunction h = [&](const rvec3& n) {
      const dvec3 direction(n);
      const SceneFrame frame = scene.frame();
      return frame.length_to_model(query(direction).h) + glm::dot(direction, frame.center);
    };
    expect_supporting(precise_hull(scene, {.threads = 1, .progress = {}}).mesh, h,
                      scene.diagonal());
  }
}

/// On a rim the direction is between those of the two faces, in the plane across it.
TEST(VertexNormals, OfARimLieAcrossIt) {
  const Scene scene = make_scene(solid_cylinder(1, 2));
  const Hull hull = precise_hull(scene, {.threads = 1, .progress = {}});
  for (const auto v : hull.mesh.vertices()) {
    const dvec3 x = position(hull.mesh, v);
    const auto& normal = hull.mesh.normal(v);
    const double out = glm::dot(dvec2(normal[0], normal[1]), dvec2(x.x, x.y));
    const double along = x.x * normal[1] - x.y * normal[0];
    ASSERT_NEAR(along, 0, 1e-12);
    ASSERT_GT(out, 0);
    ASSERT_GT(normal[2] * (x.z - 1), 0);
  }
}

}  // namespace
}  // namespace taut
