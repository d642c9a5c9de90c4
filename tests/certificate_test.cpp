#include "taut/hull/polytope/certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "models.h"
#include "reference.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: random geometry and reference numbers

/// The answer may be this share below the truth.
constexpr real accuracy = 0.03L;
/// Rounding of the answer and of its input.
constexpr real rounding = 1e-14L;

/// max over m of min over the directions d of d . m, where positive: the best m is the foot of the
/// origin on the simplex of one to three of them, so all of these are tried.
real true_depth(const std::vector<dvec3>& directions) {
  std::vector<rvec3> d;
  for (const dvec3& n : directions) d.emplace_back(n);
  real best = -1;
  const auto offer = [&](const rvec3& m) {
    const real length = glm::length(m);
    if (!(length > 0)) return;
    real lowest = std::numeric_limits<real>::infinity();
    for (const rvec3& n : d) {
      lowest = std::min(lowest, glm::dot(n, m) / length);
      if (lowest <= best) return;
    }
    best = lowest;
  };
  for (std::size_t i = 0; i < d.size(); ++i) {
    offer(d[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const rvec3 edge = d[j] - d[i];
      if (glm::dot(edge, edge) > 0) {
        offer(d[i] - glm::dot(d[i], edge) / glm::dot(edge, edge) * edge);
      }
      for (std::size_t k = 0; k < j; ++k) {
        const rvec3 normal = glm::cross(edge, d[k] - d[i]);
        offer(glm::dot(normal, d[i]) > 0 ? normal : -normal);
      }
    }
  }
  return best;
}

void expect_depth(const std::vector<dvec3>& directions, real truth, const std::string& name) {
  const double depth = cone_depth(directions);
  EXPECT_LE(depth, std::max<real>(truth, 0)) << name;
  if (truth > 0) {
    EXPECT_GE(depth, (1 - accuracy) * truth - rounding) << name;
  }
}

std::vector<dvec3> turned(std::vector<dvec3> directions, const dmat3& rotation) {
  for (dvec3& d : directions) d = unit(rotation * d);
  return directions;
}

/// At an angle to the z axis.
dvec3 on_cone(double angle, double t) {
  return unit({std::sin(angle) * std::cos(t), std::sin(angle) * std::sin(t), std::cos(angle)});
}

TEST(ConeDepth, OneDirection) {
  Random random(1);
  const auto expect_one = [](const std::vector<dvec3>& directions) {
    const double depth = cone_depth(directions);
    EXPECT_LE(depth, 1);
    EXPECT_NEAR(depth, 1, 1e-14);
  };
  expect_one({{0, 0, 1}});
  for (int k = 0; k < 100; ++k) {
    const dvec3 n = random_direction(random);
    expect_one({n});
    expect_one(std::vector<dvec3>(7, n));
  }
}

TEST(DeepestAxis, AttainsTheDepth) {
  EXPECT_EQ(deepest_axis({}).axis, dvec3(0.0));
  Random random(17);
  for (int k = 0; k < 200; ++k) {
    const dvec3 about = random_direction(random);
    const double width = log_uniform(random, 1e-6, 3);
    std::vector<dvec3> directions;
    for (int i = pick(random, 1, 8); i > 0; --i) {
      directions.push_back(unit(about + width * random_direction(random)));
    }
    const ConeDepth found = deepest_axis(directions);
    EXPECT_EQ(found.depth, cone_depth(directions));
    EXPECT_NEAR(glm::length(found.axis), 1, 1e-15);
    for (const dvec3& n : directions) EXPECT_GE(glm::dot(found.axis, n), found.depth);
  }
}

TEST(ConeDepth, NoDirectionConstrainsNothing) { EXPECT_EQ(cone_depth({}), 1); }

TEST(ConeDepth, TwoDirections) {
  Random random(2);
  for (const double angle : {1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0, 3.14, 3.1415}) {
    const std::vector<dvec3> pair = {on_cone(angle / 2, 0), on_cone(angle / 2, pi)};
    for (int k = 0; k < 20; ++k) {
      const auto placed = turned(pair, random_rotation(random));
      EXPECT_NEAR(cone_depth(placed), std::cos(angle / 2), double(accuracy) * std::cos(angle / 2));
      expect_depth(placed, true_depth(placed), "angle " + std::to_string(angle));
    }
  }
}

TEST(ConeDepth, OrthonormalTriad) {
  Random random(3);
  const std::vector<dvec3> triad = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double depth = 1 / std::sqrt(3.0);
  EXPECT_LE(cone_depth(triad), depth);
  EXPECT_NEAR(cone_depth(triad), depth, 1e-14);
  for (int k = 0; k < 100; ++k) {
    const auto placed = turned(triad, random_rotation(random));
    EXPECT_NEAR(cone_depth(placed), depth, 1e-14);
  }
}

TEST(ConeDepth, NotPositiveWithoutAnOpenHalfSpace) {
  Random random(4);
  for (int k = 0; k < 200; ++k) {
    const dvec3 n = random_direction(random);
    const std::vector<dvec3> opposite = {n, -n};
    EXPECT_LE(cone_depth(opposite), 0);
    const std::vector<dvec3> more = {n, random_direction(random), -n, random_direction(random)};
    EXPECT_LE(cone_depth(more), 0);
    // A star in a plane, and a tetrahedron about the origin.
    const std::vector<dvec3> star = {on_cone(pi / 2, 0), on_cone(pi / 2, 2 * pi / 3),
                                     on_cone(pi / 2, 4 * pi / 3)};
    EXPECT_LE(cone_depth(turned(star, random_rotation(random))), 1e-15);
    const std::vector<dvec3> around = {unit({1, 1, 1}), unit({1, -1, -1}), unit({-1, 1, -1}),
                                       unit({-1, -1, 1})};
    EXPECT_LE(cone_depth(turned(around, random_rotation(random))), 0);
  }
  const std::vector<dvec3> axes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  EXPECT_LE(cone_depth(axes), 0);
}

TEST(ConeDepth, RoundCones) {
  Random random(5);
  for (const int count : {3, 4, 5, 8, 30, 300}) {
    for (const double angle : {1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.0, 1.3, 1.5, 1.55, 1.57, 1.5707}) {
      std::vector<dvec3> rim;
      for (int k = 0; k < count; ++k) rim.push_back(on_cone(angle, 2 * pi * k / count));
      const auto placed = turned(rim, random_rotation(random));
      // The rim's directions are rounded: by 1e-16 as the closed form has it.
      const real truth = std::cos(real(angle));
      const double depth = cone_depth(placed);
      EXPECT_LE(depth, truth + 1e-15L) << count << " at " << angle;
      EXPECT_GE(depth, (1 - accuracy) * truth - rounding) << count << " at " << angle;
    }
  }
}

TEST(ConeDepth, UnevenConesOfNearlyAHemisphere) {
  // Hundreds of directions on one side: their mean is far from the axis.
  Random random(6);
  for (int k = 0; k < 200; ++k) {
    const double below = log_uniform(random, 1e-8, 0.3);
    std::vector<dvec3> rim;
    for (int j = 0; j < 3; ++j) {
      rim.push_back(on_cone(pi / 2 - below, 2 * pi * j / 3 + uniform(random, -0.4, 0.4)));
    }
    const double narrow = log_uniform(random, 1e-4, 1);
    for (int j = 0; j < 300; ++j) {
      rim.push_back(on_cone(pi / 2 - below, uniform(random, -narrow, narrow)));
    }
    const real truth = std::sin(real(below));
    const double depth = cone_depth(turned(rim, random_rotation(random)));
    EXPECT_LE(depth, truth + 1e-15L) << below;
    EXPECT_GE(depth, (1 - accuracy) * truth - rounding) << below << ", narrow " << narrow;
  }
}

TEST(ConeDepth, NearlyAHemisphereFilledWithDirections) {
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    const double below = log_uniform(random, 1e-6, 0.3);
    std::vector<dvec3> directions;
    for (int j = 0; j < 1000; ++j) {
      const dvec3 n = random_direction(random);
      if (n.z > std::sin(below)) directions.push_back(n);
    }
    for (int j = 0; j < 5; ++j) directions.push_back(on_cone(pi / 2 - below, 2 * pi * j / 5));
    const real truth = std::sin(real(below));
    const double depth = cone_depth(turned(directions, random_rotation(random)));
    EXPECT_LE(depth, truth + 1e-15L) << below;
    EXPECT_GE(depth, (1 - accuracy) * truth - rounding) << below;
  }
}

TEST(ConeDepth, NeverAboveTheTruthAndCloseToIt) {
  Random random(8);
  int solid = 0;
  for (int k = 0; k < 3000; ++k) {
    // Random directions about an axis, closer than an angle from tiny to a half-space and beyond.
    const double angle = log_uniform(random, 1e-10, 2.2);
    const int count = pick(random, 2, 12);
    std::vector<dvec3> directions;
    for (int j = 0; j < count; ++j) {
      const double share = pick(random, 0, 1) == 0 ? 1 : std::sqrt(uniform(random, 0, 1));
      directions.push_back(on_cone(std::min(angle * share, pi), uniform(random, 0, 2 * pi)));
    }
    directions = turned(directions, random_rotation(random));
    const real truth = true_depth(directions);
    if (truth > 0) ++solid;
    expect_depth(directions, truth,
                 "case " + std::to_string(k) + ", truth " + std::to_string(double(truth)));
  }
  EXPECT_GT(solid, 1000);
}

TEST(ConeDepth, FlatFansOfDirections) {
  // Normals across an edge or about a scroll: nearly in a plane, widths and heights log-uniform.
  Random random(9);
  for (int k = 0; k < 1000; ++k) {
    const double width = log_uniform(random, 1e-8, 1.57);
    const double height = log_uniform(random, 1e-16, 1e-2);
    std::vector<dvec3> directions;
    for (int j = pick(random, 2, 16); j > 0; --j) {
      const double t = uniform(random, -width, width);
      directions.push_back(unit({std::cos(t), std::sin(t), height * uniform(random, -1, 1)}));
    }
    directions = turned(directions, random_rotation(random));
    expect_depth(directions, true_depth(directions), "width " + std::to_string(width));
  }
}

/// Normals about the end of a needle: two nearly opposite and one across, in which the points of
/// least norm of the triangle and of its side are one but for rounding.
TEST(ConeDepth, TwoNearlyOppositeDirectionsAndOneAcross) {
  for (const double tilt : {1e-4, 1e-6, 3e-8}) {
    for (const double lean : {0.0, 3.6e-4, 0.1}) {
      const dvec3 across(-1, 0, 0);
      const dvec3 up = unit(dvec3(0, 1, lean + tilt));
      const dvec3 down = unit(dvec3(0, -1, -lean + tilt));
      const real truth = true_depth({across, up, down});
      ASSERT_GT(truth, tilt / 2);
      for (const auto& order : {std::array{across, up, down}, std::array{up, across, down},
                                std::array{down, up, across}}) {
        const double depth = cone_depth(order);
        EXPECT_LE(depth, truth + rounding) << tilt << " " << lean;
        EXPECT_GE(depth, 0.9L * truth) << tilt << " " << lean;
      }
    }
  }
}

TEST(ConeDepth, OrderHardlyMatters) {
  Random random(10);
  for (int k = 0; k < 200; ++k) {
    std::vector<dvec3> directions;
    for (int j = 0; j < 10; ++j) directions.push_back(on_cone(uniform(random, 0, 1.5), 0.7 * j));
    const double depth = cone_depth(directions);
    std::shuffle(directions.begin(), directions.end(), random);
    EXPECT_NEAR(cone_depth(directions), depth, double(accuracy) * std::abs(depth));
  }
}

}  // namespace
}  // namespace taut
