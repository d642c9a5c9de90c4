#include "taut/bounds/gauss_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "models.h"
#include "surface_checks.h"
#include "taut/bounds/normal_net.h"
#include "taut/bounds/patch_nets.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/second_form.h"
#include "taut/core/error.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

/// Parameters of a cell at which it is sampled.
constexpr std::array<real, 6> samples = {0, 0.13L, 1.0L / 3, 0.5L, 0.79L, 1};

rvec3 net_value(const NormalNet& net, real u, real v) {
  rvec3 sum(0);
  for (int i = 0; i <= net.shape.p; ++i) {
    for (int j = 0; j <= net.shape.q; ++j) {
      sum += bernstein(net.shape.p, i, u) * bernstein(net.shape.q, j, v) *
             rvec3(net.vectors[std::size_t(i * (net.shape.q + 1) + j)]);
    }
  }
  return sum;
}

/// How far outside a direction of length one lies, as the largest of the four sides' sines.
real outside(const NormalPyramid& pyramid, const rvec3& n) {
  real worst = -1;
  for (std::size_t k = 0; k < 4; ++k) {
    const rvec3 corner(pyramid.corners[k]);
    const rvec3 side = glm::cross(corner, rvec3(pyramid.corners[(k + 1) % 4]) - corner);
    worst = std::max(worst, -glm::dot(side, n) / glm::length(side));
  }
  return worst;
}

TEST(NormalNet, IsTheNormalOfRandomPatches) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const int p = pick(random, 1, 5);
    const int q = pick(random, 1, 5);
    const double weights = k % 2 == 0 ? 1 : log_uniform(random, 1.01, 20);
    const BezierPatch patch = random_patch(random, p, q, weights);
    const NormalNet net = normal_net(patch);
    EXPECT_EQ(net.shape.p, weights == 1 ? 2 * p - 1 : 3 * p - 2);
    EXPECT_EQ(net.shape.q, weights == 1 ? 2 * q - 1 : 3 * q - 2);
    real factor = 0;  // polynomial: the same everywhere
    for (const real u : samples) {
      for (const real v : samples) {
        const rvec3 n = reference_jet(patch, u, v).normal();
        const rvec3 found = net_value(net, u, v);
        ASSERT_GT(glm::dot(n, found), 0) << p << " x " << q << ", weights " << weights;
        ASSERT_LE(glm::length(glm::cross(n, found)) / glm::length(n), net.rounding_bound);
        if (weights != 1) continue;
        if (factor == 0) factor = glm::length(n) / glm::length(found);
        ASSERT_LE(glm::length(n - factor * found), 1e-12L * glm::length(n) + 1e-14L);
      }
    }
  }
}

TEST(NormalNet, VanishesAlongCollapsedSidesAndOnCurves) {
  const BezierPatch pole = sphere().surfaces.empty()
                               ? BezierPatch()
                               : make_model(sphere()).parts()[0].patches()[0].bezier;
  const NormalNet net = normal_net(pole);
  int zero = 0;
  for (const dvec3& n : net.vectors) zero += glm::length(n) <= 2 * net.rounding_bound;
  EXPECT_GE(zero, std::min(net.shape.p, net.shape.q) + 1);
  EXPECT_LT(zero, net.shape.size());

  BezierPatch line{2, 2, {}};
  for (int k = 0; k < 9; ++k) line.points.push_back(homogeneous(dvec3(k * 0.1, 0.2 * k, 0.3 * k)));
  const NormalNet none = normal_net(line);
  for (const dvec3& n : none.vectors) EXPECT_LE(glm::length(n), 2 * none.rounding_bound);
}

TEST(NormalPyramid, ContainsCombinationsAndIsTight) {
  Random random(2);
  for (int k = 0; k < 500; ++k) {
    const dvec3 axis = random_direction(random);
    const double spread = log_uniform(random, 1e-12, 1);
    std::vector<dvec3> vectors;
    for (int i = 0; i < 7; ++i) {
      vectors.push_back(log_uniform(random, 1e-3, 1e3) *
                        unit(axis + spread * random_direction(random)));
    }
    const dvec3 along = k % 3 == 0 ? dvec3(0.0) : random_direction(random);
    const auto pyramid = normal_pyramid(vectors, 0, along);
    if (!pyramid) {
      EXPECT_GT(spread, 0.5);
      continue;
    }
    rvec3 sum(0);
    for (const dvec3& v : vectors) {
      ASSERT_LE(outside(*pyramid, glm::normalize(rvec3(v))), 0) << spread;
      ASSERT_TRUE(pyramid->may_contain(v));
      sum += real(uniform(random, 0, 1)) * rvec3(v);
    }
    ASSERT_LE(outside(*pyramid, glm::normalize(sum)), 0);
    ASSERT_TRUE(pyramid->may_contain(dvec3(sum)));
    EXPECT_FALSE(pyramid->may_contain(-axis));
    // Inside the box the vectors can be a diagonal apart.
    const dvec3 far = unit(axis + (4 * spread + 1e-9) * unit(glm::cross(axis, dvec3(sum) + along)));
    if (spread < 0.1 && glm::length(far) > 0.5) {
      EXPECT_FALSE(pyramid->may_contain(far)) << spread;
    }
    for (const dvec3& corner : pyramid->corners) EXPECT_GE(glm::length(corner), 1 - 1e-15);
  }
}

TEST(NormalPyramid, NoneOutsideAHalfSpace) {
  EXPECT_FALSE(normal_pyramid(std::vector<dvec3>{}, 0));
  EXPECT_FALSE(normal_pyramid(std::vector<dvec3>{dvec3(0.0)}, 0));
  EXPECT_FALSE(normal_pyramid(std::vector<dvec3>{{1, 0, 0}, {-1, 0, 0}}, 0));
  EXPECT_FALSE(normal_pyramid(std::vector<dvec3>{{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, 0));
  EXPECT_FALSE(normal_pyramid(std::vector<dvec3>{{1e-9, 0, 0}}, 1e-9));
  EXPECT_TRUE(normal_pyramid(std::vector<dvec3>{{1, 0, 0}, {0, 0, 0}}, 0));
  EXPECT_TRUE(normal_pyramid(std::vector<dvec3>{{1, 0, 0}, {1e-10, 1e-10, 0}}, 1e-9));
}

struct Found {
  real outside = -1;  ///< of a pyramid, at worst
  long tested = 0;
  long without = 0;  ///< cells below the roots without a pyramid
  long wrong_sign = 0;
  long definite = 0;
  long unlisted = 0;  ///< normals whose direction does not know the cell
};

/// Samples a node: its normals must be in its pyramid and its curvature must agree with the signs.
void check_node(const GaussMap& map, int part, std::int32_t index, const BezierPatch& patch,
                Found& found) {
  const GaussNode& node = map.nodes(part)[std::size_t(index)];
  const NormalBounds& b = node.bounds;
  found.without += !b.pyramid && node.cell.level > 0;
  found.definite += b.definite;
  real size = 0;
  for (const dvec4& p : patch.points) size = std::max<real>(size, glm::length(euclidean(p)));
  const Interval u = node.cell.u();
  const Interval v = node.cell.v();
  for (const real s : samples) {
    for (const real t : samples) {
      const ReferenceJet j =
          reference_jet(patch, (1 - s) * u.lower + s * u.upper, (1 - t) * v.lower + t * v.upper);
      const real length = glm::length(j.normal());
      if (length < 1e-12L * size * size) continue;  // a pole, within rounding
      const rvec3 n = j.normal() / length;
      ++found.tested;
      if (b.pyramid) found.outside = std::max(found.outside, outside(*b.pyramid, n));
      const real uu = glm::dot(j.Suu, n);
      const real uv = glm::dot(j.Suv, n);
      const real vv = glm::dot(j.Svv, n);
      const real det = uu * vv - uv * uv;
      const real small = 1e-9L * (uu * uu + vv * vv + uv * uv);
      const bool minus = uu > 0 && det > small;
      const bool plus = uu < 0 && det > small;
      found.wrong_sign +=
          (plus && !b.signs.plus) || (minus && !b.signs.minus) || (b.definite && det < -small);
      if (node.first_child >= 0 || map.ruled(part, 0)) continue;
      for (const bool opposite : {false, true}) {
        if (!(opposite ? minus : plus)) continue;
        const dvec3 direction(opposite ? -n : n);
        const auto entries = map.entries(part, direction);
        found.unlisted += std::none_of(entries.begin(), entries.end(), [&](const auto& e) {
          return e.node == index && e.opposite == opposite;
        });
      }
    }
  }
}

Found check_map(const Shape& shape, int levels) {
  const Scene scene = make_scene(shape);
  const GaussMap map(scene, {.levels = levels, .threads = 1, .progress = {}});
  const Part& part = scene.model().parts()[0];
  Found found;
  EXPECT_EQ(map.root_count(0), int(part.patches().size()));
  for (std::size_t k = 0; k < map.nodes(0).size(); ++k) {
    const GaussNode& node = map.nodes(0)[k];
    const int patch = scene.content().parts[0].elements[std::size_t(node.element)].index;
    check_node(map, 0, std::int32_t(k), part.patches()[std::size_t(patch)].bezier, found);
    if (node.first_child < 0) continue;
    for (std::uint32_t c = 0; c < 4; ++c) {
      const GaussNode& child = map.nodes(0)[std::size_t(node.first_child) + c];
      EXPECT_EQ(child.element, node.element);
      EXPECT_EQ(child.cell.level, node.cell.level + 1);
      EXPECT_EQ(child.cell.i, 2 * node.cell.i + c / 2);
      EXPECT_EQ(child.cell.j, 2 * node.cell.j + c % 2);
    }
  }
  return found;
}

void expect_right(const Found& found, const std::string& name) {
  EXPECT_LE(found.outside, 0) << name;
  EXPECT_EQ(found.wrong_sign, 0) << name;
  EXPECT_EQ(found.unlisted, 0) << name;
  EXPECT_GT(found.tested, 0) << name;
}

TEST(GaussMap, PyramidsHoldAllNormals) {
  struct Case {
    std::string name;
    Shape shape;
  };
  const std::vector<Case> cases = {{"teapot", teapot()},
                                   {"sphere", sphere()},
                                   {"ellipsoid", ellipsoid(1, 20, 300)},
                                   {"torus", torus(2, 0.5)},
                                   {"cone", cone(1, 2)},
                                   {"dented", dented()},
                                   {"dented ellipsoid", dented_ellipsoid()},
                                   {"saddle", saddle()}};
  for (const Case& c : cases) {
    const Found found = check_map(c.shape, 2);
    expect_right(found, c.name);
    EXPECT_LE(found.without, 2) << c.name;  // the teapot's spout
  }
}

TEST(GaussMap, PyramidsHoldAllNormalsOfRandomPatches) {
  Random random(3);
  long definite = 0;
  long with = 0;
  for (int k = 0; k < 60; ++k) {
    const double weights = k % 2 == 0 ? 1 : log_uniform(random, 1.01, 10);
    BezierPatch patch = random_patch(random, {1, 4}, weights);
    // A gentle patch over the plane, to have pyramids at the upper levels too.
    const double bend = log_uniform(random, 1e-3, 1);
    for (int i = 0; i <= patch.degree_u; ++i) {
      for (int j = 0; j <= patch.degree_v; ++j) {
        dvec4& p = patch.at(i, j);
        const dvec3 x = euclidean(p);
        p = homogeneous({i + 0.2 * x.x, j + 0.2 * x.y, bend * (i * i + j * j + x.z)}, p.w);
      }
    }
    const Found found = check_map(of_patch(patch), 3);
    if (found.tested > 0) expect_right(found, std::to_string(k));
    definite += found.definite;
    with += found.tested > 0 && found.without == 0;
  }
  EXPECT_GE(definite, 100);
  EXPECT_GE(with, 20);
}

/// Second derivatives along the normals of one cell, scaled as the pyramid's corners and by the
/// weight, must lie between the bounds; `region` is what is bounded, the cell lies in it.
TEST(SecondForm, BoundsTheSecondDerivatives) {
  Random random(9);
  int tested = 0;
  for (int k = 0; k < 300; ++k) {
    const double weights = k % 3 == 0 ? 1 : log_uniform(random, 1.01, 10);
    const BezierPatch patch = random_patch(random, {1, 4}, weights);
    const double size = log_uniform(random, 1e-3, 0.3);
    const double u0 = uniform(random, 0, 1 - size);
    const double v0 = uniform(random, 0, 1 - size);
    const BezierPatch cell = restricted(patch, {u0, u0 + size}, {v0, v0 + size});
    const BezierPatch region = k % 2 == 0 ? cell : patch;
    const NormalNet net = normal_net(cell);
    const auto pyramid = normal_pyramid(net.vectors, net.rounding_bound);
    if (!pyramid) continue;
    const SecondForm form = second_form({patch.degree_u, patch.degree_v}, weights != 1,
                                        region.points, cell.points, pyramid->corners, 1e-15);
    ++tested;
    for (const real s : samples) {
      for (const real t : samples) {
        const ReferenceJet touching = reference_jet(cell, s, t);
        rvec3 n = touching.normal();
        n /= glm::dot(n, rvec3(pyramid->axis));
        const auto expect_between = [&](real uu, real uv, real vv) {
          ASSERT_TRUE(uu >= form.uu.lower && uu <= form.uu.upper) << k;
          ASSERT_TRUE(uv >= form.uv.lower && uv <= form.uv.upper) << k;
          ASSERT_TRUE(vv >= form.vv.lower && vv <= form.vv.upper) << k;
        };
        // Of w (S - x) . n at another point of the region: x is where the plane touches.
        for (const real a : samples) {
          const real b = 1 - a * t;
          real d[3] = {0, 0, 0};
          for (int i = 0; i <= region.degree_u; ++i) {
            for (int j = 0; j <= region.degree_v; ++j) {
              const rvec4 p(region.at(i, j));
              const real height = glm::dot(rvec3(p) - p.w * touching.S, n);
              for (int order = 0; order < 3; ++order) {
                d[order] += height * bernstein_derivative(region.degree_u, i, 2 - order, a) *
                            bernstein_derivative(region.degree_v, j, order, b);
              }
            }
          }
          expect_between(d[0], d[1], d[2]);
        }
      }
    }
  }
  EXPECT_GE(tested, 100);
}

TEST(GaussMap, SeesSaddlesAndDefiniteSurfaces) {
  const auto root = [](const Shape& shape) {
    const Scene scene = make_scene(shape);
    const GaussMap map(scene);
    return map.nodes(0)[0].bounds;
  };
  EXPECT_FALSE(root(saddle()).signs.any());
  EXPECT_FALSE(root(bilinear_saddle()).signs.any());
  const NormalBounds bowl = root(paraboloid());
  EXPECT_TRUE(bowl.definite);
  EXPECT_NE(bowl.signs.plus, bowl.signs.minus);
  const Scene scene = make_scene(sphere());
  const GaussMap map(scene);
  long definite = 0;
  for (const GaussNode& node : map.nodes(0)) definite += node.bounds.definite;
  EXPECT_GE(definite * 2, long(map.nodes(0).size()));
}

TEST(GaussMap, RuledPatchesAreNotRefined) {
  for (const Shape& shape :
       {cylinder(1, 2), cone(1, 2), frustum(2, 1, 1), box(1, 2, 3), disc(1, 0)}) {
    const Scene scene = make_scene(shape);
    const GaussMap map(scene);
    EXPECT_EQ(map.nodes(0).size(), std::size_t(map.root_count(0)));
    for (int k = 0; k < map.root_count(0); ++k) EXPECT_TRUE(map.ruled(0, k));
  }
  for (const Shape& shape : {sphere(), torus(2, 0.5), saddle(), paraboloid()}) {
    const Scene scene = make_scene(shape);
    const GaussMap map(scene);
    for (int k = 0; k < map.root_count(0); ++k) EXPECT_FALSE(map.ruled(0, k));
  }
}

TEST(GaussMap, DegeneratePatches) {
  Random random(6);
  BezierPatch point{1, 2, std::vector<dvec4>(6, homogeneous({1, 2, 3}))};
  BezierPatch line{2, 2, {}};
  for (int k = 0; k < 9; ++k) line.points.push_back(homogeneous(dvec3(k * k, 0, 0)));
  BezierPatch fold{2, 1, {}};  // there and back: normals of either sign
  for (const double x : {0.0, 1.0, 0.0}) {
    for (const double y : {0.0, 1.0}) fold.points.push_back(homogeneous({x, y, 0}));
  }
  for (const BezierPatch& patch : {point, line, fold}) {
    const Scene scene = make_scene(of_patch(patch) + of_patch(random_patch(random, 2, 2, 1)));
    const GaussMap map(scene);
    // The fold is of two patches.
    const int last = map.root_count(0) - 1;
    for (int k = 0; k < last; ++k) EXPECT_TRUE(map.ruled(0, k));
    EXPECT_FALSE(map.ruled(0, last));
  }
  const Scene curves = make_scene(oloid());
  const GaussMap none(curves);
  EXPECT_EQ(none.root_count(0), 0);
  EXPECT_TRUE(none.entries(0, dvec3(0, 0, 1)).empty());
}

TEST(GaussMap, ScalesTurnsAndThreadsLeaveItAsItIs) {
  const Scene scene = make_scene(teapot());
  const GaussMap map(scene, {.levels = 3, .threads = 1, .progress = {}});
  const auto expect_same = [&](const GaussMap& other, const dmat3& rotation, double tolerance) {
    ASSERT_EQ(map.nodes(0).size(), other.nodes(0).size());
    for (std::size_t k = 0; k < map.nodes(0).size(); ++k) {
      const NormalBounds& a = map.nodes(0)[k].bounds;
      const NormalBounds& b = other.nodes(0)[k].bounds;
      ASSERT_EQ(a.pyramid.has_value(), b.pyramid.has_value());
      ASSERT_EQ(a.definite, b.definite);
      ASSERT_EQ(a.signs.plus, b.signs.plus);
      ASSERT_EQ(a.signs.minus, b.signs.minus);
      if (!a.pyramid) continue;
      ASSERT_LE(glm::distance(rotation * a.pyramid->axis, b.pyramid->axis), tolerance);
    }
  };
  expect_same(GaussMap(scene, {.levels = 3, .threads = 3, .progress = {}}), dmat3(1.0), 0);
  for (const double size : {1e-6, 1e6}) {
    const Scene other = make_scene(scaled(teapot(), size));
    expect_same(GaussMap(other), dmat3(1.0), 1e-9);
  }
  const Scene turned = make_scene(mapped(teapot(), skew_rotation()));
  expect_same(GaussMap(turned), skew_rotation(), 1e-9);
}

TEST(GaussMap, InstancesShareIt) {
  Model model = make_model(sphere());
  model.add_instance(0, {skew_rotation(), {5, 0, 0}});
  const Scene scene(model);
  const GaussMap map(scene);
  const Scene one = make_scene(sphere());
  EXPECT_EQ(map.memory(), GaussMap(one).memory());
}

TEST(GaussMap, RefusesLevels) {
  const Scene scene = make_scene(sphere());
  EXPECT_THROW(GaussMap(scene, {.levels = -1, .threads = 1, .progress = {}}), InvalidInput);
  EXPECT_THROW(GaussMap(scene, {.levels = 9, .threads = 1, .progress = {}}), InvalidInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(GaussMap(scene, {.levels = 1, .threads = 1, .progress = {{}, {}, stop.get_token()}}),
               Cancelled);
}

TEST(DirectionCells, HoldTheirDirections) {
  Random random(4);
  std::set<std::uint32_t> seen;
  for (int k = 0; k < 20000; ++k) {
    const dvec3 n = random_direction(random);
    const int level = k % 4;
    const DirectionCell cell = DirectionCell::of(n, level);
    NormalPyramid pyramid;
    const auto c = cell.corners();
    pyramid.corners = {c[0], c[1], c[3], c[2]};
    const rvec3 side = glm::cross(rvec3(c[0]), rvec3(c[1]));
    const dvec3 middle = c[0] + c[1] + c[2] + c[3];
    if (glm::dot(side, rvec3(middle)) < 0) pyramid.corners = {c[0], c[2], c[3], c[1]};
    pyramid.axis = unit(middle);
    EXPECT_TRUE(pyramid.may_contain(n));
    ASSERT_LE(outside(pyramid, rvec3(n)), 1e-15L);
    if (level == 3) seen.insert(cell.index());
    const DirectionCell parent = DirectionCell::of(n, 0);
    ASSERT_EQ(cell.index() >> (2 * level), parent.index());
  }
  EXPECT_EQ(seen.size(), 6u * 64);
  EXPECT_EQ(*seen.rbegin(), 6u * 64 - 1);
}

TEST(DirectionCells, AreMetByPyramids) {
  Random random(5);
  std::size_t most_of_small = 0;
  for (int k = 0; k < 2000; ++k) {
    const dvec3 axis = random_direction(random);
    const double spread = log_uniform(random, 1e-6, 0.9);
    std::vector<dvec3> vectors;
    for (int i = 0; i < 5; ++i) vectors.push_back(unit(axis + spread * random_direction(random)));
    const auto pyramid = normal_pyramid(vectors, 0);
    if (!pyramid) continue;
    const bool opposite = k % 2 == 1;
    const int level = pick(random, 0, 4);
    std::vector<DirectionCell> cells;
    cells_met(*pyramid, opposite, level, cells);
    std::set<std::uint32_t> indices;
    for (const DirectionCell& cell : cells) EXPECT_TRUE(indices.insert(cell.index()).second);
    for (int i = 0; i < 50; ++i) {
      dvec3 n(0.0);
      for (const dvec3& c : pyramid->corners) n += log_uniform(random, 1e-4, 1) * c;
      const DirectionCell cell = DirectionCell::of(opposite ? -n : n, level);
      ASSERT_TRUE(indices.contains(cell.index())) << spread << " level " << level;
    }
    if (spread < 0.01) most_of_small = std::max(most_of_small, indices.size());
  }
  EXPECT_LE(most_of_small, 4u);
}

}  // namespace
}  // namespace taut
