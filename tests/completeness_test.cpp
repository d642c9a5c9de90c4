// Whether all directions of a model are decided.

#include <gtest/gtest.h>

#include <string>

#include "freeform.h"
#include "models.h"
#include "taut/hull/precise_hull.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Cells of the map that are not decided, of a model that comes out whole.
long undecided(const Shape& shape) {
  HullOptions options;
  options.threads = 1;
  const Hull hull = precise_hull(make_scene(shape), options);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_GT(hull.statistics.map_cells, 0);
  return hull.statistics.map_undecided;
}

TEST(Completeness, AllCellsOfTheTruthsAreDecided) {
  for (const Truth& truth : truths()) {
    EXPECT_EQ(undecided(truth.shape), 0) << truth.name;
    EXPECT_EQ(undecided(mapped(truth.shape, skew_rotation(), {3, -1, 2})), 0) << truth.name;
  }
}

TEST(Completeness, AllCellsOfTwoToriOnATableAreDecided) {
  EXPECT_EQ(undecided(torus(1, 0.25) + shifted(torus(1, 0.25), {4, 0, 0})), 0);
}

TEST(Completeness, AllCellsOfBlobsAreDecided) {
  for (unsigned seed = 1; seed <= 20; ++seed) EXPECT_EQ(undecided(blob(seed)), 0) << seed;
}

}  // namespace
}  // namespace taut
