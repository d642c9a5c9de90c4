#include "taut/hull/mesh/constrained_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "boundaries.h"
#include "models.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// The scroll about spheres of radius 1 and 1/2, at z = 0 and 3: the normals of its rulings have
/// z = 1/6, and its four pieces turn by pi / 2 in sixteen intervals each.
struct ScrollChords {
  KnownBoundary known = two_spheres_boundary();
  ContactGeometry geometry{known.scene};
  ContactFaces faces{geometry, known.boundary};

  ArcPlace place(int piece, int ruling) const {
    const ArcPiece& own = known.boundary.arcs[0].pieces[to_size(piece)];
    return {0, piece, own.rulings[to_size(ruling)]};
  }
  ConstrainedEdges edges(const std::vector<CurveChord>& chords, double least) const {
    return {geometry, known.boundary, faces, chords, {least, least}};
  }
};

/// The point of the scroll's circle on one of the spheres at an angle, in parts of a quarter.
void expect_on_circle(const EdgeConstraints::Middle& middle, int sphere, double quarters) {
  const double c = std::sqrt(1 - 1.0 / 36);
  const double angle = quarters * pi / 2;
  const dvec3 n(c * std::cos(angle), c * std::sin(angle), 1.0 / 6);
  EXPECT_LT(glm::distance(middle.sample.n, n), 1e-12);
  const dvec3 x = sphere == 0 ? n : 0.5 * n + dvec3(0, 0, 3);
  EXPECT_LT(glm::distance(middle.point, x), 1e-12);
}

/// Between two rulings next to each other the middle is where half of the angle is turned.
TEST(ConstrainedEdges, MiddlesHalveTheAngle) {
  const ScrollChords scroll;
  for (const int sphere : {0, 1}) {
    ConstrainedEdges edges =
        scroll.edges({{7, 3, sphere, scroll.place(1, 4), scroll.place(1, 5)}}, 1e-6);
    ASSERT_TRUE(edges.middle(7, 3));
    ASSERT_TRUE(edges.middle(3, 7));
    expect_on_circle(*edges.middle(3, 7), sphere, 1 + 4.5 / 16);
    edges.bisect(3, 7, 9);
    EXPECT_FALSE(edges.middle(7, 3));
    ASSERT_TRUE(edges.middle(7, 9));
    expect_on_circle(*edges.middle(7, 9), sphere, 1 + 4.25 / 16);
    ASSERT_TRUE(edges.middle(9, 3));
    expect_on_circle(*edges.middle(9, 3), sphere, 1 + 4.75 / 16);
    // It touches its sphere's patch and the scroll.
    ASSERT_EQ(edges.inserted().size(), 1U);
    const TouchedFaces& touched = edges.inserted().at(9);
    ASSERT_EQ(touched.size(), 2U);
    EXPECT_EQ(touched[0].face, sphere);
    EXPECT_EQ(touched[1].face, 2);
    EXPECT_EQ(touched[1].sides, 1U << sphere);
  }
}

/// A chord over the end of a piece is bisected there, unless it begins or ends there.
TEST(ConstrainedEdges, PiecesEndInMiddles) {
  const ScrollChords scroll;
  ConstrainedEdges over = scroll.edges({{0, 1, 0, scroll.place(0, 15), scroll.place(1, 2)}}, 1e-6);
  ASSERT_TRUE(over.middle(0, 1));
  expect_on_circle(*over.middle(0, 1), 0, 1);
  over.bisect(0, 1, 2);
  const auto quarters = [&](int a, int b) {
    const dvec3 n = over.middle(a, b).value().sample.n;
    return std::atan2(n.y, n.x) / (pi / 2);
  };
  EXPECT_GT(quarters(0, 2), 15.0 / 16);
  EXPECT_LT(quarters(0, 2), 1);
  EXPECT_GT(quarters(2, 1), 1);
  EXPECT_LT(quarters(2, 1), 1 + 2.0 / 16);
}

/// Of several ends of pieces it is the one nearest to the middle.
TEST(ConstrainedEdges, PiecesEndNearMiddles) {
  const ScrollChords scroll;
  const ConstrainedEdges later =
      scroll.edges({{0, 1, 0, scroll.place(0, 4), scroll.place(2, 15)}}, 1e-6);
  ASSERT_TRUE(later.middle(0, 1));
  expect_on_circle(*later.middle(0, 1), 0, 2);
  const ConstrainedEdges earlier =
      scroll.edges({{0, 1, 1, scroll.place(0, 1), scroll.place(2, 12)}}, 1e-6);
  ASSERT_TRUE(earlier.middle(0, 1));
  expect_on_circle(*earlier.middle(0, 1), 1, 1);
}

/// At the end of a piece other curves may begin: of chords from there parts are as long as a power
/// of two, in the root of the second fundamental form.
TEST(ConstrainedEdges, FromEndsLengthsArePowersOfTwo) {
  const ScrollChords scroll;
  const double c = std::sqrt(1 - 1.0 / 36);
  for (const int sphere : {0, 1}) {
    const double radius = sphere == 0 ? 1 : 0.5;
    const dvec3 n(0, c, 1.0 / 6);  // where the second piece begins
    const double scale = scroll.known.scene.frame().scale;
    for (const auto& [from, to] : {std::pair(scroll.place(0, 16), scroll.place(1, 1)),
                                   std::pair(scroll.place(0, 15), scroll.place(1, 0))}) {
      const ConstrainedEdges edges = scroll.edges({{0, 1, sphere, from, to}}, 1e-6);
      const std::optional<EdgeConstraints::Middle> middle = edges.middle(0, 1);
      ASSERT_TRUE(middle);
      const dvec3 m = middle->sample.n;
      EXPECT_NEAR(m.z, 1.0 / 6, 1e-12);
      EXPECT_LT(glm::distance(middle->point, radius * m + dvec3(0, 0, 3 * sphere)), 1e-12);
      const double turned = glm::distance(m, n) / (2 * c * std::sin(pi / 64));
      EXPECT_GT(turned, 0.3);
      EXPECT_LT(turned, 0.75);
      const double power = std::log2(std::sqrt(radius * scale) * glm::distance(m, n));
      EXPECT_NEAR(power, std::round(power), 1e-6);
    }
  }
}

/// Lengths are model units, and the scene's frame has others.
TEST(ConstrainedEdges, NeitherShortChordsNorOthersHaveMiddles) {
  const ScrollChords scroll;
  ASSERT_NE(scroll.known.scene.frame().scale, 1);
  const std::vector<CurveChord> chords = {{0, 1, 0, scroll.place(2, 8), scroll.place(2, 9)}};
  const double length = 2 * std::sqrt(1 - 1.0 / 36) * std::sin(pi / 64);
  EXPECT_TRUE(scroll.edges(chords, 0.999 * length).middle(0, 1));
  EXPECT_FALSE(scroll.edges(chords, 1.001 * length).middle(0, 1));
  EXPECT_FALSE(scroll.edges(chords, 0).middle(0, 2));
  EXPECT_FALSE(scroll.edges({}, 0).middle(0, 1));
}

}  // namespace
}  // namespace taut
