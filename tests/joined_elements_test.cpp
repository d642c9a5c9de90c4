#include "taut/hull/contact/joined_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// An eighth of an ellipsoid: quarter i of the turn about z, and half j of it, the upper first.
/// Patch 2 i + j, whose u runs with the turn and whose v runs down.
struct Eighth {
  int quarter, half;
  explicit Eighth(int patch) : quarter(patch / 2), half(patch % 2) {}
  bool is_beside(const Eighth& other) const { return (quarter - other.quarter + 4) % 4 != 2; }
};

/// The eighths that have the point, which lies at a multiple of 1/2 of either parameter, no pole.
std::set<int> eighths_at(const Contact& c) {
  std::set<int> result;
  const Eighth own(c.element);
  for (int k = 0; k < 8; ++k) {
    const Eighth other(k);
    const int to = (other.quarter - own.quarter + 4) % 4;
    const bool turned = to == 0 || (to == 1 && c.u == 1) || (to == 3 && c.u == 0);
    const bool lowered = other.half == own.half || c.v == (own.half == 0 ? 1 : 0);
    if (turned && lowered) result.insert(k);
  }
  return result;
}

Shape turned_ellipsoid() { return mapped(ellipsoid(3, 2, 1), skew_rotation()); }

std::vector<Contact> places_of_eighths() {
  std::vector<Contact> result;
  for (int patch = 0; patch < 8; ++patch) {
    const double equator = patch % 2 == 0 ? 1 : 0;
    for (const double u : {0.0, 0.5, 1.0}) {
      for (const double v : {0.5, equator}) result.push_back({0, SourceKind::face, patch, u, v});
    }
  }
  return result;
}

/// One inside, two on borders, four at corners; in all others a point has no place.
TEST(JoinedElements, OfPointsOfAnEllipsoid) {
  const Scene scene = make_scene(turned_ellipsoid());
  const ContactGeometry geometry(scene);
  for (const Contact& c : places_of_eighths()) {
    const std::set<int> expected = eighths_at(c);
    std::set<int> elements;
    for (const Contact& at : about(geometry, c)) {
      EXPECT_TRUE(elements.insert(at.element).second);
      EXPECT_LT(glm::distance(geometry.point(at), geometry.point(c)), 1e-14);
    }
    EXPECT_EQ(elements, expected) << c.element << ' ' << c.u << ' ' << c.v;
    for (int k = 0; k < 8; ++k) {
      const auto own = expressed_in(geometry, c, {0, SourceKind::face, k, 0.4, 0.7});
      ASSERT_EQ(own.has_value(), expected.count(k) == 1) << c.element << ' ' << k;
      if (!own) continue;
      EXPECT_EQ(own->element, k);
      EXPECT_LT(glm::distance(geometry.point(*own), geometry.point(c)), 1e-14);
      EXPECT_FALSE(expressed_in(geometry, c, {1, SourceKind::face, k, 0.4, 0.7}));
    }
  }
}

/// A graph's corners and borders lie in its one patch at the parameters of their x and y.
TEST(JoinedElements, VerticesAndEdgesExpressedInAPatch) {
  const Scene scene = make_scene(paraboloid());
  const ContactGeometry geometry(scene);
  const Contact patch{0, SourceKind::face, 0, 0.3, 0.6};
  const auto expect_place = [&](const Contact& c) {
    const std::optional<Contact> own = expressed_in(geometry, c, patch);
    ASSERT_TRUE(own);
    const dvec3 x = scene.frame().to_model(geometry.point(c));
    EXPECT_NEAR(own->u, 0.5 * (x.x + 1), 1e-15);
    EXPECT_NEAR(own->v, 0.5 * (x.y + 1), 1e-15);
  };
  for (int k = 0; k < 4; ++k) {
    expect_place({0, SourceKind::vertex, k, 0, 0});
    for (const double t : {0.0, 0.3, 1.0}) expect_place({0, SourceKind::edge, k, t, 0});
  }
}

/// Eighths go on into those beside them and, at corners, across them; but about poles there is no
/// corner.
TEST(JoinedElements, ContinueOnOneSmoothSurface) {
  const Scene smooth = make_scene(turned_ellipsoid());
  const ContactGeometry geometry(smooth);
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) {
      const Contact from{0, SourceKind::face, a, 0.3, 0.4};
      const Contact to{0, SourceKind::face, b, 0.6, 0.2};
      EXPECT_EQ(continues(geometry, from, to), Eighth(a).is_beside(Eighth(b))) << a << ' ' << b;
      EXPECT_FALSE(continues(geometry, from, {1, SourceKind::face, b, 0.6, 0.2}));
    }
  }
  // The cap's patches meet in one another, but none goes on over the rim into the lid.
  const Scene dome = make_scene(spherical_cap(0.6) + disc(std::sqrt(1 - 0.4 * 0.4), 0.4));
  const ContactGeometry creased(dome);
  for (int a = 0; a < 4; ++a) {
    for (const Contact& at : about(creased, {0, SourceKind::face, a, 1, 1})) {
      EXPECT_TRUE(at.kind == SourceKind::face && at.element < 4);
    }
    for (int b = 0; b < 4; ++b) {
      const Contact cap{0, SourceKind::face, a, 0.3, 0.4};
      EXPECT_EQ(continues(creased, cap, {0, SourceKind::face, b, 0.3, 0.4}), (a - b + 4) % 4 != 2);
      EXPECT_FALSE(continues(creased, cap, {0, SourceKind::face, 4 + b, 0.3, 0.4}));
    }
  }
}

/// The pieces of a circle go on into the next ones, those of a bent line do not.
TEST(JoinedElements, ContinueOnOneSmoothCurve) {
  const Scene scene = make_scene({{},
                                  {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                   segment({2, 0, 0}, {3, 0, 0}), segment({3, 0, 0}, {3, 1, 0})},
                                  {}});
  const ContactGeometry geometry(scene);
  const auto on = [](int piece) { return Contact{0, SourceKind::edge, piece, 0.4, 0}; };
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 6; ++b) {
      EXPECT_EQ(continues(geometry, on(a), on(b)), b < 4 && (a - b + 4) % 4 != 2) << a << ' ' << b;
    }
  }
  EXPECT_FALSE(continues(geometry, on(4), on(5)));
  const Contact vertex{0, SourceKind::vertex, 0, 0, 0};
  EXPECT_FALSE(continues(geometry, vertex, vertex));
}

/// Onto the planes x = 0, y = 0 or z = 0 between eighths, and onto an axis between those across a
/// corner.
TEST(JoinedElements, MoveTogetherOntoPlanesOfSymmetry) {
  const dmat3 turn = skew_rotation();
  const Scene scene = make_scene(turned_ellipsoid());
  const ContactGeometry geometry(scene);
  Random random(3);
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) {
      const Contact from{0, SourceKind::face, a, uniform(random, 0.1, 0.9), 0.4};
      const Contact to{0, SourceKind::face, b, uniform(random, 0.1, 0.9), 0.2};
      Contact first = from;
      Contact second = to;
      move_together(geometry, first, second);
      EXPECT_TRUE(same_element(first, from) && same_element(second, to));
      const Eighth one(a);
      const Eighth other(b);
      if (a == b || !one.is_beside(other)) {
        EXPECT_TRUE(parameters(first) == parameters(from) && parameters(second) == parameters(to));
        continue;
      }
      EXPECT_LT(glm::distance(geometry.point(first), geometry.point(second)), 1e-14);
      const dvec3 x = glm::transpose(turn) * scene.point(first);
      if (one.half != other.half) {
        EXPECT_NEAR(x.z, 0, 1e-14);
      }
      if (one.quarter != other.quarter) {
        const bool forth = (other.quarter - one.quarter + 4) % 4 == 1;
        const int between = forth ? other.quarter : one.quarter;
        EXPECT_NEAR(between % 2 == 0 ? x.y : x.x, 0, 1e-14);
        EXPECT_GT((between % 2 == 0 ? x.x : x.y) * (between < 2 ? 1 : -1), 0);
      }
    }
  }
}

TEST(JoinedElements, MoveTogetherOntoAVertex) {
  const Scene scene = make_scene({{}, {segment({0, 0, 0}, {1, 2, 3}), twisted_cubic()}, {}});
  const ContactGeometry geometry(scene);
  for (const bool swapped : {false, true}) {
    Contact a{0, SourceKind::edge, swapped ? 1 : 0, 0.2, 0};
    Contact b{0, SourceKind::edge, swapped ? 0 : 1, 0.1, 0};
    move_together(geometry, a, b);
    EXPECT_EQ(a.element, swapped ? 1 : 0);
    EXPECT_EQ(scene.point(a), dvec3(0.0));
    EXPECT_EQ(scene.point(b), dvec3(0.0));
  }
}

}  // namespace
}  // namespace taut
