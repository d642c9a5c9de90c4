// Exact boundaries against support queries in many directions: the teapot, scenes of posed teapots,
// blobs, scenes of random spheres.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "boundary_checks.h"
#include "free_end_checks.h"
#include "hull_checks.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/precise_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

Hull hull_on_one_thread(const Scene& scene, HullOptions options = {}) {
  options.threads = 1;
  Hull hull;
  hull.kind = HullKind::solid;
  hull.boundary =
      std::make_shared<const HullBoundary>(exact_boundary(scene, options, hull.statistics));
  return hull;
}

/// Complete, and sound in so many directions and as many points of patches. Lengths are in the
/// scene's frame, whose size is about the diagonal's.
void expect_exact(const Scene& scene, int directions, const std::string& name) {
  SCOPED_TRACE(name);
  const Hull hull = hull_on_one_thread(scene);
  for (const Unresolved& spot : hull.boundary->unresolved) ADD_FAILURE() << spot.reason;
  const BoundaryFacts facts = boundary_facts(scene, hull, directions);
  EXPECT_TRUE(facts.sound()) << facts;
  EXPECT_LT(facts.undecided, 0.01 * facts.points + 10);
}

void expect_accurate(const Scene& scene, const std::string& name) {
  SCOPED_TRACE(name);
  const Hull hull = hull_on_one_thread(scene);
  EXPECT_LE(measure(scene, ContactGeometry(scene), *hull.boundary).accuracy, 1e-9);
}

constexpr int directions = 20'000;

TEST(PreciseSweep, Teapot) { expect_exact(make_scene(teapot()), directions, "teapot"); }

class PosedTeapots : public testing::TestWithParam<unsigned> {};

TEST_P(PosedTeapots, AreExact) {
  const unsigned seed = GetParam();
  Model one = posed_teapots(seed, 1);
  expect_exact(Scene(std::move(one), {.threads = 1, .progress = {}}), directions, "one");
}

INSTANTIATE_TEST_SUITE_P(Seeds, PosedTeapots, testing::Range(1U, 17U));

class SeveralTeapots : public testing::TestWithParam<unsigned> {};

TEST_P(SeveralTeapots, AreExact) {
  const unsigned seed = GetParam();
  Model several = posed_teapots(seed, int(seed));
  expect_exact(Scene(std::move(several), {.threads = 1, .progress = {}}), directions / 10,
               "several");
}

INSTANTIATE_TEST_SUITE_P(Counts, SeveralTeapots, testing::Values(2U, 3U, 5U, 16U));

class Blobs : public testing::TestWithParam<unsigned> {};

TEST_P(Blobs, AreExact) {
  const Scene scene = make_scene(blob(GetParam()));
  expect_exact(scene, directions, "blob");
  expect_accurate(scene, "blob");
}

INSTANTIATE_TEST_SUITE_P(Seeds, Blobs, testing::Range(1U, 22U));

/// One or two curves end in a pole, about which their contacts are near to each other all along.
INSTANTIATE_TEST_SUITE_P(EndsInPoles, Blobs, testing::Values(27U, 47U, 115U, 265U, 355U, 653U));

/// Contacts approach each other slowly across a join, as two ends on it are near to each other; or
/// pass by a pole.
INSTANTIATE_TEST_SUITE_P(SlowEnds, Blobs, testing::Values(394U, 614U));

/// Rulings across a join are so short, over long ways, that what is between two of them must be
/// told apart from other solutions.
INSTANTIATE_TEST_SUITE_P(ShortRulings, Blobs, testing::Values(37U, 38U, 108U, 161U, 288U, 350U));

/// Valleys so shallow across a join that they are none at the resolution: what is told is true.
TEST(PreciseSweep, ShallowValleys) {
  for (const unsigned seed : {427U, 510U, 641U}) {
    expect_exact(make_scene(blob(seed)), directions, std::to_string(seed));
  }
}

/// At a finer resolution a curve runs in each of them, to both of its free ends.
TEST(PreciseSweep, FreeEndsOfShallowValleys) {
  for (const unsigned seed : {427U, 510U}) {
    const Scene scene = make_scene(blob(seed));
    const ContactGeometry geometry(scene);
    HullOptions options;
    const auto ends = [&] { return free_ends_of(*hull_on_one_thread(scene, options).boundary); };
    const std::size_t coarse = ends().size();
    options.resolution = 1e-10;
    const std::vector<Ruling> fine = ends();
    EXPECT_EQ(fine.size(), coarse + 2) << seed;
    for (const Ruling& end : fine) EXPECT_TRUE(ends_in_free_end(geometry, end)) << seed;
  }
}

/// Of so many scenes at least 99% are exact. Those that are not say so: of all of them the
/// certificate is true.
class ManyScenes {
 public:
  void add(const Scene& scene, const std::string& name) {
    SCOPED_TRACE(name);
    Hull hull;
    std::string failure;
    try {
      hull = precise_hull(scene, {.relative = 1e-3, .threads = 1, .progress = {}});
    } catch (const HullNotConverged& best) {
      hull = *best.best;
      failure = best.what();
    }
    const GapRange range = gaps(scene, polygons(hull.mesh), 100);
    EXPECT_LE(hull.distance_bound, 1e-3 * scene.diagonal());
    EXPECT_LE(range.highest, hull.distance_bound);
    EXPECT_GE(range.lowest, -hull.distance_bound);
    ++count_;
    if (failure.empty()) {
      const BoundaryFacts facts = boundary_facts(scene, hull, 100);
      EXPECT_TRUE(facts.sound()) << facts;
    } else {
      unresolved_ += name + ": " + failure + "\n";
      ++failed_;
    }
  }
  void expect_most_exact() const { EXPECT_LE(100 * failed_, count_) << unresolved_; }

 private:
  int count_ = 0;
  int failed_ = 0;
  std::string unresolved_;
};

TEST(PreciseSweep, TwoHundredBlobs) {
  ManyScenes scenes;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    scenes.add(make_scene(blob(seed)), "blob " + std::to_string(seed));
  }
  scenes.expect_most_exact();
}

TEST(PreciseSweep, HundredPosedTeapots) {
  ManyScenes scenes;
  for (unsigned seed = 1001; seed <= 1100; ++seed) {
    Model one = posed_teapots(seed, 1);
    const Scene scene(std::move(one), {.threads = 1, .progress = {}});
    scenes.add(scene, "teapot " + std::to_string(seed));
  }
  scenes.expect_most_exact();
}

/// Facets have their corners in poles, or curves pass close by: three and eight equal spheres on a
/// triangle and a cube.
TEST(PreciseSweep, TurnedEqualSpheres) {
  for (unsigned seed = 1; seed <= 32; ++seed) {
    Random random(seed);
    Shape shape;
    for (int k = 0; k < (seed % 2 == 0 ? 8 : 3); ++k) {
      const dvec3 corner(k & 1, (k >> 1) & 1, (k >> 2) & 1);
      shape = shape + shifted(sphere(0.25), corner);
    }
    expect_exact(make_scene(mapped(shape, random_rotation(random))), 100, std::to_string(seed));
  }
}

/// Two to eight spheres of any size and place.
TEST(PreciseSweep, RandomSpheres) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Shape shape;
    for (int k = pick(random, 2, 8); k > 0; --k) {
      const Shape ball = mapped(sphere(log_uniform(random, 0.1, 1)), random_rotation(random));
      shape = shape + shifted(ball, 2.0 * random_point(random));
    }
    expect_exact(make_scene(shape), 500, std::to_string(seed));
  }
}

}  // namespace
}  // namespace taut
