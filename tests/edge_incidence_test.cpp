#include "taut/hull/stitch/edge_incidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "models.h"
#include "solved_scene.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct EdgeScene : SolvedScene {
  using SolvedScene::SolvedScene;

  /// Neighbours on arcs name a contact on the edge that passes the stretch the way they say.
  void expect_names_contacts(const EdgeIncidence::Stretch& s) const {
    for (const EdgeIncidence::Neighbor& t : {s.low, s.high}) {
      if (t.empty()) continue;
      EXPECT_EQ((t.arc >= 0 ? 1 : 0) + (t.region >= 0 ? 1 : 0) + (t.node >= 0 ? 1 : 0), 1);
      if (t.arc < 0) continue;
      ASSERT_TRUE(t.contact == 0 || t.contact == 1);
      const auto& rulings = graph.arcs[std::size_t(t.arc)].pieces[std::size_t(t.piece)].rulings;
      const auto contact = [&](const Ruling& r) { return r.contact[std::size_t(t.contact)]; };
      const Contact on{s.instance, SourceKind::edge, s.piece, 0, 0};
      EXPECT_TRUE(same_element(contact(rulings.front()), on));
      EXPECT_NE(t.sense, 0);
      double low = 1;
      double high = 0;
      for (std::size_t k = 0; k < rulings.size(); ++k) {
        low = std::min(low, contact(rulings[k]).u);
        high = std::max(high, contact(rulings[k]).u);
        if (k + 1 == rulings.size()) continue;
        const double middle = 0.5 * (contact(rulings[k]).u + contact(rulings[k + 1]).u);
        if (middle < s.from || middle > s.to) continue;
        EXPECT_GT((contact(rulings[k + 1]).u - contact(rulings[k]).u) * t.sense, 0);
      }
      EXPECT_LE(low, s.from + 1e-6);
      EXPECT_GE(high, s.to - 1e-6);
    }
  }
};

TEST(EdgeIncidence, TwistedCubic) {
  // The curve is a crease all along, between the cones from its two ends.
  const EdgeScene cubic({{}, {twisted_cubic()}, {}});
  EXPECT_TRUE(cubic.unresolved.empty());
  const EdgeIncidence incidence(cubic.geometry, cubic.graph, cubic.regions);
  const auto stretches = incidence.overlay();
  ASSERT_EQ(stretches.size(), 1U);
  const EdgeIncidence::Stretch& s = stretches[0];
  EXPECT_TRUE(s.from == 0 && s.to == 1 && s.piece == 0);
  EXPECT_FALSE(s.low.empty() || s.high.empty());
  EXPECT_TRUE(incidence.breaks(0, 0, false, 0, 1).empty());
  cubic.expect_names_contacts(s);
  // To the left seen from outside along the curve lies the cone from its beginning, which the
  // osculating planes' side tells: b . (apex - x) changes sign between the two ends.
  const auto apex = [&](const EdgeIncidence::Neighbor& t) {
    const Ruling& r = cubic.graph.arcs[std::size_t(t.arc)].pieces[std::size_t(t.piece)].rulings[0];
    return r.point[r.contact[0].kind == SourceKind::vertex ? 0 : 1];
  };
  EXPECT_GT(glm::distance(apex(s.low), apex(s.high)), 0.5);
}

TEST(EdgeIncidence, OverlayOfRandomCurves) {
  int stretches = 0;
  for (const unsigned seed : {1U, 2U, 4U, 5U}) {
    Random random(400 + seed);
    const EdgeScene curve({{}, {as_nurbs(random_curve(random, 5, 3))}, {}});
    if (!curve.unresolved.empty()) continue;
    const EdgeIncidence incidence(curve.geometry, curve.graph, curve.regions);
    for (const EdgeIncidence::Stretch& s : incidence.overlay()) {
      EXPECT_LT(s.from, s.to);
      EXPECT_FALSE(s.low.empty() || s.high.empty());
      curve.expect_names_contacts(s);
      // Where it changes, and nowhere else, other stretches of the piece begin.
      EXPECT_TRUE(incidence.breaks(s.instance, s.piece, false, s.from, s.to).empty());
      ++stretches;
    }
  }
  EXPECT_GT(stretches, 4);
}

TEST(EdgeIncidence, BordersOfPatches) {
  // Two bowls that look at each other: their rims are on the hull in part, with the bowl on the
  // one side and the scroll between them on the other.
  const dmat3 over(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const EdgeScene bowls(spherical_cap(1) + shifted(mapped(spherical_cap(1), over), {0.3, 0.1, -1}));
  EXPECT_TRUE(bowls.unresolved.empty());
  const EdgeIncidence incidence(bowls.geometry, bowls.graph, bowls.regions);
  const auto stretches = incidence.overlay();
  EXPECT_GE(stretches.size(), 4U);
  for (const EdgeIncidence::Stretch& s : stretches) {
    EXPECT_NE(s.low.arc >= 0, s.high.arc >= 0);
    EXPECT_NE(s.low.region >= 0, s.high.region >= 0);
    bowls.expect_names_contacts(s);
    const auto all = incidence.breaks(s.instance, s.piece, false, 0, 1);
    const auto back = incidence.breaks(s.instance, s.piece, true, 1, 0);
    ASSERT_EQ(all.size(), back.size());
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(all[k], 1 - back[k], 1e-15);
    for (std::size_t k = 0; k + 1 < all.size(); ++k) EXPECT_LT(all[k], all[k + 1]);
  }
}

/// What lies beside edges, by its kind.
enum class Beside { nothing, scroll, patch, facet };

Beside kind_of(const EdgeIncidence::Neighbor& t) {
  if (t.arc >= 0) return Beside::scroll;
  if (t.region >= 0) return Beside::patch;
  return t.node >= 0 ? Beside::facet : Beside::nothing;
}

struct FacetCase {
  const char* name;
  Shape shape;
  Beside other;  ///< what lies on the facets' other side
  double length;
};

/// Facets are neighbours of the edges that they have for sides, and lie to their left.
TEST(EdgeIncidence, FacetsWithCurvedSides) {
  const std::vector<FacetCase> cases = {
      {"cylinder", cylinder(1, 2), Beside::scroll, 4 * pi},
      {"solid cone", solid_cone(1, 2), Beside::scroll, 2 * pi},
      {"cap", spherical_cap(0.6), Beside::patch, 2 * pi * std::sqrt(1 - 0.4 * 0.4)},
      {"torus", torus(2, 0.5), Beside::patch, 2 * 4 * pi},
      {"paraboloid", paraboloid(), Beside::patch, 4 * (std::sqrt(5.0) + 0.5 * std::asinh(2.0))},
      {"a circle and a point beside it",
       {{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {{2, 0, 0}, {0.5, 0, -2}}},
       Beside::scroll,
       2 * pi - 2 * pi / 3},
  };
  for (const FacetCase& each : cases) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      SCOPED_TRACE(each.name);
      const EdgeScene scene(mapped(each.shape, turn));
      EXPECT_TRUE(scene.unresolved.empty());
      const EdgeIncidence incidence(scene.geometry, scene.graph, scene.regions);
      double length = 0;
      for (const EdgeIncidence::Stretch& s : incidence.overlay()) {
        scene.expect_names_contacts(s);
        if (s.low.node < 0 && s.high.node < 0) continue;
        const bool low = s.low.node >= 0;
        EXPECT_EQ(kind_of(low ? s.high : s.low), each.other);
        // Seen from outside the facet lies to the left of its sides, along the parameter or back.
        const FacetNode& node = scene.graph.nodes[std::size_t((low ? s.low : s.high).node)];
        const auto jet_at = [&](double t) {
          return scene.geometry.jet({s.instance, SourceKind::edge, s.piece, t, 0});
        };
        dvec3 middle(0.0);
        for (const dvec3& x : node.points) middle += x / double(node.points.size());
        const ContactJet j = jet_at(0.5 * (s.from + s.to));
        const double left = glm::dot(glm::cross(node.n, j.dx[0]), middle - j.x);
        EXPECT_EQ(left > 0, low);
        // Simpson's rule on the speed.
        constexpr int steps = 64;
        for (int k = 0; k <= steps; ++k) {
          const double weight = k == 0 || k == steps ? 1 : k % 2 == 1 ? 4 : 2;
          const double speed = glm::length(jet_at(s.from + (s.to - s.from) * k / steps).dx[0]);
          length += weight * speed * (s.to - s.from) / (3 * steps);
        }
      }
      EXPECT_NEAR(length / scene.scene.frame().scale, each.length, 1e-6);
    }
  }
}

TEST(EdgeIncidence, NothingWithoutEdges) {
  const EdgeScene ball(sphere(1));
  const EdgeIncidence incidence(ball.geometry, ball.graph, ball.regions);
  EXPECT_TRUE(incidence.overlay().empty());
  EXPECT_TRUE(incidence.breaks(0, 0, false, 0, 1).empty());
}

}  // namespace
}  // namespace taut
