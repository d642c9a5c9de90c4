#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "sound_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A circle and a point beside it: an arc and two segments.
Shape drop() {
  Shape shape{{}, {circle({1, 2, 3}, {2, 0, 0}, {0, 2, 0})}, {{6, 2, 3}}};
  return mapped(shape, skew_rotation());
}

TEST(VerifyPlanar, OneFaceWithItsCurvesPasses) {
  for (const Shape& shape : {drop(), scaled(drop(), 1e-6), shifted(drop(), {3e4, -2e4, 1e4})}) {
    const Sound sound = sound_hull(shape);
    ASSERT_EQ(sound.hull.faces.size(), 1U);
    EXPECT_EQ(sound.hull.faces.front().tolerant, 0);
    EXPECT_EQ(sound.hull.curves.size(), 3U);
    const HullVerification v = verified(sound.hull, sound.scene);
    EXPECT_TRUE(v.is_hull(exact)) << text_of(v);
    EXPECT_EQ(v.euler, 2);
  }
}

/// The outline of a thin body is everywhere near to what is in it; all that its numbers were
/// rounded by counts across.
TEST(VerifyPlanar, ThinOutlinesOfRoundedNumbersPass) {
  const BezierCurve arc = {{{1.102868, 2.20126, 3.300446, 1},
                            {1.109443, 2.204086, 3.301069, 1},
                            {1.090982, 2.196219, 3.299762, 1},
                            {1.104388, 2.201963, 3.300913, 1},
                            {1.082755, 2.192619, 3.298573, 1}}};
  const Sound sound = sound_hull({{}, {as_nurbs(arc)}, {{-8.048824, -1.737111, 2.406588}}});
  EXPECT_EQ(sound.hull.dimension, 2);
  const HullVerification v = verified(sound.hull, sound.scene);
  EXPECT_TRUE(v.is_hull(exact)) << text_of(v);
}

/// What rounding makes of planar curves: normals turn by half a turn about short stretches of them.
TEST(VerifyPlanar, SheetsThatRoundingMakesPass) {
  const BezierCurve bow = {
      {{-0.4618, 2.5859, -0.8102, 1}, {-0.3281, 3.9617, 0.0246, 1}, {-0.1715, 2.9964, 0.157, 1}}};
  const Sound sound = sound_hull({{}, {as_nurbs(bow)}, {{-1.4408, 5.1373, -2.7806}}});
  EXPECT_EQ(sound.hull.dimension, 3);
  const HullVerification v = verified(sound.hull, sound.scene);
  EXPECT_TRUE(v.is_hull(exact)) << text_of(v);
}

/// The arc gives way to its chord; all else is as the chord asks.
void cut_arc(HullDocument& h) {
  HullDocument::Face& face = h.faces.front();
  for (HullDocument::Side& side : face.sides) side = {};
  for (HullDocument::Curve& curve : h.curves) {
    curve.kind = HullCurveKind::ruling;
    curve.source = -1;
    curve.points = {curve.points.front(), curve.points.back()};
  }
  face.boundary.clear();
  for (const HullDocument::Contact& c : face.contacts) face.boundary.push_back(c.p);
}

/// Of many arcs, each of which is the farthest in some directions.
TEST(VerifyPlanar, OutlinesOfManyArcsPassAndNoneMayBeCut) {
  Shape ring;
  constexpr int count = 12;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const dvec3 center(10 * std::cos(angle), 6 * std::sin(angle), 0);
    ring.curves.push_back(circle(center, {1, 0, 0}, {0, 1, 0}));
  }
  const Sound sound = sound_hull(mapped(ring, skew_rotation()));
  ASSERT_EQ(sound.hull.dimension, 2);
  const HullVerification v = verified(sound.hull, sound.scene);
  EXPECT_TRUE(v.is_hull(exact)) << text_of(v);
  const std::vector<HullDocument::Side>& sides = sound.hull.faces.front().sides;
  int arcs = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (sides[k].source < 0 || arcs++ % 4 > 0) continue;
    HullDocument cut = sound.hull;
    cut.faces.front().sides[k] = {};
    EXPECT_TRUE(failed(verified(cut, sound.scene)).contains("model_outside")) << k;
  }
  EXPECT_GE(arcs, count);
}

TEST(VerifyPlanar, FaultsAreFound) {
  struct Fault {
    const char* name;
    const char* finder;
    std::function<void(HullDocument&)> make;
  };
  const auto set = [](HullDocument& h, const std::string& key, double factor) {
    const std::size_t at = h.report.find("\"" + key + "\": ") + key.size() + 4;
    const std::size_t end = h.report.find_first_of(",\n", at);
    h.report.replace(at, end - at,
                     std::to_string(factor * std::stod(h.report.substr(at, end - at))));
  };
  const std::vector<Fault> faults = {
      {"there is another side", "complete",
       [](auto& h) { h.faces.push_back(HullDocument::Face(h.faces.front())); }},
      {"a curve has a face to its right", "complete", [](auto& h) { h.curves[0].faces[1] = 0; }},
      {"a curve runs backwards", "closed",
       [](auto& h) { std::reverse(h.curves[0].points.begin(), h.curves[0].points.end()); }},
      {"a segment is called an edge", "kinds",
       [](auto& h) {
         for (HullDocument::Curve& curve : h.curves) curve.kind = HullCurveKind::edge;
       }},
      {"an arc is cut", "model_outside", cut_arc},
      {"the outline is off by what the document's resolution is", "model_outside",
       [](auto& h) {
         state(h, 2 * h.diagonal, 0, 0);
         cut_arc(h);
       }},
      {"the area is wrong", "report", [&](auto& h) { set(h, "area", 1.001); }},
      {"the mean width is wrong", "report", [&](auto& h) { set(h, "mean_width", 1.001); }},
  };
  const Sound sound = sound_hull(drop());
  for (const Fault& fault : faults) {
    HullDocument hull = sound.hull;
    fault.make(hull);
    const HullVerification v = verified(hull, sound.scene);
    EXPECT_FALSE(v.is_hull(exact)) << fault.name;
    EXPECT_TRUE(failed(v).contains(fault.finder)) << fault.name << ": " << text_of(v);
  }
}

/// A segment between the ends of a straight curve, and points within a line.
TEST(VerifyPlanar, SegmentsPass) {
  Shape line;
  line.curves.push_back(as_nurbs(BezierCurve{{{0, 0, 0, 1}, {2, 1, 2, 1}, {6, 3, 6, 1}}}));
  for (const Shape& shape : {line, Shape{{}, {}, {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}}}) {
    Sound sound = sound_hull(shape);
    EXPECT_EQ(sound.hull.dimension, 1);
    EXPECT_EQ(sound.hull.faces.size(), 0U);
    EXPECT_TRUE(verified(sound.hull, sound.scene).is_hull(exact))
        << text_of(verified(sound.hull, sound.scene));
    sound.hull.curves[0].points[0] *= 0.5;
    sound.hull.curves[0].points[1] *= 0.5;
    EXPECT_TRUE(failed(verified(sound.hull, sound.scene)).contains("model_outside"));
  }
}

}  // namespace
}  // namespace taut
