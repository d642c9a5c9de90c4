#include "taut/hull/crease_tracks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct Tracked {
  Scene scene;
  ContactGeometry geometry;
  SupportQuery query;
  SeparatingGraph graph;
  std::vector<Unresolved> unresolved;
  std::vector<TrimRegion> regions;

  explicit Tracked(const Shape& shape) : scene(make_scene(shape)), geometry(scene), query(scene) {
    const GaussMap map(scene, {.threads = 1, .progress = {}});
    const Culling culling = cull(scene, map, {.threads = 1, .progress = {}});
    graph = trace_separating_curves(geometry, query, culling.samples, culling.cells);
    unresolved = graph.unresolved;
    regions = trim_regions(geometry, query, graph, culling.cells, unresolved);
  }

  /// Tracks of arcs name a contact on the edge that passes the stretch the way they say.
  void expect_names_contacts(const CreaseTracks::Stretch& s) const {
    for (const CreaseTracks::Track& t : {s.low, s.high}) {
      if (t.empty()) continue;
      EXPECT_NE(t.arc >= 0, t.region >= 0);
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

TEST(CreaseTracks, TwistedCubic) {
  // The curve is a crease all along, between the cones from its two ends.
  const Tracked cubic({{}, {twisted_cubic()}, {}});
  EXPECT_TRUE(cubic.unresolved.empty());
  const CreaseTracks tracks(cubic.geometry, cubic.graph, cubic.regions);
  const auto stretches = tracks.overlay();
  ASSERT_EQ(stretches.size(), 1U);
  const CreaseTracks::Stretch& s = stretches[0];
  EXPECT_TRUE(s.from == 0 && s.to == 1 && s.piece == 0);
  EXPECT_FALSE(s.low.empty() || s.high.empty());
  EXPECT_TRUE(tracks.breaks(0, 0, false, 0, 1).empty());
  cubic.expect_names_contacts(s);
  // To the left seen from outside along the curve lies the cone from its beginning, which the
  // osculating planes' side tells: b . (apex - x) changes sign between the two ends.
  const auto apex = [&](const CreaseTracks::Track& t) {
    const Ruling& r = cubic.graph.arcs[std::size_t(t.arc)].pieces[std::size_t(t.piece)].rulings[0];
    return r.point[r.contact[0].kind == SourceKind::vertex ? 0 : 1];
  };
  EXPECT_GT(glm::distance(apex(s.low), apex(s.high)), 0.5);
}

TEST(CreaseTracks, OverlayOfRandomCurves) {
  int stretches = 0;
  for (const unsigned seed : {1U, 2U, 4U, 5U}) {
    Random random(400 + seed);
    const Tracked curve({{}, {as_nurbs(random_curve(random, 5, 3))}, {}});
    if (!curve.unresolved.empty()) continue;
    const CreaseTracks tracks(curve.geometry, curve.graph, curve.regions);
    for (const CreaseTracks::Stretch& s : tracks.overlay()) {
      EXPECT_LT(s.from, s.to);
      EXPECT_FALSE(s.low.empty() || s.high.empty());
      curve.expect_names_contacts(s);
      // Where it changes, and nowhere else, other stretches of the piece begin.
      EXPECT_TRUE(tracks.breaks(s.instance, s.piece, false, s.from, s.to).empty());
      ++stretches;
    }
  }
  EXPECT_GT(stretches, 4);
}

TEST(CreaseTracks, BordersOfPatches) {
  // Two bowls that look at each other: their rims are on the hull in part, with the bowl on the
  // one side and the scroll between them on the other.
  const dmat3 over(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const Tracked bowls(spherical_cap(1) + shifted(mapped(spherical_cap(1), over), {0.3, 0.1, -1}));
  EXPECT_TRUE(bowls.unresolved.empty());
  const CreaseTracks tracks(bowls.geometry, bowls.graph, bowls.regions);
  const auto stretches = tracks.overlay();
  EXPECT_GE(stretches.size(), 4U);
  for (const CreaseTracks::Stretch& s : stretches) {
    EXPECT_NE(s.low.arc >= 0, s.high.arc >= 0);
    EXPECT_NE(s.low.region >= 0, s.high.region >= 0);
    bowls.expect_names_contacts(s);
    const auto all = tracks.breaks(s.instance, s.piece, false, 0, 1);
    const auto back = tracks.breaks(s.instance, s.piece, true, 1, 0);
    ASSERT_EQ(all.size(), back.size());
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(all[k], 1 - back[k], 1e-15);
    for (std::size_t k = 0; k + 1 < all.size(); ++k) EXPECT_LT(all[k], all[k + 1]);
  }
}

TEST(CreaseTracks, NothingWithoutEdges) {
  const Tracked ball(sphere(1));
  const CreaseTracks tracks(ball.geometry, ball.graph, ball.regions);
  EXPECT_TRUE(tracks.overlay().empty());
  EXPECT_TRUE(tracks.breaks(0, 0, false, 0, 1).empty());
}

}  // namespace
}  // namespace taut
