// A million points next to the boundaries of hulls.

#include "containment_checks.h"
#include "taut/containment/hull_containment.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

constexpr int points_each = 200'000;

class KnownHulls : public testing::TestWithParam<std::string> {};

TEST_P(KnownHulls, NoPointNextToTheBoundaryIsWrong) {
  for (const KnownHull& hull : known_hulls()) {
    if (hull.name != GetParam()) continue;
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    Random random(1);
    EXPECT_EQ(wrong_answers(containment, known_probes(hull, scene, random, points_each)), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(ContainmentSweep, KnownHulls,
                         testing::Values("sphere", "box", "capsule", "torus"),
                         [](const auto& suite) { return suite.param; });

TEST(ContainmentSweep, NoPointNextToTheOloidIsWrong) {
  const Scene scene = make_scene(oloid());
  const HullContainment containment(scene);
  Random random(2);
  EXPECT_EQ(wrong_answers(containment, oloid_probes(scene, random, points_each)), 0);
}

TEST(ContainmentSweep, NoPointNextToTheTeapotsHullIsWrong) {
  const Scene scene = make_scene(teapot());
  const HullContainment containment(scene);
  Random random(3);
  EXPECT_EQ(wrong_answers(containment, probes_of(scene, {0, 0, 1}, 0.9, random, points_each)), 0);
}

/// Random ones of every size, mirrored by nothing: cages and dented bodies in general position.
TEST(ContainmentSweep, NoPointNextToRandomBodiesIsWrong) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double size = log_uniform(random, 1e-6, 1e6);
    const Scene scene = make_scene(scaled(mapped(blob(seed), random_rotation(random)), size));
    const HullContainment containment(scene);
    const dvec3 middle = scene.box().center();
    EXPECT_EQ(wrong_answers(containment, probes_of(scene, middle, 0.1 * size, random, 5'000)), 0);
  }
}

}  // namespace
}  // namespace taut
