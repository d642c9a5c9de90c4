#include "taut/hull/stitch/trim_stretches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"
#include "solved_scene.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct StretchScene : SolvedScene {
  using SolvedScene::SolvedScene;

  TrimStretches stretches() { return {geometry, graph, regions, unresolved}; }
};

const TrimStretch& stretch_at(const TrimStretches& all, int k) {
  const TrimStretches::Place& at = all.place(k);
  return all.regions()[to_size(at.region)].loops[at.loop][at.index];
}

/// Of stretches on borders, the way from one of them to the next has no gap.
void expect_goes_on(const TrimStretches& all) {
  for (int k = 0; k < all.count(); ++k) {
    const int next = all.next(k);
    EXPECT_EQ(all.region_of(next), all.region_of(k));
    if (stretch_at(all, k).arc >= 0 || stretch_at(all, next).arc >= 0) continue;
    EXPECT_LT(glm::distance(all.polyline(k).back(), all.polyline(next).front()), 1e-9);
  }
}

/// The sides of a sphere's eight patches meet in pairs, but for eight at the poles.
TEST(TrimStretches, OfASphereAreTwins) {
  StretchScene ball(sphere(1));
  const TrimStretches all = ball.stretches();
  EXPECT_TRUE(ball.unresolved.empty());
  ASSERT_EQ(all.count(), 32);
  expect_goes_on(all);
  int twins = 0;
  for (int k = 0; k < all.count(); ++k) {
    const std::vector<dvec3> points = all.polyline(k);
    ASSERT_EQ(points.size(), std::size_t(border_points + 1));
    for (const dvec3& p : points) {
      EXPECT_NEAR(glm::length(p) / ball.scene.frame().scale, 1, 1e-14);
    }
    EXPECT_EQ(all.source_of(all.region_of(k)), 0);
    if (all.twin(k) < 0) {
      EXPECT_NEAR(std::abs(points[4].z), ball.scene.frame().scale, 1e-14);
      continue;
    }
    ++twins;
    EXPECT_EQ(all.twin(all.twin(k)), k);
    const std::vector<dvec3> other = all.polyline(all.twin(k));
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT(glm::distance(points[i], other[to_size(border_points) - i]), 1e-12);
    }
  }
  EXPECT_EQ(twins, 24);
}

/// Each contact of each piece has its stretch, on the sphere of that contact.
TEST(TrimStretches, OfTwoSpheresLieAlongTheirArcs) {
  StretchScene balls(sphere(1) + mapped(sphere(0.5), skew_rotation(), {0.2, 0.4, 3}));
  const TrimStretches all = balls.stretches();
  EXPECT_TRUE(balls.unresolved.empty());
  ASSERT_EQ(balls.graph.arcs.size(), 1U);
  const SeparatingArc& arc = balls.graph.arcs[0];
  int along = 0;
  for (int p = 0; p < to_int(arc.pieces.size()); ++p) {
    for (const int contact : {0, 1}) {
      ASSERT_EQ(all.along(0, p, contact).size(), 1U);
      const int k = all.along(0, p, contact)[0];
      const TrimStretch& s = stretch_at(all, k);
      EXPECT_TRUE(s.arc == 0 && s.piece == p && s.contact == contact);
      const Ruling& ruling = arc.pieces[to_size(p)].rulings[0];
      const bool upper = balls.scene.frame().to_model(ruling.point[to_size(contact)]).z > 1.5;
      EXPECT_EQ(all.source_of(all.region_of(k)), upper ? 1 : 0);
      ++along;
    }
  }
  int on_arcs = 0;
  for (int k = 0; k < all.count(); ++k) on_arcs += stretch_at(all, k).arc >= 0 ? 1 : 0;
  EXPECT_EQ(on_arcs, along);
  EXPECT_TRUE(all.along(0, to_int(arc.pieces.size()), 0).empty());
}

/// Below a cap's rim two cones, and between them two facets, end in two points on a line parallel
/// to the rim's plane: the cones change where the rim is parallel to the line.
TEST(TrimStretches, AreSplitWhereAnEdgesOtherSideChanges) {
  const double angle = 0.4;
  const dvec3 line(std::cos(angle), std::sin(angle), 0);
  const dvec3 below(0, 0, -1);
  StretchScene cap(spherical_cap(0.6) + Shape{{}, {}, {below + 0.3 * line, below - 0.2 * line}});
  TrimStretches all = cap.stretches();
  EXPECT_TRUE(cap.unresolved.empty());
  expect_goes_on(all);
  std::vector<dvec3> begins;
  for (int k = 0; k < all.count(); ++k) {
    const std::vector<dvec3> points = all.polyline(k);
    const dvec3 begin = cap.scene.frame().to_model(points.front());
    if (std::abs(begin.z - 0.4) > 1e-9) continue;
    if (std::abs(cap.scene.frame().to_model(points[4]).z - 0.4) < 1e-9) begins.push_back(begin);
  }
  // Four quarters, two of which are split.
  EXPECT_EQ(begins.size(), 6U);
  for (const double sense : {1.0, -1.0}) {
    const dvec3 across = std::sqrt(1 - 0.4 * 0.4) * sense * dvec3(-line.y, line.x, 0);
    EXPECT_TRUE(std::any_of(begins.begin(), begins.end(), [&](const dvec3& p) {
      return glm::distance(p, across + dvec3(0, 0, 0.4)) < 1e-6;
    }));
  }
  // The stretches keep what they are told.
  for (int k = 0; k < all.count(); ++k) {
    EXPECT_EQ(all.curve_of(k), -1);
    all.set_curve(k, k);
  }
  const std::vector<TrimRegion> regions = all.take();
  int number = 0;
  for (const TrimRegion& region : regions) {
    for (const TrimStretch& s : region.loops[0]) EXPECT_EQ(s.curve, number++);
  }
}

TEST(TrimStretches, TellJoinsOnWhichPatchesDisagree) {
  StretchScene ball(sphere(1));
  for (TrimStretch& s : ball.regions[0].loops[0]) s.to = 0.5 * s.from + 0.5 * s.to;
  const TrimStretches all = ball.stretches();
  // Three sides of the patch, the fourth is a pole, and those beyond.
  EXPECT_EQ(ball.unresolved.size(), 6U);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(all.twin(k), -1);
}

}  // namespace
}  // namespace taut
