#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cages.h"
#include "limit_support.h"
#include "support_checks.h"
#include "taut/bounds/model_support.h"
#include "taut/hull/convex_hull.h"

// Support values of control cages from elsewhere against those of the limit surface by uniform
// refinement (LimitSupport): no patches, end caps or Newton steps are in both.

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: cages and reference answers

// As shares of the diagonal:
/// What is asked of support values.
constexpr double required = 1e-9;
/// Of support queries (support_accuracy) and limit masks.
constexpr double rounding = 2e-12;

/// Limit normals of extraordinary vertices that are extreme, or nearly so, and what is 1e-1 to 1e-7
/// off them.
std::vector<dvec3> normals_of_extraordinary_vertices(const ControlCage& cage,
                                                     const LimitSupport& truth, double diagonal,
                                                     std::size_t most, Random& random) {
  // A level on, all faces of Catmull-Clark cages are quads.
  const RefinedCage refined(cage, 1);
  const std::vector<LimitPoint> limits = refined.limits();
  const auto topology = refined.level();
  const int regular = cage.scheme == CageScheme::loop ? 6 : 4;
  std::vector<dvec3> all;
  for (int v = 0; v < topology.GetNumVertices(); ++v) {
    const LimitPoint& p = limits[std::size_t(v)];
    if (topology.IsVertexBoundary(v) || topology.GetVertexEdges(v).size() == regular) continue;
    for (const dvec3& n : {p.normal, -p.normal}) {
      if (n == dvec3(0.0)) continue;
      double most_high = glm::dot(p.x, n);
      for (const LimitPoint& q : truth.limits()) most_high = std::max(most_high, glm::dot(q.x, n));
      if (most_high - glm::dot(p.x, n) <= 1e-4 * diagonal) all.push_back(n);
    }
  }
  std::shuffle(all.begin(), all.end(), random);
  all.resize(std::min(all.size(), most));
  const std::size_t exact = all.size();
  for (std::size_t i = 0; i < exact; ++i) {
    const double off = std::pow(10.0, -1.0 - double(i % 7));
    all.push_back(unit(all[i] + off * random_direction(random)));
  }
  return all;
}

/// Normals of patches that stand for something else where supporting planes touch them: there
/// support values are wrong by as much as the model says at most.
std::vector<dvec3> normals_of_stand_ins(const Scene& scene, std::size_t most, Random& random) {
  const std::vector<Patch>& patches = scene.model().parts().at(0).patches();
  std::vector<const Patch*> stand_ins;
  for (const Patch& patch : patches) {
    if (patch.stand_in) stand_ins.push_back(&patch);
  }
  std::shuffle(stand_ins.begin(), stand_ins.end(), random);
  SupportQuery query(scene);
  std::vector<dvec3> result;
  for (const Patch* const patch : stand_ins) {
    const dvec3 n = unit_normal(patch->bezier, uniform(random, 0, 1), uniform(random, 0, 1));
    for (const dvec3& outward : {n, -n}) {
      if (result.size() == most || n == dvec3(0.0)) break;
      const Contact contact = query(outward).contact;
      if (contact.kind == SourceKind::face && patches[std::size_t(contact.element)].stand_in) {
        result.push_back(outward);
      }
    }
  }
  return result;
}

/// How much is asked.
struct Effort {
  double known = 1e-12;       ///< how well truths are to be known
  double undecided = 0.1;     ///< share of the directions in which they may be known less
  std::size_t special = 100;  ///< most directions of each special kind
  int random = 200;           ///< random directions
};

/// Special ones, those of the places where patches are not exact, and random others.
std::vector<dvec3> directions_for(const Scene& scene, const LimitSupport& truth,
                                  const Effort& effort) {
  Random random(17);
  std::vector<dvec3> all = special_directions(random);
  all.resize(std::min(all.size(), effort.special));
  const auto append = [&](const std::vector<dvec3>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(normals_of_extraordinary_vertices(cage_of(scene.model()), truth, scene.diagonal(),
                                           effort.special / 3, random));
  append(normals_of_stand_ins(scene, effort.special / 2, random));
  append(random_directions(random, effort.random));
  return all;
}

std::string text_of(const dvec3& n) {
  std::ostringstream out;
  out << std::setprecision(17) << "n = " << n.x << ", " << n.y << ", " << n.z;
  return out.str();
}

/// Within what the model promises, and `allowed` of the diagonal.
void expect_support_values(const Model& model, const std::string& name, int levels, double allowed,
                           const Effort& effort) {
  const Scene scene(model);
  const double unit = 1 / scene.diagonal();
  const double promised = model.deviation_bound() * unit + rounding;
  const LimitSupport truth(cage_of(model), levels);
  SupportQuery query(scene);
  int undecided = 0;
  double most = 0;
  const std::vector<dvec3> directions = directions_for(scene, truth, effort);
  for (const dvec3& n : directions) {
    const SupportRange range = truth(n, effort.known * scene.diagonal());
    const double unknown = double(range.upper - range.lower) * unit;
    ASSERT_GE(unknown, 0) << name;
    if (unknown > effort.known) ++undecided;
    const ModelSupport s = support(query, scene, n);
    const double error = double(std::max(range.lower - s.h, s.h - range.upper)) * unit;
    most = std::max(most, error);
    EXPECT_LE(error, std::min(allowed, promised)) << name << " " << text_of(n);
    EXPECT_LE(double(range.lower - s.h_bound) * unit, promised) << name << " " << text_of(n);
  }
  EXPECT_LE(undecided, effort.undecided * double(directions.size())) << name;
  testing::Test::RecordProperty("largest error of " + name, std::to_string(1e12 * most) + "e-12");
}

void expect_support_values(const char* file, Scheme scheme, int levels) {
  const std::optional<Model> model = model_from_elsewhere(file, scheme, default_cage_accuracy);
  if (!model) GTEST_SKIP() << file << " is not there";
  expect_support_values(*model, file, levels, required, {});
}

/// Planes that the hull's boundary records: of rulings and of facets, with the points on them.
struct Plane {
  dvec3 n;
  std::vector<dvec3> points;
};

std::vector<Plane> planes_of(const HullBoundary& boundary, std::size_t most) {
  std::vector<Plane> all;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& r : piece.rulings) all.push_back({r.n, {r.point[0], r.point[1]}});
    }
  }
  const std::size_t step = std::max<std::size_t>(1, all.size() / most);
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < all.size(); i += step) planes.push_back(all[i]);
  for (const HullFace& face : boundary.faces) {
    if (face.kind == FaceKind::facet) planes.push_back({face.n, face.points});
  }
  for (Plane& plane : planes) {
    for (dvec3& p : plane.points) p = boundary.frame.to_model(p);
  }
  return planes;
}

/// Corners of the mesh, and points of the boundary's curves.
std::vector<dvec3> points_of(const Hull& hull) {
  std::vector<dvec3> points;
  for (const auto v : hull.mesh.vertices()) points.push_back(position(hull.mesh, v));
  for (const HullCurve& curve : hull.boundary->curves) {
    for (const dvec3& p : curve.points) points.push_back(hull.boundary->frame.to_model(p));
  }
  return points;
}

/// The recorded planes support the limit surface, in the points recorded; no point of the hull is
/// beyond any other supporting plane, nor is all of it farther below than the mesh says.
void expect_supporting_hull(const char* file, Scheme scheme, int levels, double accuracy) {
  const std::optional<Model> model = model_from_elsewhere(file, scheme, accuracy);
  if (!model) GTEST_SKIP() << file << " is not there";
  EXPECT_LE(model->deviation_bound(), accuracy * size_of(cage_of(*model)));
  const Hull hull = convex_hull(*model, {.relative = 1e-2, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  ASSERT_TRUE(hull.boundary->unresolved.empty());
  const LimitSupport truth(cage_of(*model), levels);
  const double diagonal = taut::diagonal(model->control_box());
  const double off =
      std::max(required * diagonal, std::min(model->deviation_bound(), accuracy * diagonal));
  for (const Plane& plane : planes_of(*hull.boundary, 200)) {
    const SupportRange range = truth(plane.n, Effort().known * diagonal);
    for (const dvec3& p : plane.points) {
      EXPECT_LE(glm::dot(p, plane.n), range.upper + off) << text_of(plane.n);
      EXPECT_GE(glm::dot(p, plane.n), range.lower - off) << text_of(plane.n);
    }
  }
  const std::vector<dvec3> points = points_of(hull);
  Random random(23);
  for (const dvec3& n : random_directions(random, 60)) {
    const SupportRange range = truth(n, Effort().known * diagonal);
    double h = glm::dot(points.front(), n);
    for (const dvec3& p : points) h = std::max(h, glm::dot(p, n));
    EXPECT_LE(h, range.upper + off) << text_of(n);
    EXPECT_GE(h, range.lower - off - hull.distance_bound) << text_of(n);
  }
}

/// A face cut out of its level and refined is what it is in the whole cage.
TEST(RefinedCage, IsTheSameLocally) {
  for (const auto& [name, cage] : all_cages()) {
    if (cage.points.size() > 60) continue;
    const RefinedCage coarse(cage, 2);
    const RefinedCage fine(cage, 3);
    const std::vector<LimitPoint> limits = fine.limits();
    for (std::size_t i = 0; i < coarse.faces().size(); i += 5) {
      const int face = coarse.faces()[i];
      const RefinedCage local = coarse.refined({face});
      const std::vector<LimitPoint> local_limits = local.limits();
      ASSERT_EQ(local.faces().size(), 4U) << name;
      for (int child = 0; child < 4; ++child) {
        const auto here = local.level().GetFaceVertices(local.faces()[std::size_t(child)]);
        const auto there = fine.level().GetFaceVertices(4 * face + child);
        ASSERT_EQ(here.size(), there.size()) << name;
        for (int k = 0; k < here.size(); ++k) {
          EXPECT_EQ(local.has_limit(here[k]), fine.has_limit(there[k])) << name;
          const double off =
              glm::distance(local_limits[std::size_t(here[k])].x, limits[std::size_t(there[k])].x);
          EXPECT_LE(off, 1e-14 * size_of(cage)) << name;
        }
      }
    }
  }
}

TEST(LimitSupport, OfCubes) {
  // About an extraordinary vertex of valence n, 4 sum(edge) + sum(face) + n^2 v over n (n + 5).
  const LimitSupport smooth(cube_cage(), 3);
  const SupportRange corner = smooth(unit(dvec3(1, -1, 1)), 1e-13);
  EXPECT_NEAR(double(corner.lower), std::sqrt(0.75), 1e-14);
  EXPECT_NEAR(double(corner.upper), std::sqrt(0.75), 2e-13);
  ControlCage box = cube_cage();
  for (const auto& f : box.faces) {
    for (std::size_t k = 0; k < 4; ++k) {
      box.creases.push_back({{f[k], f[(k + 1) % 4]}, infinite_sharpness});
    }
  }
  const LimitSupport sharp(box, 3);
  Random random(3);
  for (const dvec3& n : random_directions(random, 20)) {
    const double h = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const SupportRange range = sharp(n, 1e-13);
    EXPECT_NEAR(double(range.lower), h, 1e-14);
    EXPECT_NEAR(double(range.upper), h, 2e-13);
  }
}

TEST(CageSupport, OfCagesInCode) {
  // The top of a torus is a crest; at the end of a surface that goes on in a hole what is around a
  // face is higher than it by as much as its size.
  constexpr Effort effort = {.known = 1e-10, .undecided = 0.6, .special = 20, .random = 10};
  for (const auto& [name, cage] : all_cages()) {
    if (cage.points.size() > 32) continue;
    expect_support_values(cage_model(cage, 1e-5), name, 3, 1e-5, effort);
  }
}

/// As LimitPatches.KeepTheirAccuracyAtSharpTips.
TEST(CageSupport, OfSharpTips) {
  for (const int k : {1, 3}) {
    expect_support_values(cage_model(semi_sharp_rim_cage(k)), std::to_string(k), 5, 1e-9, {});
  }
}

TEST(CageSupport, OfACarWithCreases) {
  expect_support_values("A15_osd_car_creases_boundary.obj", Scheme::catmark, 3);
}
TEST(CageSupport, OfSheetsWithCornersAndBoundary) {
  expect_support_values("A16_osd_edgecorner_boundary.obj", Scheme::catmark, 5);
}
TEST(CageSupport, OfANonManifoldCage) {
  expect_support_values("A17_osd_nonmanifold_edges.obj", Scheme::catmark, 5);
}
TEST(CageSupport, OfSemiSharpIcosahedra) {
  expect_support_values("A18_osd_loop_icos_semisharp.obj", Scheme::loop, 5);
}
TEST(CageSupport, OfATorus) {
  expect_support_values("A19_torus_quad_smooth.off", Scheme::catmark, 5);
}
TEST(CageSupport, OfATriangulatedCube) {
  expect_support_values("A20_cube_binary.ply", Scheme::catmark, 5);
}
TEST(CageSupport, OfATriangulatedCubeByLoop) {
  expect_support_values("A20_cube_binary.ply", Scheme::loop, 5);
}

TEST(CageSupport, OfTheHullOfSheetsWithCornersAndBoundary) {
  expect_supporting_hull("A16_osd_edgecorner_boundary.obj", Scheme::catmark, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfANonManifoldCage) {
  expect_supporting_hull("A17_osd_nonmanifold_edges.obj", Scheme::catmark, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfATorus) {
  expect_supporting_hull("A19_torus_quad_smooth.off", Scheme::catmark, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfATriangulatedCube) {
  expect_supporting_hull("A20_cube_binary.ply", Scheme::catmark, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfATriangulatedCubeByLoop) {
  expect_supporting_hull("A20_cube_binary.ply", Scheme::loop, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfSemiSharpIcosahedra) {
  expect_supporting_hull("A18_osd_loop_icos_semisharp.obj", Scheme::loop, 5, 1e-9);
}
TEST(CageSupport, OfTheHullOfACarWithCreases) {
  expect_supporting_hull("A15_osd_car_creases_boundary.obj", Scheme::catmark, 3, 1e-9);
}

}  // namespace
}  // namespace taut
