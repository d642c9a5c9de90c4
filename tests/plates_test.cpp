// Hulls of plates: known by a formula, with scrolls along circles, facets that several circles
// touch and rulings that turn fast.

#include "plates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exact_checks.h"
#include "sound_hull.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/verify/check_report.h"

namespace taut_test {
namespace {

using namespace taut;  // NOLINT: what is tested

/// Mean widths of wrong hulls are off by a thousandth and more.
constexpr double wrong_width = 1e-6;

/// What verify() says of the hull that Taut computes, whether its faces are right but for what they
/// state to be below the supporting planes, and whether its report is as accurate as it says.
struct Outcome {
  bool right_faces = false;
  bool right_report = false;
  bool exact = false;  ///< no place is below
  HullVerification found;
};

Outcome outcome(const Plate& plate, const dmat3& rotation) {
  const Sound sound = sound_hull(mapped(plate.shape(), rotation));
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  const HullBoundary boundary = *convex_hull(sound.scene, options).boundary;
  const BoundaryMeasures own = measure(sound.scene, ContactGeometry(sound.scene), boundary);
  const PlateMeasures truth = measures_of(plate);
  const double volume_error = std::abs(own.volume / truth.volume - 1);
  const double width_error = std::abs(own.mean_width / truth.mean_width - 1);
  Outcome o;
  o.right_faces = boundary.unresolved.empty() &&
                  volume_error <= 1e-11 + own.bounds.volume - own.accuracy &&
                  width_error <= wrong_width;
  o.exact = deepest_tolerant(boundary) == 0;
  o.right_report = width_error <= own.accuracy + measure_accuracy;
  o.found = verified(sound.hull, sound.scene);
  return o;
}

/// Volume and mean width of hulls that were computed elsewhere.
TEST(Plates, AreKnownByAFormula) {
  const auto expect = [](const Plate& plate, double volume, double mean_width) {
    const PlateMeasures found = measures_of(plate);
    EXPECT_NEAR(found.volume, volume, 1e-10 * volume);
    EXPECT_NEAR(found.mean_width, mean_width, 1e-11 * mean_width);
  };
  expect(plate_of_four(3, 1.5, 40.622901694889705 - 40, 30.741786989260728 - 30, 0.8),
         2844.7478590677, 40.8114874418);
  expect(plate_of_four(0.5, 0.5, 40.70780962149795 - 40, 30.31527721701555 - 30, 0.23),
         698.0480146770, 36.2939508380);
  expect(plate_of_four(1, 1.5, 40.86844545786509 - 40, 30.380757917044765 - 30, 0.1),
         2074.3629562285, 37.6367644145);
}

/// Of each step-th of 60 plates right hulls are accepted, wrong ones are not, and a report of a
/// right one that says too much is told. Returns how many are right.
int expect_verified_if_right(unsigned step) {
  int right = 0;
  for (unsigned seed = step; seed <= 60; seed += step) {
    const Outcome o = outcome(random_plate(seed), seed % 2 == 0 ? dmat3(1.0) : skew_rotation());
    EXPECT_EQ(o.found.is_hull(exact), o.right_faces && o.right_report)
        << seed << " " << text_of(o.found);
    if (!o.right_faces) continue;
    if (o.exact) {
      EXPECT_LE(o.found.measures_error, 1e-12) << seed;
    }
    if (!o.right_report) {
      EXPECT_EQ(failed(o.found), std::set<std::string>{"report"}) << seed;
    }
    right += o.right_report ? 1 : 0;
  }
  return right;
}

/// Tangents at the rims of thin ones, where angles of normals count, pass the middle closely.
TEST(Plates, MeanWidthsAreAsAccurateAsIsStated) {
  for (const unsigned seed : {4U, 9U, 32U, 51U}) {
    const Scene scene = make_scene(random_plate(seed).shape());
    const BoundaryMeasures own = measures_of(scene, boundary_of(scene));
    const double truth = measures_of(random_plate(seed)).mean_width;
    EXPECT_LE(std::abs(own.mean_width / truth - 1), own.accuracy + 1e-12) << seed;
    EXPECT_LE(own.accuracy, 1e-10) << seed;
  }
}

// The numbers of right ones may only grow.

TEST(Plates, AreVerifiedIfTheyAreRight) { EXPECT_GE(expect_verified_if_right(1), 48); }

TEST(Plates, SomeAreVerifiedIfTheyAreRight) { EXPECT_GE(expect_verified_if_right(5), 8); }

}  // namespace
}  // namespace taut_test
