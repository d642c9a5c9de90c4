#include "taut/surface/near_copies.h"

#include <gtest/gtest.h>

#include "models.h"
#include "taut/surface/resolution.h"

namespace taut_test {
namespace {

using namespace taut;

TEST(NearCopies, AreAsFarApartAsTheyAreMoved) {
  const Shape one = filleted_box(4, 3, 2, 0.5);
  const dvec3 way(1e-7, -2e-7, 2e-7);
  const Model model = make_model(one + shifted(one, way));
  EXPECT_NEAR(copies_apart(model, 4e-7), 3e-7, 1e-14);
  EXPECT_EQ(copies_apart(model, 2e-7), 0);
  EXPECT_EQ(copies_apart(make_model(one), 1), 0);
}

/// The lids of a cylinder are no copies of each other, nor of others with other weights.
TEST(NearCopies, HaveTheSameWeights) {
  const Shape patch = of_patch({1, 1, {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}}});
  Shape heavier = patch;
  for (dvec4& p : heavier.surfaces.front().points) p *= 3.0;
  EXPECT_NEAR(copies_apart(make_model(patch + shifted(heavier, {0, 0, 1e-3})), 1e-2), 1e-3, 1e-15);
  heavier.surfaces.front().points.back() *= 2.0;
  EXPECT_EQ(copies_apart(make_model(patch + shifted(heavier, {0, 0, 1e-3})), 1e-2), 0);
}

/// What is a little more apart than the resolution is told to be one: it is as coarse as that asks.
TEST(NearCopies, AskForAResolution) {
  const Shape ball = mapped(sphere(1), skew_rotation());
  const double rho = resolution_of(make_model(ball), 4).rho;
  for (const double apart : {1.5, 3.0, 1e3}) {
    const Model model = make_model(ball + shifted(ball, {apart * rho, 0, 0}));
    const Resolution r = resolution_of(model, 4);
    if (apart > 4) {
      EXPECT_EQ(r.worst_copy, 0);
    } else {
      EXPECT_NEAR(r.worst_copy, apart * rho, 1e-15);
      EXPECT_GE(r.rho, apart * rho);
    }
    EXPECT_STREQ(name_of(r.source), r.rho > rho ? "joins" : "floor");
    EXPECT_EQ(resolution_of(model, 4, 1e-9).rho, 4e-9);
  }
}

}  // namespace
}  // namespace taut_test
