#include "taut/bounds/repeated_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "models.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

constexpr double tolerance = 1e-12;

/// Control points (i, j) of a rational patch of degree (2, 3) without any symmetry.
std::vector<dvec4> skew_net() {
  Random random(31);
  return random_patch(random, 2, 3, 5).points;
}

PlacedElement patch_of(int element, const std::vector<dvec4>& points) {
  return {SourceKind::face, 0, element, 2, 3, points};
}

PlacedElement piece_of(int element, const std::vector<dvec4>& points) {
  return {SourceKind::edge, 0, element, int(points.size()) - 1, 0, points};
}

PlacedElement vertex_of(int element, const dvec3& x) {
  return {SourceKind::vertex, 0, element, 0, 0, {homogeneous(x)}};
}

/// The same surface with parameters exchanged, then the first and the second one reversed.
PlacedElement rewritten(const PlacedElement& e, bool swapped, bool reversed_u, bool reversed_v) {
  PlacedElement result = e;
  if (swapped) std::swap(result.degree_u, result.degree_v);
  for (int i = 0; i <= result.degree_u; ++i) {
    for (int j = 0; j <= result.degree_v; ++j) {
      int k = reversed_u ? result.degree_u - i : i;
      int l = reversed_v ? result.degree_v - j : j;
      if (swapped) std::swap(k, l);
      result.points[std::size_t(i * (result.degree_v + 1) + j)] =
          e.points[std::size_t(k * (e.degree_v + 1) + l)];
    }
  }
  return result;
}

dvec3 point_of(const PlacedElement& e, double u, double v) {
  return point(BezierPatch{e.degree_u, e.degree_v, e.points}, u, v);
}

TEST(RepeatedElements, PatchesUpToReversalAndExchange) {
  const PlacedElement first = patch_of(0, skew_net());
  for (unsigned symmetry = 0; symmetry < 8; ++symmetry) {
    SCOPED_TRACE(symmetry);
    PlacedElement other =
        rewritten(first, (symmetry & 4) != 0, (symmetry & 1) != 0, (symmetry & 2) != 0);
    other.instance = 3;
    other.element = 7;
    for (dvec4& p : other.points) p *= 2.5;  // another factor of the weights
    const RepeatedElements same({first, other}, tolerance);
    const Contact c{3, SourceKind::face, 7, 0.3, 0.8};
    EXPECT_TRUE(same.repeats(c));
    EXPECT_FALSE(same.repeats({0, SourceKind::face, 0, 0.3, 0.8}));
    const Contact at = same.first(c);
    EXPECT_TRUE(at.instance == 0 && at.kind == SourceKind::face && at.element == 0);
    EXPECT_LT(glm::distance(point_of(first, at.u, at.v), point_of(other, c.u, c.v)), 1e-14);
  }
}

TEST(RepeatedElements, PiecesUpToReversal) {
  Random random(32);
  const PlacedElement first = piece_of(4, random_curve(random, 3, 5).points);
  for (const bool reversed : {false, true}) {
    PlacedElement other = first;
    other.element = 9;
    if (reversed) std::reverse(other.points.begin(), other.points.end());
    for (dvec4& p : other.points) p *= 0.3;
    const RepeatedElements same({first, other}, tolerance);
    const Contact c{0, SourceKind::edge, 9, 0.3, 0};
    ASSERT_TRUE(same.repeats(c));
    EXPECT_EQ(same.reversed(c), reversed);
    const Contact at = same.first(c);
    EXPECT_EQ(at.element, 4);
    EXPECT_DOUBLE_EQ(at.u, reversed ? 0.7 : 0.3);
    EXPECT_EQ(at.v, 0);
  }
}

/// One number of a copy changed: the same just below the tolerance, different just above it.
TEST(RepeatedElements, ToleranceIsSharp) {
  const std::vector<dvec4> net = skew_net();
  for (std::size_t k = 0; k < net.size(); ++k) {
    for (const double share : {0.9, 1.1}) {
      for (const int axis : {0, 1, 2}) {
        std::vector<dvec4> moved = net;
        moved[k][axis] += 1e-6 * share * net[k].w;
        EXPECT_EQ(RepeatedElements({patch_of(0, net), patch_of(1, moved)}, 1e-6).empty(),
                  share > 1);
      }
      // A weight alone; that of the first point is what the others are compared with.
      std::vector<dvec4> heavier = net;
      heavier[k] *= 1 + 1e-6 * share;
      EXPECT_EQ(RepeatedElements({patch_of(0, net), patch_of(1, heavier)}, 1e-6).empty(),
                share > 1);
    }
  }
}

TEST(RepeatedElements, WhatDiffers) {
  const std::vector<dvec4> net = skew_net();
  Random random(33);
  const std::vector<dvec4> curve = random_curve(random, 2, 1).points;
  struct Case {
    const char* name;
    PlacedElement a, b;
  };
  PlacedElement other_degrees = patch_of(1, net);
  std::swap(other_degrees.degree_u, other_degrees.degree_v);
  PlacedElement loop = piece_of(1, {curve[0], curve[2], curve[1]});
  std::vector<dvec4> elevated = {curve[0], (curve[0] + 2.0 * curve[1]) / 3.0,
                                 (2.0 * curve[1] + curve[2]) / 3.0, curve[2]};
  std::vector<dvec4> broken = curve;
  broken[1].x = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases = {
      {"the same net of other degrees", patch_of(0, net), other_degrees},
      {"the same points in another order", piece_of(0, curve), loop},
      {"a curve of a higher degree", piece_of(0, curve), piece_of(1, elevated)},
      {"a piece and a vertex", piece_of(0, {curve[0]}), vertex_of(1, euclidean(curve[0]))},
      {"no numbers", piece_of(0, broken), piece_of(1, broken)},
      {"vertices apart", vertex_of(0, {1, 2, 3}), vertex_of(1, {1, 2, 3 + 2 * tolerance})},
  };
  for (const Case& each : cases) {
    const RepeatedElements none({each.a, each.b}, tolerance);
    EXPECT_TRUE(none.empty() && none.all().empty()) << each.name;
    EXPECT_FALSE(none.repeats({each.b.instance, each.b.kind, each.b.element, 0, 0}));
    const Contact c{each.b.instance, each.b.kind, each.b.element, 0.25, 0.75};
    const Contact same = none.first(c);
    EXPECT_TRUE(same_element(c, same) && same.u == c.u && same.v == c.v);
  }
}

TEST(RepeatedElements, ManyCopies) {
  // Copies of copies lead to the first one of all, in whatever order they are given.
  const PlacedElement patch = patch_of(0, skew_net());
  std::vector<PlacedElement> all = {patch};
  Random random(34);
  for (int k = 1; k < 20; ++k) {
    PlacedElement copy = rewritten(all[std::size_t(pick(random, 0, k - 1))], false,
                                   pick(random, 0, 1) == 1, pick(random, 0, 1) == 1);
    copy.element = k;
    all.push_back(copy);
  }
  for (int k = 0; k < 20; ++k) all.push_back(vertex_of(k, {0.1 * (k % 5), 0.2, 0.3}));
  const RepeatedElements same(all, tolerance);
  EXPECT_EQ(same.all().size(), 19U + 15U);
  for (int k = 0; k < 20; ++k) {
    const Contact at = same.first({0, SourceKind::face, k, 0.3, 0.8});
    EXPECT_EQ(at.element, 0);
    EXPECT_LT(glm::distance(point_of(patch, at.u, at.v), point_of(all[std::size_t(k)], 0.3, 0.8)),
              1e-13);
    EXPECT_EQ(same.repeats({0, SourceKind::vertex, k, 0, 0}), k >= 5);
    EXPECT_EQ(same.first({0, SourceKind::vertex, k, 0, 0}).element, k % 5);
  }
}

/// Each within the tolerance of the one before it: first() ends at one that repeats no other.
TEST(RepeatedElements, ChainsOfNearlyEqualVertices) {
  std::vector<PlacedElement> chain;
  chain.reserve(10);
  for (int k = 0; k < 10; ++k) {
    const int place = (7 * k) % 10;  // not in the order in which they lie
    chain.push_back(vertex_of(k, {0.7 * tolerance * place, 0, 0}));
  }
  const RepeatedElements same(chain, tolerance);
  EXPECT_FALSE(same.empty());
  for (int k = 0; k < 10; ++k) {
    const Contact c{0, SourceKind::vertex, k, 0, 0};
    const Contact at = same.first(c);
    EXPECT_FALSE(same.repeats(at));
    EXPECT_LE(at.element, k);
    EXPECT_EQ(same_element(at, c), !same.repeats(c));
  }
}

/// @name Shared elements
/// @{

Model in_parts(const std::vector<Shape>& shapes) {
  Model model;
  for (const Shape& shape : shapes) {
    const Model one = make_model(shape);
    model.add_part(one.parts()[0], smooth_join_angle);
  }
  return model;
}

Model placed_twice(const Shape& shape, const dvec3& shift) {
  Model model = make_model(shape);
  model.add_instance(0, {dmat3(1.0), shift});
  return model;
}

using Numbers = std::array<int, 5>;

struct Shared {
  std::array<int, 3> repeated = {0, 0, 0};  ///< faces, edges, vertices
  /// Of elements that repeat none: how many have so many sides, ruled sides and ends.
  Numbers sides{}, ruled{};
  std::array<int, 8> ends{};
};

void expect_at_the_piece(const ContactGeometry& geometry, const Contact& piece,
                         const ContactGeometry::PieceSide& s) {
  for (const double t : {0.0, 0.3, 1.0}) {
    Contact at = piece;
    at.u = t;
    const dvec2 uv = on_side(s.side, s.reversed ? 1 - t : t);
    const Contact on{s.instance < 0 ? piece.instance : s.instance, SourceKind::face, s.patch, uv.x,
                     uv.y};
    EXPECT_LT(glm::distance(geometry.point(at), geometry.point(on)), 1e-12);
    EXPECT_FALSE(geometry.is_repeated(on));
  }
}

Shared shared_elements(Model model) {
  const Scene scene(std::move(model), {.threads = 1, .progress = {}});
  const ContactGeometry geometry(scene);
  Shared result;
  const auto check = [&](const Contact& c) {
    const Contact first = geometry.first(c);
    EXPECT_LT(glm::distance(geometry.point(first), geometry.point(c)), 2 * support_tie);
    EXPECT_FALSE(geometry.is_repeated(first));
    EXPECT_EQ(same_element(first, c), !geometry.is_repeated(c));
    EXPECT_FALSE(geometry.is_repeated(geometry.canonical(c)));
    result.repeated[std::size_t(c.kind)] += geometry.is_repeated(c) ? 1 : 0;
    return !geometry.is_repeated(c);
  };
  for (int i = 0; i < int(scene.model().instances().size()); ++i) {
    const Part& part = geometry.part({i, SourceKind::face, 0, 0, 0});
    for (int p = 0; p < int(part.patches().size()); ++p) check({i, SourceKind::face, p, 0.3, 0.6});
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      const Contact c{i, SourceKind::edge, p, 0.3, 0};
      if (!check(c)) continue;
      ++result.sides.at(geometry.sides(c).size());
      ++result.ruled.at(geometry.ruled_sides(c).size());
      for (const auto& s : geometry.sides(c)) expect_at_the_piece(geometry, c, s);
      for (const auto& s : geometry.ruled_sides(c)) expect_at_the_piece(geometry, c, s);
    }
    for (int k = 0; k < int(part.vertices().size()); ++k) {
      const Contact c{i, SourceKind::vertex, k, 0, 0};
      if (!check(c)) continue;
      ++result.ends.at(geometry.ends(c).size());
      for (const ContactGeometry::PieceEnd& e : geometry.ends(c)) {
        const Contact at{e.instance < 0 ? i : e.instance, SourceKind::edge, e.piece, double(e.end),
                         0};
        EXPECT_LT(glm::distance(geometry.point(at), geometry.point(c)), 1e-12);
        EXPECT_FALSE(geometry.is_repeated(at));
      }
    }
  }
  return result;
}

TEST(SharedElements, OfSolidsThatTouch) {
  const dmat3 over(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const Shape cap = spherical_cap(0.6);
  const Shape lid = disc(std::sqrt(1 - 0.4 * 0.4), 0.4);
  const Shape lid_over = shifted(mapped(lid, over), {0, 0, 0.8});
  const Shape block = box(1, 1, 1);
  const Shape can = solid_cylinder(1, 2);
  struct Case {
    const char* name;
    Model model;
    std::array<int, 3> repeated;
    Numbers sides, ruled;
    std::array<int, 8> ends;
  };
  const std::vector<Case> cases = {
      // A disc of four patches with its rim; that has two lateral faces and one disc.
      {"stacked cylinders", placed_twice(can, {0, 0, 2}), {4, 4, 0}, {12}, {0, 0, 8, 4}, {}},
      // A face with four edges and corners; to each of these a third face or a fourth edge.
      {"boxes side by side",
       placed_twice(block, {1, 0, 0}),
       {1, 4, 4},
       {20},
       {0, 0, 16, 4},
       {0, 0, 0, 8, 4}},
      {"boxes in two parts",
       in_parts({block, shifted(block, {0, 1, 0})}),
       {1, 4, 4},
       {20},
       {0, 0, 16, 4},
       {0, 0, 0, 8, 4}},
      // One edge: four faces meet in it, and in its ends five edges.
      {"boxes that share an edge",
       placed_twice(block, {1, 1, 0}),
       {0, 1, 2},
       {23},
       {0, 0, 22, 0, 1},
       {0, 0, 0, 12, 0, 2}},
      {"boxes that share a corner",
       placed_twice(block, {1, 1, 1}),
       {0, 0, 1},
       {24},
       {0, 0, 24},
       {0, 0, 0, 14, 0, 0, 1}},
      {"boxes that do not touch",
       placed_twice(block, {1 + 1e-9, 0, 0}),
       {0, 0, 0},
       {24},
       {0, 0, 24},
       {0, 0, 0, 16}},
      {"two instances in one place",
       placed_twice(block, {0, 0, 0}),
       {6, 12, 8},
       {12},
       {0, 0, 12},
       {0, 0, 0, 8}},
      {"a cap and its lid in two parts", in_parts({cap, lid}), {0, 4, 0}, {0, 4}, {0, 4}, {}},
      {"the lid the other way round", in_parts({cap, lid_over}), {0, 4, 0}, {0, 4}, {0, 4}, {}},
      {"the lid first", in_parts({lid_over, cap}), {0, 4, 0}, {0, 4}, {0, 4}, {}},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    const Shared is = shared_elements(each.model);
    EXPECT_EQ(is.repeated, each.repeated);
    EXPECT_EQ(is.sides, each.sides);
    EXPECT_EQ(is.ruled, each.ruled);
    EXPECT_EQ(is.ends, each.ends);
  }
}

/// Where instances are turned, elements agree up to rounding only.
TEST(SharedElements, OfTurnedInstances) {
  Random random(35);
  for (int k = 0; k < 20; ++k) {
    const dmat3 turn = random_rotation(random);
    Model model = make_model(box(1, 1, 1));
    model.clear_instances();
    const dvec3 shift = random_point(random);
    model.add_instance(0, {turn, shift});
    // A quarter turn about its own axis, then beside the other.
    const dmat3 quarter(0, 1, 0, -1, 0, 0, 0, 0, 1);
    model.add_instance(0, {turn * quarter, turn * dvec3(2, 0, 0) + shift});
    const Shared is = shared_elements(std::move(model));
    EXPECT_EQ(is.repeated, (std::array<int, 3>{1, 4, 4}));
    EXPECT_EQ(is.ruled, (Numbers{0, 0, 16, 4}));
  }
}

/// A contact on a border that is shared is told as one of the first instance's edge.
TEST(SharedElements, CanonicalContactsAreThoseOfTheFirst) {
  const Scene scene(placed_twice(box(1, 1, 1), {1, 0, 0}), {.threads = 1, .progress = {}});
  const ContactGeometry geometry(scene);
  const Part& part = scene.model().parts()[0];
  int shared = 0;
  for (int p = 0; p < int(part.patches().size()); ++p) {
    for (const dvec2 uv : {dvec2(0, 0.3), dvec2(1, 0.3), dvec2(0.3, 0), dvec2(0.3, 1), dvec2(0, 0),
                           dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)}) {
      const Contact c{1, SourceKind::face, p, uv.x, uv.y};
      const Contact at = geometry.canonical(c);
      EXPECT_NE(at.kind, SourceKind::face);
      EXPECT_LT(glm::distance(geometry.point(at), geometry.point(c)), 1e-15);
      const bool between = scene.point(c).x == 1;
      EXPECT_EQ(at.instance, between ? 0 : 1);
      shared += between ? 1 : 0;
    }
  }
  EXPECT_EQ(shared, 8 + 4 * 3);  // of the face itself, and of the four beside it
}
/// @}

}  // namespace
}  // namespace taut
