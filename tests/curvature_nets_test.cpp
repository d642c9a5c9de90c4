#include "taut/bounds/curvature_nets.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "models.h"
#include "surface_checks.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

constexpr std::array<bool, 4> no_poles = {};

Interval random_interval(Random& random) {
  const double a = uniform(random, 0, 1);
  const double b = uniform(random, 0, 1);
  return {std::min(a, b), std::max(a, b)};
}

/// Second derivatives along a unit normal.
struct Form {
  real uu, uv, vv;
  real determinant() const { return uu * vv - uv * uv; }
};

Form form_at(const BezierPatch& patch, real u, real v) {
  const ReferenceJet j = reference_jet(patch, u, v);
  const rvec3 n = j.normal();
  return {glm::dot(j.Suu, n), glm::dot(j.Suv, n), glm::dot(j.Svv, n)};
}

/// What is said of a rectangle holds in points of it; how often something was.
int check(const BezierPatch& patch, const std::array<bool, 4>& poles, const std::string& name,
          Random& random, int rectangles) {
  const CurvatureNets nets(patch, poles);
  int told = 0;
  for (int k = 0; k < rectangles; ++k) {
    const Interval u = random_interval(random);
    const Interval v = random_interval(random);
    const SecondForm form = nets.over(u, v);
    const std::optional<NormalPyramid> pyramid = nets.normals(u, v);
    const bool negative = form.surely_negative();
    const bool positive = form.surely_positive();
    told += negative || positive || form.surely_saddle();
    for (int i = 0; i < 20; ++i) {
      const double s = u.at(uniform(random, 0, 1));
      const double t = v.at(uniform(random, 0, 1));
      const Form there = form_at(patch, s, t);
      if (negative || positive) {
        EXPECT_GT(there.determinant(), 0) << name;
        EXPECT_EQ(there.uu < 0, negative) << name;
      }
      if (form.surely_saddle()) {
        EXPECT_LT(there.determinant(), 0) << name;
      }
      if (pyramid) {
        EXPECT_TRUE(pyramid->may_contain(dvec3(reference_jet(patch, s, t).normal()))) << name;
      }
    }
  }
  return told;
}

TEST(CurvatureNets, HoldForRandomPatches) {
  Random random(5);
  int told = 0;
  for (int k = 0; k < 100; ++k) {
    const double weights = k % 2 == 0 ? 1 : log_uniform(random, 1.01, 10);
    const BezierPatch patch = random_patch(random, {1, 5}, weights);
    told += check(patch, no_poles, std::to_string(k), random, 20);
  }
  EXPECT_GE(told, 100);
}

/// Halved again and again, in turns at random: what is said of a part holds in points of it.
TEST(CurvatureNets, HalvesHoldInTheirParts) {
  Random random(8);
  int told = 0;
  int saddles = 0;
  const Model model = make_model(blob(2));
  const std::vector<Patch>& patches = model.parts()[0].patches();
  for (int k = 0; k < 100; ++k) {
    const BezierPatch& patch = patches[std::size_t(k) % patches.size()].bezier;
    CurvatureNets nets(patch, no_poles);
    Interval u{0, 1};
    Interval v{0, 1};
    for (int level = 0; level < 8; ++level) {
      const Direction direction = pick(random, 0, 1) == 0 ? Direction::u : Direction::v;
      const int half = pick(random, 0, 1);
      Interval& t = direction == Direction::u ? u : v;
      (half == 0 ? t.upper : t.lower) = t.at(0.5);
      std::array<CurvatureNets, 2> halves = nets.halves(direction);
      nets = std::move(halves[std::size_t(half)]);
      const int sign = nets.definite_sign();
      const std::optional<NormalPyramid> pyramid = nets.normals();
      const bool saddle = nets.over().surely_saddle();
      told += sign != 0 || saddle ? 1 : 0;
      saddles += saddle ? 1 : 0;
      for (int i = 0; i < 10; ++i) {
        const double x = u.at(uniform(random, 0, 1));
        const double y = v.at(uniform(random, 0, 1));
        const Form there = form_at(patch, x, y);
        if (sign != 0) {
          EXPECT_GT(there.determinant(), 0) << k;
          EXPECT_EQ(there.uu < 0, sign < 0) << k;
        }
        if (saddle) {
          EXPECT_LT(there.determinant(), 0) << k;
        }
        if (pyramid) {
          EXPECT_TRUE(pyramid->may_contain(dvec3(reference_jet(patch, x, y).normal()))) << k;
        }
      }
    }
  }
  EXPECT_GE(told, 100);
  EXPECT_GE(saddles, 10);
}

/// A quadric is curved one way everywhere, and the nets tell so at once, up to the poles.
TEST(CurvatureNets, ProveWholeQuadrics) {
  Random random(6);
  for (const Shape& shape : {sphere(), ellipsoid(3, 2, 1), mapped(sphere(), skew_rotation()),
                             shifted(ellipsoid(1, 2, 5), {20, 30, -10})}) {
    const Model model = make_model(shape);
    for (const Patch& patch : model.parts()[0].patches()) {
      std::array<bool, 4> poles{};
      for (const Side side : all_sides) {
        poles[std::size_t(side)] = patch.borders[std::size_t(side)].kind == BorderKind::collapsed;
      }
      const CurvatureNets nets(patch.bezier, poles);
      const SecondForm form = nets.over({0, 1}, {0, 1});
      EXPECT_TRUE(form.surely_negative() || form.surely_positive());
      EXPECT_TRUE(nets.normals({0, 1}, {0, 1}).has_value());
      EXPECT_EQ(check(patch.bezier, poles, "quadric", random, 20), 20);
    }
  }
}

/// A graph over the quadrangle of four points, z = form of x and y.
BezierPatch quadric_over(const std::array<dvec2, 4>& corners, double xx, double xy, double yy) {
  // Blossoms: corners are (0, 0), (0, 1), (1, 0), (1, 1).
  const auto product = [&](int i, int j, int axis, int other) {
    double sum = 0;
    int count = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        if ((a >> 1) + (b >> 1) != i || (a & 1) + (b & 1) != j) continue;
        sum += corners[std::size_t(a)][axis] * corners[std::size_t(b)][other];
        ++count;
      }
    }
    return sum / count;
  };
  const auto at = [&](int i, int j) {
    const auto mean = [&](int axis) {
      const auto own = [&](int a, int b) { return corners[std::size_t(2 * a + b)][axis]; };
      return 0.25 * ((2 - i) * ((2 - j) * own(0, 0) + j * own(0, 1)) +
                     i * ((2 - j) * own(1, 0) + j * own(1, 1)));
    };
    return dvec3(
        mean(0), mean(1),
        xx * product(i, j, 0, 0) + 2 * xy * product(i, j, 0, 1) + yy * product(i, j, 1, 1));
  };
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) patch.points.push_back(homogeneous(at(i, j)));
  }
  return patch;
}

/// Slivers of a fan, as they are about the pole of a cage: in a corner of them parameter lines are
/// all but parallel.
TEST(CurvatureNets, TellSliversApart) {
  for (const double width : {0.3, 0.03, 0.003}) {
    SCOPED_TRACE(width);
    const std::array<dvec2, 4> kite = {dvec2{1, 0}, {0.5, 0}, {1, width}, {0.66, 0.7 * width}};
    const auto sign = [&](double xx, double xy, double yy) {
      return CurvatureNets(quadric_over(kite, xx, xy, yy), no_poles).definite_sign();
    };
    const int up = sign(1, 0.3, 2);
    EXPECT_NE(up, 0);
    EXPECT_EQ(sign(-1, 0.3, -2), -up);
    EXPECT_EQ(sign(1e-3, 0, 2), up);
    EXPECT_EQ(sign(1, 0, -2), 0);
    EXPECT_EQ(sign(1, 0, -1e-3), 0);
    EXPECT_EQ(sign(1, 1, 1), 0);  // bends one way only
    EXPECT_EQ(sign(0, 0, 0), 0);
  }
}

/// A pole that is none: the tip of a cone has no normal, and nothing is told of it.
TEST(CurvatureNets, TellNothingOfTips) {
  BezierPatch tip{2, 2, {}};
  for (const double u : {-1.0, 0.0, 1.0}) {
    for (const double v : {0.0, 1.0, 2.0}) {
      tip.points.push_back(homogeneous({u * v, (1 - u * u) * v, v + 0.1 * v * v}));
    }
  }
  const CurvatureNets nets(tip, {false, false, true, false});
  const SecondForm form = nets.over({0, 1}, {0, 1});
  EXPECT_FALSE(form.surely_negative() || form.surely_positive() || form.surely_saddle());
}

/// The less a patch is curved the more of its second derivatives is rounding of its control points,
/// however small both are.
TEST(CurvatureNets, SignsOutdoRoundingOfControlPoints) {
  Random random(9);
  int told = 0;
  for (int k = 0; k < 1000; ++k) {
    const dmat3 turned = random_rotation(random);
    const dvec3 at = log_uniform(random, 1e-3, 10) * random_direction(random);
    const double bend = log_uniform(random, 1e-18, 1e-13);
    BezierPatch patch{2, 2, {}};
    for (int i = 0; i <= 2; ++i) {
      for (int j = 0; j <= 2; ++j) {
        const dvec3 x(i, j, -bend * (i * i + j * j));
        patch.points.push_back(homogeneous(at + turned * x));
      }
    }
    const int sign = CurvatureNets(patch, no_poles).definite_sign();
    if (sign == 0) continue;
    ++told;
    for (int i = 0; i < 20; ++i) {
      const Form form = form_at(patch, uniform(random, 0, 1), uniform(random, 0, 1));
      EXPECT_GT(form.determinant(), 0) << k << " " << bend;
      EXPECT_EQ(form.uu > 0, sign > 0) << k << " " << bend;
    }
  }
  EXPECT_GE(told, 50);
}

TEST(CurvatureNets, TellNothingOfFlatPatches) {
  Random random(7);
  const BezierPatch plane = make_model(disc(1, 0)).parts()[0].patches()[0].bezier;
  const CurvatureNets nets(plane, no_poles);
  const SecondForm form = nets.over({0, 1}, {0, 1});
  EXPECT_FALSE(form.surely_negative() || form.surely_positive() || form.surely_saddle());
}

TEST(CurvatureNets, WeightsThatAreAllTheSameCountForNothing) {
  const BezierPatch bowl = {2,
                            2,
                            {{0, 0, 1, 1},
                             {1, 0, 0, 1},
                             {2, 0, 1, 1},
                             {0, 1, 0, 1},
                             {1, 1, -1, 1},
                             {2, 1, 0, 1},
                             {0, 2, 1, 1},
                             {1, 2, 0, 1},
                             {2, 2, 1, 1}}};
  BezierPatch weighted = bowl;
  for (dvec4& p : weighted.points) p *= 0.25;
  const CurvatureNets nets(bowl, no_poles);
  const CurvatureNets same(weighted, no_poles);
  EXPECT_EQ(nets.definite_sign(), same.definite_sign());
  EXPECT_GT(nets.shortfall_bound(-nets.definite_sign()), 0);
  EXPECT_EQ(nets.shortfall_bound(-nets.definite_sign()),
            same.shortfall_bound(-nets.definite_sign()));
}

}  // namespace
}  // namespace taut
