#include "taut/hull/decide/beacon_envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "models.h"

namespace {

using namespace taut_test;  // NOLINT: random numbers
using taut::BeaconEnvelope;
using taut::Corners;
using taut::height_at;

/// Heights that are linear in the direction.
Corners plane(double at_origin, double along_s, double along_t) {
  return {at_origin, at_origin + along_t, at_origin + along_s, at_origin + along_s + along_t};
}

double highest(const std::vector<Corners>& points, double s, double t) {
  double result = -taut::infinity;
  for (const Corners& y : points) result = std::max(result, height_at(y, s, t));
  return result;
}

TEST(BeaconEnvelope, OfOnePointHasTheCellsCorners) {
  BeaconEnvelope envelope;
  envelope.find(std::vector{plane(1, 2, 4)});
  ASSERT_EQ(envelope.vertices().size(), 4U);
  EXPECT_EQ(envelope.vertices()[3].height, 7);
  EXPECT_TRUE(envelope.is_highest(0));
}

TEST(BeaconEnvelope, TwoPointsExchangeAlongALine) {
  BeaconEnvelope envelope;
  envelope.find(std::vector{plane(1, -2, 0), plane(-1, 2, 0), plane(-0.1, 0, 0)});
  ASSERT_EQ(envelope.vertices().size(), 6U);
  for (std::size_t k : {4u, 5u}) {
    EXPECT_EQ(envelope.vertices()[k].s, 0.5);
    EXPECT_EQ(envelope.vertices()[k].height, 0);
  }
  EXPECT_TRUE(envelope.is_highest(0) && envelope.is_highest(1) && !envelope.is_highest(2));
}

TEST(BeaconEnvelope, OfEqualPointsTheFirstIsTheHighest) {
  BeaconEnvelope envelope;
  envelope.find(std::vector{plane(0, 1, 1), plane(0, 1, 1)});
  EXPECT_TRUE(envelope.is_highest(0) && !envelope.is_highest(1));
}

/// What is below all vertices is below the envelope, and what is above one is above it.
TEST(BeaconEnvelope, VerticesTellWhatIsBelow) {
  taut_test::Random random(5);
  BeaconEnvelope envelope;
  for (int round = 0; round < 2000; ++round) {
    std::vector<Corners> points;
    const int count = pick(random, 1, 12);
    const auto any = [&] { return uniform(random, -1, 1); };
    for (int k = 0; k < count; ++k) points.push_back(plane(any(), any(), any()));
    envelope.find(points);
    for (const auto& v : envelope.vertices()) {
      ASSERT_NEAR(v.height, highest(points, v.s, v.t), 1e-14);
    }
    const Corners y = plane(any(), any(), any());
    double least = taut::infinity;
    for (const auto& v : envelope.vertices()) {
      least = std::min(least, v.height - height_at(y, v.s, v.t));
    }
    for (int k = 0; k < 50; ++k) {
      const double s = uniform(random, 0, 1), t = uniform(random, 0, 1);
      ASSERT_GE(highest(points, s, t) - height_at(y, s, t), least - 1e-14);
    }
  }
}

}  // namespace
