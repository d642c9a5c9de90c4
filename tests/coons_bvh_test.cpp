#include "taut/bounds/coons_bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models.h"
#include "reference.h"

namespace taut {
namespace {

using taut_test::log_uniform;
using taut_test::pick;
using taut_test::Random;
using taut_test::random_patch;
using taut_test::real;
using taut_test::rvec3;
using taut_test::uniform;

/// Parameters at which cells are sampled: the ends, the places of Bernstein maxima, others.
constexpr std::array<real, 6> cell_samples = {0, 0.11L, 1.0L / 3, 0.5L, 0.77L, 1};

/// By how much samples of the cell lie farther from its corners' tetrahedron than it says.
real violation(const CoonsBvh& bvh, const BezierPatch& patch, const CoonsCell& cell) {
  const auto corners = bvh.corners(cell);
  const real deviation = bvh.deviation(cell);
  const Interval u = cell.u();
  const Interval v = cell.v();
  real worst = -std::numeric_limits<real>::infinity();
  for (const real s : cell_samples) {
    for (const real t : cell_samples) {
      const rvec3 x = taut_test::reference_point(patch, (1 - s) * u.lower + s * u.upper,
                                                 (1 - t) * v.lower + t * v.upper);
      worst = std::max(worst, taut_test::distance_to_tetrahedron(x, corners) - deviation);
    }
  }
  return worst;
}

/// All cells of the first levels, then ever fewer, down to `below` levels under a leaf.
void expect_bounded(const BezierPatch& patch, double tolerance, int below, Random& random,
                    const std::string& name) {
  const CoonsBvh bvh(patch, tolerance);
  struct Item {
    CoonsCell cell;
    int below;
  };
  std::vector<Item> stack = {{bvh.root(), 0}};
  real worst = -std::numeric_limits<real>::infinity();
  int visited = 0;
  while (!stack.empty()) {
    const Item item = stack.back();
    stack.pop_back();
    ++visited;
    worst = std::max(worst, violation(bvh, patch, item.cell));
    const bool leaf = bvh.is_leaf(item.cell);
    if (leaf && item.below == below) continue;
    const auto children = bvh.children(item.cell);
    const int next = leaf ? item.below + 1 : 0;
    if (item.cell.level < 2) {
      for (const CoonsCell& child : children) stack.push_back({child, next});
    } else {
      stack.push_back({children[std::size_t(pick(random, 0, 3))], next});
    }
  }
  EXPECT_GE(visited, 5) << name;
  EXPECT_LE(worst, 0) << name;
  EXPECT_TRUE(std::isfinite(bvh.deviation(bvh.root()))) << name;
}

std::string label(const BezierPatch& patch, double weights, double tolerance) {
  return "degrees " + std::to_string(patch.degree_u) + " x " + std::to_string(patch.degree_v) +
         ", weights up to " + std::to_string(weights) + ", tolerance " + std::to_string(tolerance);
}

/// Puts all points of some sides of the patch on one point.
void collapse(Random& random, BezierPatch& patch) {
  const int sides = pick(random, 1, 15);
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const auto move_to = [&](const dvec4& target) {
        patch.at(i, j) = homogeneous(euclidean(target), patch.at(i, j).w);
      };
      if ((sides & 1) != 0 && i == 0) move_to(patch.at(0, 0));
      if ((sides & 2) != 0 && i == patch.degree_u) move_to(patch.at(patch.degree_u, 0));
      if ((sides & 4) != 0 && j == 0) move_to(patch.at(0, 0));
      if ((sides & 8) != 0 && j == patch.degree_v) move_to(patch.at(0, patch.degree_v));
    }
  }
}

TEST(CoonsBvh, FlatBilinearPatchDoesNotDeviate) {
  const BezierPatch patch{1, 1, {{0, 0, 0, 1}, {0, 2, 0, 1}, {3, 0, 0, 1}, {3, 2, 1, 1}}};
  const CoonsBvh bvh(patch, 1e-6);
  EXPECT_EQ(bvh.node_count(), 1);
  EXPECT_EQ(bvh.leaf_count(), 1);
  EXPECT_TRUE(bvh.is_leaf(bvh.root()));
  EXPECT_LT(bvh.deviation(bvh.root()), 1e-13);
  const auto corners = bvh.corners(bvh.root());
  EXPECT_EQ(corners[0], dvec3(0, 0, 0));
  EXPECT_EQ(corners[1], dvec3(0, 2, 0));
  EXPECT_EQ(corners[2], dvec3(3, 0, 0));
  EXPECT_EQ(corners[3], dvec3(3, 2, 1));
  const CoonsCell child = bvh.children(bvh.root())[2];
  EXPECT_EQ(child.u().lower, 0.5);
  EXPECT_EQ(child.u().upper, 1);
  EXPECT_EQ(child.v().upper, 0.5);
  EXPECT_EQ(bvh.corners(child)[0], dvec3(1.5, 0, 0));
}

TEST(CoonsBvh, ParabolaDeviatesByItsSagitta) {
  // z = 4 h u (1 - u) has sagitta h; the bound |c''| / 8 is exact for it.
  const BezierPatch patch{
      2, 1, {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 2, 1}, {1, 1, 2, 1}, {2, 0, 0, 1}, {2, 1, 0, 1}}};
  const CoonsBvh bvh(patch, 1e-6);
  EXPECT_TRUE(bvh.is_leaf(bvh.root()));  // it is its own Coons patch
  EXPECT_NEAR(bvh.deviation(bvh.root()), 1, 1e-12);
  CoonsCell cell = bvh.root();
  for (int level = 1; level <= 20; ++level) {
    cell = bvh.children(cell)[std::size_t(level % 4)];
    EXPECT_NEAR(bvh.deviation(cell), std::ldexp(1.0, -2 * level), 1e-12) << level;
    EXPECT_LT(bvh.coons_distance(cell), 1e-12);
  }
}

TEST(CoonsBvh, CurvesAndPointsArePatchesOfDegreeZero) {
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    const BezierCurve curve = taut_test::random_curve(random, pick(random, 1, 9), k % 2 ? 10 : 1);
    expect_bounded({curve.degree(), 0, curve.points}, 1e-3, 4, random, "curve");
    expect_bounded({0, curve.degree(), curve.points}, 1e-3, 4, random, "curve along v");
  }
  const CoonsBvh point({0, 0, {{2, 4, 6, 2}}}, 1e-3);
  EXPECT_EQ(point.corners(point.root())[3], dvec3(1, 2, 3));
  EXPECT_LT(point.deviation(point.root()), 1e-13);
}

TEST(CoonsBvh, DenseSamplesOfPolynomialPatchesNeverViolateBounds) {
  Random random(2);
  for (int p = 1; p <= 9; ++p) {
    for (int q = 1; q <= 9; q += 1 + p % 2) {
      const BezierPatch patch = random_patch(random, p, q, 1);
      const double tolerance = log_uniform(random, 1e-4, 1);
      expect_bounded(patch, tolerance, 4, random, label(patch, 1, tolerance));
    }
  }
}

TEST(CoonsBvh, DenseSamplesOfRationalPatchesNeverViolateBounds) {
  Random random(3);
  for (int k = 0; k < 40; ++k) {
    const double weights = log_uniform(random, 1.01, 30);
    const BezierPatch patch = random_patch(random, {1, 7}, weights);
    const double tolerance = log_uniform(random, 1e-3, 10);
    expect_bounded(patch, tolerance, 4, random, label(patch, weights, tolerance));
  }
}

TEST(CoonsBvh, ExtremeWeightsStayBounded) {
  Random random(4);
  for (int k = 0; k < 8; ++k) {
    const double weights = log_uniform(random, 100, 1e6);
    const BezierPatch patch = random_patch(random, {1, 3}, weights);
    expect_bounded(patch, 10, 3, random, label(patch, weights, 10));
  }
}

TEST(CoonsBvh, CollapsedPatchesStayBounded) {
  Random random(5);
  for (int k = 0; k < 40; ++k) {
    const double weights = k % 2 == 0 ? 1 : 5;
    BezierPatch patch = random_patch(random, {1, 5}, weights);
    collapse(random, patch);
    const double tolerance = log_uniform(random, 1e-3, 1);
    expect_bounded(patch, tolerance, 4, random, "collapsed " + label(patch, weights, tolerance));
  }
}

TEST(CoonsBvh, PatchesFarFromTheOriginStayBounded) {
  Random random(6);
  for (int k = 0; k < 20; ++k) {
    BezierPatch patch = random_patch(random, {1, 5}, 3);
    const double far = log_uniform(random, 10, 1e8);
    for (dvec4& p : patch.points) p = homogeneous(euclidean(p) + dvec3(far, -far, far / 3), p.w);
    expect_bounded(patch, 0.01, 4, random, "far " + std::to_string(far));
  }
}

TEST(CoonsBvh, SizesFromSmallToLarge) {
  Random random(7);
  for (const double size : {1e-100, 1e-50, 1e-6, 1e6, 1e50, 1e100}) {
    BezierPatch patch = random_patch(random, 3, 3, 2);
    for (dvec4& p : patch.points) p = dvec4(dvec3(p) * size, p.w);
    expect_bounded(patch, 1e-2 * size, 4, random, "size " + std::to_string(std::log10(size)));
  }
}

TEST(CoonsBvh, DeviationFallsByFourPerLevel) {
  Random random(8);
  for (int k = 0; k < 3; ++k) {
    const BezierPatch patch = random_patch(random, {2, 3}, k % 2 == 0 ? 1 : 3);
    // Explicit levels.
    const CoonsBvh fine(patch, 1e-9);
    CoonsCell cell = fine.root();
    std::vector<double> deviations;
    while (!fine.is_leaf(cell)) {
      deviations.push_back(fine.deviation(cell));
      cell = fine.children(cell)[std::size_t(pick(random, 0, 3))];
    }
    ASSERT_GE(deviations.size(), 7U);
    const std::size_t last = deviations.size() - 1;
    EXPECT_NEAR(std::log2(deviations[last - 3] / deviations[last]) / 3, 2, 0.4);
    // Implicit ones: exactly, but for the distance from the Coons patch.
    const double floor = fine.coons_distance(cell);
    const CoonsCell child = fine.children(cell)[0];
    const CoonsCell grandchild = fine.children(child)[3];
    const double above = fine.deviation(child) - floor;
    EXPECT_NEAR(fine.deviation(grandchild) - floor, above / 4, 1e-12 + 1e-9 * above);
  }
}

TEST(CoonsBvh, CoonsDistanceFallsBySixteenPerLevel) {
  Random random(9);
  for (int k = 0; k < 20; ++k) {
    const BezierPatch patch = random_patch(random, {2, 5}, k % 2 == 0 ? 1 : 2);
    const double u = uniform(random, 0, 0.9);
    const double v = uniform(random, 0, 0.9);
    const auto distance = [&](double size) {
      const CoonsBvh bvh(restricted(patch, {u, u + size}, {v, v + size}), 1e9);
      EXPECT_TRUE(bvh.is_leaf(bvh.root()));
      return bvh.coons_distance(bvh.root());
    };
    EXPECT_NEAR(std::log2(distance(1.0 / 64) / distance(1.0 / 512)) / 3, 4, 0.35);
  }
}

TEST(CoonsBvh, TighterToleranceTakesMoreNodesAndReachesIt) {
  Random random(10);
  const BezierPatch patch = random_patch(random, 4, 4, 2);
  int nodes = 0;
  for (const double tolerance : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    const CoonsBvh bvh(patch, tolerance);
    EXPECT_GE(bvh.node_count(), nodes);
    EXPECT_EQ(bvh.node_count(), (4 * bvh.leaf_count() - 1) / 3);
    EXPECT_GT(bvh.memory(), std::size_t(bvh.node_count()) * 8);
    nodes = bvh.node_count();
    CoonsCell cell = bvh.root();
    while (!bvh.is_leaf(cell)) cell = bvh.children(cell)[1];
    if (cell.level < 8) {
      EXPECT_LE(bvh.coons_distance(cell), tolerance * (1 + 1e-9));
    }
  }
  EXPECT_GT(nodes, 100);
}

TEST(CoonsBvh, DeepestCellsStayBounded) {
  Random random(11);
  const BezierPatch patch = random_patch(random, 3, 3, 1);
  const CoonsBvh bvh(patch, 1e-2);
  CoonsCell cell = bvh.root();
  for (int level = 0; level < 31; ++level) {
    EXPECT_LE(violation(bvh, patch, cell), 0) << level;
    cell = bvh.children(cell)[std::size_t(pick(random, 0, 3))];
  }
  EXPECT_LE(violation(bvh, patch, cell), 0);
}

}  // namespace
}  // namespace taut
