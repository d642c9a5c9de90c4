#include "taut/envelope/cull/culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "exact_checks.h"
#include "free_end_checks.h"
#include "freeform.h"
#include "models.h"
#include "support_checks.h"
#include "surface_checks.h"
#include "taut/bounds/support_query.h"
#include "taut/core/error.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

/// Places of a culling's cells by patch, to be searched.
class CellFinder {
 public:
  explicit CellFinder(const Culling& culling) {
    for (const CulledCell& c : culling.cells) cells_[{c.instance, c.patch}].push_back(&c);
  }

  /// All cells that contain the contact, borders included.
  std::vector<const CulledCell*> at(const Contact& c) const {
    std::vector<const CulledCell*> result;
    const auto found = cells_.find({c.instance, c.element});
    if (c.kind != SourceKind::face || found == cells_.end()) return result;
    for (const CulledCell* cell : found->second) {
      const Interval u = cell->cell.u();
      const Interval v = cell->cell.v();
      if (c.u >= u.lower && c.u <= u.upper && c.v >= v.lower && c.v <= v.upper) {
        result.push_back(cell);
      }
    }
    return result;
  }

 private:
  std::map<std::pair<int, int>, std::vector<const CulledCell*>> cells_;
};

struct Verdict {
  long inside = 0;   ///< contacts inside patches
  long lost = 0;     ///< of these in cells that are off
  long on = 0;       ///< points of cells that are on
  double below = 0;  ///< how far these were below the support value at worst, in the frame
  long cells_on = 0;
  double area_on = 0;  ///< in patches
};

/// Contacts of random directions must not be in cells that are off; random points of cells that are
/// on must support their normals.
Verdict check(const Scene& scene, const Culling& culling, int directions) {
  Verdict truth;
  Random random(7);
  SupportQuery query(scene);
  const CellFinder finder(culling);
  for (int k = 0; k < directions; ++k) {
    const Contact c = query(random_direction(random)).contact;
    if (c.kind != SourceKind::face || c.u <= 0 || c.u >= 1 || c.v <= 0 || c.v >= 1) continue;
    ++truth.inside;
    for (const CulledCell* cell : finder.at(c)) truth.lost += cell->state == CellState::off;
  }
  for (const CulledCell& cell : culling.cells) {
    if (cell.state != CellState::on) continue;
    ++truth.cells_on;
    truth.area_on += std::exp2(-2.0 * cell.cell.level);
    const Instance& instance = scene.model().instances()[std::size_t(cell.instance)];
    const Part& part = scene.model().parts()[std::size_t(instance.part)];
    const BezierPatch& patch = part.patches()[std::size_t(cell.patch)].bezier;
    const glm::mat<3, 3, real> turn(instance.pose.rotation);
    for (int k = 0; k < 3; ++k) {
      const double u = cell.cell.u().at(uniform(random, 0, 1));
      const double v = cell.cell.v().at(uniform(random, 0, 1));
      const ReferenceJet j = reference_jet(patch, u, v);
      const real sign = cell.signs.plus ? 1 : -1;
      const dvec3 n = unit(dvec3(turn * (sign * j.normal() / glm::length(j.normal()))));
      const rvec3 x = turn * j.S + rvec3(instance.pose.translation) - rvec3(scene.frame().center);
      const Support s = query(n);
      ++truth.on;
      const double height = double(glm::dot(x, rvec3(n))) * scene.frame().scale;
      truth.below = std::max(truth.below, s.h - height);
    }
  }
  return truth;
}

void expect_true(const Verdict& truth, const std::string& name) {
  EXPECT_EQ(truth.lost, 0) << name;
  EXPECT_LE(truth.below, 1e-13) << name;
}

/// The cells cover every patch of every instance once, and the counts are those of the cells.
void expect_consistent(const Scene& scene, const Culling& culling, const std::string& name) {
  std::map<std::pair<int, int>, double> area;
  std::map<CellState, long> states;
  double removed = 0;
  for (const CulledCell& c : culling.cells) {
    const double share = std::exp2(-2.0 * c.cell.level);
    area[{c.instance, c.patch}] += share;
    ++states[c.state];
    if (c.state == CellState::off) removed += share;
    EXPECT_EQ(c.signs.any(), c.state == CellState::mixed || c.state == CellState::on) << name;
    EXPECT_TRUE(c.state != CellState::on || c.signs.plus != c.signs.minus) << name;
  }
  EXPECT_EQ(area.size(), std::size_t(scene.model().patch_count())) << name;
  for (const auto& [patch, share] : area) EXPECT_EQ(share, 1) << name;
  EXPECT_NEAR(culling.removed_share(), removed / std::max(scene.model().patch_count(), 1), 1e-12);
  long off = 0;
  long on = 0;
  long ruled = 0;
  long before = 0;
  for (std::size_t l = 0; l < culling.levels.size(); ++l) {
    const CullingLevel& level = culling.levels[l];
    off += level.off_by_samples + level.off_by_curvature;
    on += level.on;
    ruled += level.ruled;
    EXPECT_EQ(level.visited, l == 0 ? scene.model().patch_count() : 4 * before) << name;
    EXPECT_EQ(level.visited,
              level.off_by_samples + level.off_by_curvature + level.on + level.ruled + level.kept);
    EXPECT_GE(level.decided_share, level.removed_share);
    before = level.kept;
  }
  EXPECT_EQ(states[CellState::off], off) << name;
  EXPECT_EQ(states[CellState::on], on) << name;
  EXPECT_EQ(states[CellState::ruled], ruled) << name;
  EXPECT_EQ(states[CellState::mixed], culling.mixed()) << name;
}

void expect_same(const Culling& a, const Culling& b) {
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    ASSERT_EQ(a.samples[k].n, b.samples[k].n);
    ASSERT_EQ(a.frame_points[k], b.frame_points[k]);
    ASSERT_EQ(a.samples[k].contact.element, b.samples[k].contact.element);
    ASSERT_EQ(a.samples[k].contact.u, b.samples[k].contact.u);
  }
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (std::size_t k = 0; k < a.cells.size(); ++k) {
    ASSERT_EQ(a.cells[k].patch, b.cells[k].patch);
    ASSERT_EQ(a.cells[k].state, b.cells[k].state);
    ASSERT_EQ(a.cells[k].cell.level, b.cells[k].cell.level);
    ASSERT_EQ(a.cells[k].cell.i, b.cells[k].cell.i);
    ASSERT_EQ(a.cells[k].cell.j, b.cells[k].cell.j);
  }
}

Culling culled(const Scene& scene, int levels, int threads = 1) {
  const GaussMap map(scene, {.threads = threads, .progress = {}});
  return cull(scene, map, {.levels = levels, .threads = threads, .progress = {}});
}

TEST(Cull, RemovesMostOfTheTeapotAndNothingOfItsHull) {
  const Scene scene = make_scene(teapot());
  const Culling culling = culled(scene, 5);
  EXPECT_GE(culling.removed_share(), 0.70);
  EXPECT_GE(culling.levels.back().decided_share, 0.90);
  expect_consistent(scene, culling, "teapot");
  const Verdict truth = check(scene, culling, 20000);
  expect_true(truth, "teapot");
  EXPECT_GE(truth.inside, 10000);
  EXPECT_GE(truth.cells_on, 1000);
}

TEST(Cull, KeepsTheContactsOfAllShapes) {
  struct Case {
    std::string name;
    Shape shape;
    bool removes, proves;
  };
  const std::vector<Case> cases = {
      {"sphere", sphere(), false, true},
      {"two spheres", two_spheres(1, 0.5, 3), true, true},
      {"ellipsoid", ellipsoid(3, 2, 1), false, true},
      {"torus", torus(2, 0.5), true, true},
      {"dented", dented(), true, true},
      {"dented ellipsoid", dented_ellipsoid(), true, true},
      {"sphere at the corner of a box", sphere() + box(4, 4, 4), true, true},
      {"sphere well inside", shifted(sphere(), {2, 2, 2}) + box(4, 4, 4), true, false},
      {"saddle", saddle(), true, false},
      {"paraboloid", paraboloid(), false, true},
      {"filleted box", filleted_box(3, 2, 1, 0.25), false, true},
      {"sphere and a point", sphere() + Shape{{}, {}, {{0, 0, 5}}}, true, true},
      {"sphere and a circle", sphere() + Shape{{}, {circle({0, 0, 2}, {1, 0, 0}, {0, 1, 0})}, {}},
       true, true}};
  for (const Case& c : cases) {
    const Scene scene = make_scene(c.shape);
    const Culling culling = culled(scene, 4);
    expect_consistent(scene, culling, c.name);
    const Verdict truth = check(scene, culling, 2000);
    expect_true(truth, c.name);
    EXPECT_EQ(culling.removed_share() > 0.05, c.removes) << c.name << culling.removed_share();
    EXPECT_EQ(truth.area_on > 0.1, c.proves) << c.name << truth.area_on;
  }
}

/// In random places; of degrees up to 4, about half of them rational.
Shape random_patches(Random& random, int count, int least_degree) {
  Shape shape;
  for (int i = 0; i < count; ++i) {
    const double weights = pick(random, 0, 1) == 0 ? 1 : log_uniform(random, 1.01, 10);
    const dvec3 place = random_point(random);
    const int q = pick(random, least_degree, 4);
    const int p = pick(random, least_degree, 4);
    shape = shape + shifted(of_patch(random_patch(random, p, q, weights)), place);
  }
  return shape;
}

TEST(Cull, KeepsTheContactsOfRandomPatches) {
  Random random(8);
  long removed = 0;
  long on = 0;
  for (int k = 0; k < 60; ++k) {
    const Scene scene = make_scene(random_patches(random, 3, 1));
    const Culling culling = culled(scene, 4);
    expect_consistent(scene, culling, std::to_string(k));
    const Verdict truth = check(scene, culling, 500);
    expect_true(truth, std::to_string(k));
    // Ruled patches are left out of the search, on the hull or not.
    removed += culling.removed_share() + double(culling.levels.front().ruled) / 3 > 0.5;
    on += truth.cells_on;
  }
  EXPECT_GE(removed, 40);
  EXPECT_GE(on, 10);
}

TEST(Cull, LevelsFollowTheNumberOfPatches) {
  EXPECT_EQ(culling_levels(0), 3);
  EXPECT_EQ(culling_levels(256), 3);
  EXPECT_EQ(culling_levels(257), 2);
  EXPECT_EQ(culling_levels(4096), 1);
  EXPECT_EQ(culling_levels(100000), 0);
}

/// Two humps in one patch: what lies between them is bridged, and neither is alone on the hull.
TEST(Cull, PatchesCullThemselves) {
  BezierPatch patch{6, 2, {}};
  const std::array<double, 7> along_u = {0, 3, -3, -3, -3, 2.5, 0};
  const std::array<double, 3> along_v = {-1, 1, -1};
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      patch.points.push_back(
          homogeneous({double(i) - 3, 2 * (double(j) - 1), along_u[i] + along_v[j]}));
    }
  }
  const Scene scene = make_scene(of_patch(patch));
  const Culling culling = culled(scene, 5);
  expect_consistent(scene, culling, "humps");
  const Verdict truth = check(scene, culling, 5000);
  expect_true(truth, "humps");
  EXPECT_GE(truth.inside, 500);
  EXPECT_GE(truth.area_on, 0.02);
  EXPECT_GE(culling.removed_share(), 0.5);
}

TEST(Cull, InstancesCullEachOther) {
  Model model = make_model(ellipsoid(3, 2, 1));
  model.add_instance(0, {skew_rotation(), {5, 1, 0}});
  model.add_instance(0, {skew_rotation() * skew_rotation(), {2.5, 0.5, 0}});  // between
  const Scene scene(model);
  const Culling culling = culled(scene, 5);
  expect_consistent(scene, culling, "instances");
  const Verdict truth = check(scene, culling, 5000);
  expect_true(truth, "instances");
  EXPECT_GE(truth.cells_on, 500);
  EXPECT_GE(culling.removed_share(), 0.4);
}

/// Enough patches that the spread samples are dense and stand for queries.
TEST(Cull, ManyInstances) {
  Random random(10);
  Model model = make_model(teapot());
  model.clear_instances();
  for (int k = 0; k < 120; ++k) {
    model.add_instance(0, {random_rotation(random), 12.0 * random_point(random)});
  }
  const Scene scene(model);
  const Culling culling = culled(scene, 4);
  expect_consistent(scene, culling, "many");
  const Verdict truth = check(scene, culling, 10000);
  expect_true(truth, "many");
  EXPECT_GE(truth.inside, 3000);
  EXPECT_GE(culling.removed_share(), 0.98);
  EXPECT_LE(culling.support_queries, culling.visited() / 4);
  expect_same(culling, culled(scene, 4, 3));
}

TEST(Cull, TellsSamplesOfAllKinds) {
  const Shape shape = sphere() + Shape{{}, {circle({0, 0, 2}, {1, 0, 0}, {0, 1, 0})}, {{0, 5, 0}}};
  const Scene scene = make_scene(shape);
  const Culling culling = culled(scene, 2);
  ASSERT_EQ(culling.samples.size(), culling.frame_points.size());
  // Each query gives a sample, but for those that confirm the middle of a cell: one a cell that is
  // neither of the finest nor off.
  long confirmed = 0;
  for (std::size_t l = 0; l + 1 < culling.levels.size(); ++l) {
    confirmed += culling.levels[l].on + culling.levels[l].kept;
  }
  EXPECT_LE(culling.support_queries, long(culling.samples.size()) + confirmed);
  EXPECT_GE(culling.support_queries, 24);
  std::map<SourceKind, int> kinds;
  const ReferenceSupport truth(scene.model(), scene.frame().center);
  for (std::size_t k = 0; k < culling.samples.size(); ++k) {
    const Sample& s = culling.samples[k];
    ++kinds[s.contact.kind];
    EXPECT_NEAR(glm::length(s.n), 1, 1e-15);
    if (k % 10 != 0) continue;
    const double h = glm::dot(culling.frame_points[k], s.n) / scene.frame().scale;
    EXPECT_NEAR(h, double(truth(s.n).lower), 1e-11);
  }
  EXPECT_EQ(kinds.size(), 3u);
  const Scene curves = make_scene(oloid());
  const Culling sampled = culled(curves, 3);
  EXPECT_TRUE(sampled.cells.empty());
  EXPECT_GE(sampled.samples.size(), 24u);
  EXPECT_EQ(sampled.removed_share(), 0);
}

TEST(Cull, ThreadsDoNotMatter) {
  const Scene scene = make_scene(teapot());
  expect_same(culled(scene, 4, 1), culled(scene, 4, 3));
}

TEST(Cull, ScalesAndTurnsHardlyMatter) {
  const Culling culling = culled(make_scene(teapot()), 4);
  for (const Shape& shape : {scaled(teapot(), 1e-6), scaled(teapot(), 1e6),
                             mapped(teapot(), skew_rotation(), {100, 0, 0})}) {
    const Culling other = culled(make_scene(shape), 4);
    EXPECT_NEAR(other.removed_share(), culling.removed_share(), 0.003);
    EXPECT_NEAR(other.levels.back().decided_share, culling.levels.back().decided_share, 0.01);
  }
}

TEST(Cull, LevelsBelowTheMapAreThoseOfADeeperMap) {
  const Scene scene = make_scene(dented_ellipsoid());
  const GaussMap coarse(scene, {.levels = 1, .threads = 1, .progress = {}});
  const GaussMap fine(scene, {.levels = 4, .threads = 1, .progress = {}});
  const CullingOptions options = {.levels = 4, .threads = 1, .progress = {}};
  const Culling a = cull(scene, coarse, options);
  const Culling b = cull(scene, fine, options);
  EXPECT_NEAR(a.removed_share(), b.removed_share(), 0.005);
  EXPECT_NEAR(a.levels.back().decided_share, b.levels.back().decided_share, 0.01);
}

TEST(Cull, DegeneratePatches) {
  const BezierPatch point{1, 2, std::vector<dvec4>(6, homogeneous({1, 2, 3}))};
  BezierPatch line{2, 2, {}};
  for (int k = 0; k < 9; ++k) line.points.push_back(homogeneous(dvec3(k * k, 0, 0)));
  for (const Shape& shape :
       {of_patch(point), of_patch(line), of_patch(point) + sphere(), cylinder(1, 2), cone(1, 2),
        box(1, 2, 3), disc(1, 0), bilinear_saddle()}) {
    const Scene scene = make_scene(shape);
    const Culling culling = culled(scene, 3);
    expect_consistent(scene, culling, "degenerate");
    expect_true(check(scene, culling, 200), "degenerate");
  }
}

TEST(Cull, RefusesLevelsAndStops) {
  const Scene scene = make_scene(sphere());
  const GaussMap map(scene);
  EXPECT_THROW(cull(scene, map, {.levels = -1, .threads = 1, .progress = {}}), InvalidInput);
  EXPECT_THROW(cull(scene, map, {.levels = 21, .threads = 1, .progress = {}}), InvalidInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
      cull(scene, map, {.levels = 1, .threads = 1, .progress = {{}, {}, stop.get_token()}}),
      Cancelled);
}

/// Contacts merge where the curvature changes sign.
TEST(Culling, FreeEndsAreInNoCellThatIsCurvedOneWay) {
  long definite = 0;
  std::size_t ends = 0;
  for (const int lobes : {2, 3}) {
    Dent dent;
    dent.lobes = lobes;
    const Scene scene = make_scene(dented_body({dent}));
    const Culling culling = culled(scene, 1);
    const CellFinder cells(culling);
    for (const Ruling& end : free_ends_of(*boundary_of(scene).boundary)) {
      ++ends;
      for (const Contact& contact : end.contact) {
        for (const CulledCell* cell : cells.at(contact)) EXPECT_FALSE(cell->definite);
      }
    }
    definite += std::count_if(culling.cells.begin(), culling.cells.end(), [](const CulledCell& c) {
      return c.state == CellState::mixed && c.definite;
    });
  }
  EXPECT_GE(ends, 4U);
  EXPECT_GT(definite, 0);
}

}  // namespace
}  // namespace taut
