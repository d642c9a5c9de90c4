#include "taut/hull/measure/ruling_ways.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "judge/families.h"
#include "models.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Hull solved(const Scene& scene) {
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  try {
    return convex_hull(scene, options);
  } catch (const HullNotConverged& stopped) {
    return *stopped.best;
  }
}

class RoundedMeasures : public testing::TestWithParam<const char*> {};

/// What rounding moves the model by is within the resolution; by no more do its measures differ
/// from the drawn one's than their bounds allow, and these are not large.
TEST_P(RoundedMeasures, AreThoseOfTheModelWithinTheirBounds) {
  const Scene drawn = scene_of(GetParam(), Variant::clean);
  const Hull clean = solved(drawn);
  const BoundaryMeasures truth = measure(drawn, ContactGeometry(drawn), *clean.boundary);
  for (const Variant variant : {Variant::turned, Variant::float32, Variant::decimals}) {
    const Scene scene = scene_of(GetParam(), variant);
    const Hull hull = solved(scene);
    const BoundaryMeasures m = measure(scene, ContactGeometry(scene), *hull.boundary);
    EXPECT_LE(std::abs(m.volume / truth.volume - 1), m.bounds.volume) << name_of(variant);
    EXPECT_LE(std::abs(m.area / truth.area - 1), m.bounds.area) << name_of(variant);
    EXPECT_LE(std::abs(m.mean_width / truth.mean_width - 1), m.bounds.mean_width)
        << name_of(variant);
    EXPECT_LE(m.bounds.largest(), 1e-5) << name_of(variant);
    const Measures mesh = measure(polygons(hull.mesh));
    EXPECT_LE(mesh.volume, m.volume * (1 + m.bounds.volume)) << name_of(variant);
    EXPECT_LE(mesh.area, m.area * (1 + m.bounds.area)) << name_of(variant);
  }
}

INSTANTIATE_TEST_SUITE_P(Natural, RoundedMeasures,
                         testing::Values("gear", "bracket", "rounded_box", "filleted_plate"),
                         [](const auto& info) { return std::string(info.param); });

/// A contact passes close by a pole, between rulings that are far from each other.
TEST(RulingWays, LeadPastPoles) {
  const Scene drawn = scene_of("overlapping_balls", Variant::clean);
  const BoundaryMeasures truth = measure(drawn, ContactGeometry(drawn), *solved(drawn).boundary);
  const Scene scene = scene_of("overlapping_balls", Variant::turned);
  const BoundaryMeasures m = measure(scene, ContactGeometry(scene), *solved(scene).boundary);
  EXPECT_NEAR(m.volume / truth.volume, 1, 1e-9);
  EXPECT_NEAR(m.mean_width / truth.mean_width, 1, 1e-9);
}

TEST(RulingWays, LeadFromTheOneToTheOther) {
  const Ruling from{{0, 0, 1}, {}, {dvec3(0.0), dvec3(1, 0, 0)}};
  const Ruling to{{0, 0.6, 0.8}, {}, {dvec3(0.0), dvec3(1, 2, 0)}};
  const auto missed = [&](const dvec3& first, const dvec3& second) {
    return missed_way({first, second}, from, to);
  };
  EXPECT_EQ(missed(dvec3(0.0), dvec3(0, 2, 0)), 0);
  EXPECT_NEAR(missed(dvec3(0, 3, 4), dvec3(0, 2, 1)), 6, 1e-15);
  EXPECT_EQ(missed(dvec3(0.0), dvec3(0, std::nan(""), 0)), infinity);
  EXPECT_TRUE(leads(missed(dvec3(0.0), dvec3(0, 2, 1e-11))));
  EXPECT_FALSE(leads(missed(dvec3(0, 1e-9, 0), dvec3(0, 2, 0))));
  RulingWay way{from, to, false, 0.25};
  const double turn = std::sqrt(0.4);
  EXPECT_NEAR(way.uncertainty(), 0.5 * turn * (0.25 + turn * 2 / 8), 1e-15);
}

/// Contacts of a straight way lie on their elements.
TEST(RulingWays, StraightOnesStayOnTheModel) {
  const Scene scene = scene_of("rounded_box", Variant::float32);
  const ContactGeometry geometry(scene);
  const Hull hull = solved(scene);
  for (const SeparatingArc& arc : hull.boundary->arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      const RulingWay way{piece.rulings.front(), piece.rulings.back(), false};
      for (const double r : {0.0, 0.3, 1.0}) {
        const MovingRuling m = way.straight(geometry, r);
        EXPECT_NEAR(glm::length(m.at.n), 1, 1e-14);
        EXPECT_LE(std::abs(glm::dot(m.dn, m.at.n)), 1e-14);
        for (std::size_t i = 0; i < 2; ++i) {
          EXPECT_EQ(m.at.jet[i].x, geometry.point(m.at.contact[i]));
        }
      }
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LE(glm::distance(way.straight(geometry, 0).at.jet[i].x, way.from.point[i]), 1e-12);
        EXPECT_LE(glm::distance(way.straight(geometry, 1).at.jet[i].x, way.to.point[i]), 1e-12);
      }
    }
  }
}

/// Two balls of two seams each whose coordinates have six decimals: rulings end within the kinks of
/// seams, and exact ones between them miss them. Led, they meet, and the faces close up.
TEST(RulingWays, AreLedToWhereRulingsEnd) {
  taut_test::Random random(1);
  Natural balls;
  balls.shape =
      mapped(sphere(1), skew_rotation()) + shifted(mapped(sphere(1), skew_rotation()), {4, 1, 2});
  const Scene scene = make_scene(placed(balls, Variant::decimals, random).shape);
  const ContactGeometry geometry(scene);
  const ContactSystem system(geometry);
  const Hull hull = solved(scene);
  double farthest = 0;
  for (const SeparatingArc& arc : hull.boundary->arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
        const Ruling& from = piece.rulings[k - 1];
        const Ruling& to = piece.rulings[k];
        const RulingsBetween between(system, from, to);
        const LedRulings led(geometry, between, from, to);
        farthest = std::max(farthest, led.missed());
        if (led.missed() == 0) continue;
        const auto first = led(0), last = led(1);
        ASSERT_TRUE(first && last);
        for (std::size_t i = 0; i < 2; ++i) {
          EXPECT_LE(glm::distance(first->at.jet[i].x, from.point[i]), 1e-12);
          EXPECT_LE(glm::distance(last->at.jet[i].x, to.point[i]), 1e-12);
        }
      }
    }
  }
  EXPECT_GT(farthest, 1e-9);
  EXPECT_LT(farthest, 1e-5);
}

}  // namespace
}  // namespace taut
