#include "taut/hull/mesh/even_division.h"

#include <gtest/gtest.h>

#include <cmath>

namespace taut {
namespace {

double along(const EvenDivision::Place& place) { return double(place.interval) + place.s; }

TEST(EvenDivision, OfEqualIntervals) {
  EvenDivision division;
  for (int k = 0; k < 10; ++k) division.add(1);
  EXPECT_EQ(division.parts(4), 5);
  const std::vector<EvenDivision::Place> places = division.places(4, 1);
  ASSERT_EQ(places.size(), 6U);
  for (std::size_t k = 0; k < places.size(); ++k) EXPECT_EQ(along(places[k]), 2 * double(k));
  EXPECT_EQ(division.places(1e9, 1).size(), 2U);
  EXPECT_EQ(division.places(1e9, 3).size(), 4U);
}

/// Places that are all but there are taken for those of the sequence.
TEST(EvenDivision, SnapsToPlaces) {
  EvenDivision division;
  for (const double root : {1.02, 0.98, 1.0, 1.0}) division.add(root);
  const std::vector<EvenDivision::Place> places = division.places(1, 1);
  ASSERT_EQ(places.size(), 5U);
  for (std::size_t k = 0; k < places.size(); ++k) EXPECT_EQ(along(places[k]), double(k));
}

/// One contact along a circle in uneven steps, one that stays: parts of equal angle, whose chords'
/// sagittas are an eighth of their square.
TEST(EvenDivision, OfACircleInUnevenSteps) {
  std::vector<Ruling> rulings;
  std::vector<double> angles;
  for (double angle = 0; angle < 1.5; angle += angles.size() % 3 == 0 ? 0.02 : 0.03) {
    angles.push_back(angle);
    Ruling r;
    r.n = {std::cos(angle), std::sin(angle), 0};
    r.point = {r.n, dvec3(0, 0, 5)};
    rulings.push_back(r);
  }
  EvenDivision division;
  division.add(rulings, [&] { return rulings[0]; });
  constexpr double sagitta = 1e-3;
  // Beside the middle of two intervals the curve is nearer to the chord, by four in a hundred.
  const double parts = angles.back() / std::sqrt(8 * sagitta);
  EXPECT_NEAR(division.parts(sagitta), parts, 0.02 * parts);
  const std::vector<EvenDivision::Place> places = division.places(sagitta, 1);
  const double part = angles.back() / double(places.size() - 1);
  EXPECT_LT(part * part / 8, 1.1 * sagitta);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [interval, s] = places[k];
    const double angle = angles[interval] + s * (angles[interval + 1] - angles[interval]);
    EXPECT_NEAR(angle, part * double(k), 0.15 * part);  // places snap
  }
}

/// A single interval counts by its middle.
TEST(EvenDivision, OfOneInterval) {
  const auto at = [](double x, double y) {
    Ruling r;
    r.point = {dvec3(x, y, 0), dvec3(0, 0, 1)};
    return r;
  };
  EvenDivision division;
  division.add({at(-1, 0), at(1, 0)}, [&] { return at(0, 0.25); });
  EXPECT_EQ(division.parts(0.25), 1);
  EXPECT_EQ(division.parts(0.0625), 2);
}

}  // namespace
}  // namespace taut
