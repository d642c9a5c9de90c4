#include "taut/surface/coordinate_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "models.h"

namespace taut_test::coordinate_grids {
namespace {

using namespace taut;  // NOLINT: what is tested
using Kind = CoordinateGrid::Kind;

/// The number as a file has it that is written with so many decimals.
double written(double x, int decimals) {
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, x);
  return std::strtod(text.data(), nullptr);
}

double to_float32(double x) { return double(float(x)); }

std::vector<dvec3> random_points(Random& random, int count, double size) {
  std::vector<dvec3> points(std::size_t(count), dvec3(0.0));
  for (dvec3& p : points) p = size * random_point(random);
  return points;
}

template <class Round>
std::vector<dvec3> rounded(std::vector<dvec3> points, const Round& round) {
  for (dvec3& p : points) p = {round(p.x), round(p.y), round(p.z)};
  return points;
}

double largest(const std::vector<dvec3>& points) {
  double result = 0;
  for (const dvec3& p : points) {
    result = std::max({result, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return result;
}

/// From the next float32 below to the largest coordinate.
double float32_step(const std::vector<dvec3>& points) {
  const auto most = float(largest(points));
  return double(std::nextafter(most, std::numeric_limits<float>::infinity())) - double(most);
}

CoordinateGrid grid_of(const std::vector<dvec3>& points) {
  StoredCoordinates stored;
  stored.add(points);
  return stored.grid();
}

/// The points times random weights.
CoordinateGrid weighted_grid_of(const std::vector<dvec3>& points, Random& random) {
  std::vector<dvec4> weighted;
  weighted.reserve(points.size());
  for (const dvec3& p : points) {
    weighted.push_back(homogeneous(p, log_uniform(random, 1e-3, 1e3)));
  }
  StoredCoordinates stored;
  stored.add(weighted);
  return stored.grid();
}

TEST(CoordinateGrid, NothingAndZerosAreOnNone) {
  EXPECT_EQ(grid_of({}).kind, Kind::none);
  EXPECT_EQ(grid_of({dvec3(0), dvec3(-0.0)}).kind, Kind::none);
}

TEST(CoordinateGrid, Doubles) {
  Random random(1);
  for (int round = 0; round < 300; ++round) {
    const std::vector<dvec3> points =
        random_points(random, pick(random, 2, 30), log_uniform(random, 1e-6, 1e6));
    EXPECT_EQ(grid_of(points).kind, Kind::none);
    EXPECT_EQ(grid_of(points).step, 0);
    EXPECT_EQ(weighted_grid_of(points, random).kind, Kind::none);
  }
}

TEST(CoordinateGrid, Float32OfAllSizes) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const std::vector<dvec3> points = rounded(
        random_points(random, pick(random, 4, 30), log_uniform(random, 1e-30, 1e30)), to_float32);
    // Those of some sizes are whole numbers below 2^24.
    if (largest(points) > 1e6 && largest(points) < 1e8) continue;
    for (const CoordinateGrid& grid : {grid_of(points), weighted_grid_of(points, random)}) {
      EXPECT_EQ(grid.kind, Kind::float32) << largest(points);
      EXPECT_EQ(grid.step, float32_step(points)) << largest(points);
    }
  }
}

TEST(CoordinateGrid, Float32AtPowersOfTwo) {
  for (const double most : {1.0, 2.0, 0.5, 4096.0}) {
    const std::vector<dvec3> points = {{most, to_float32(0.1), to_float32(-0.3)},
                                       {to_float32(0.2), to_float32(1.0 / 3), 0}};
    EXPECT_EQ(grid_of(points).step, most * 0x1p-23);
    EXPECT_EQ(grid_of({{-most, to_float32(0.1), to_float32(0.7)}}).step, most * 0x1p-23);
  }
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(grid_of({dvec3(7 * double(least), 0, 5 * double(least))}).step, double(least));
}

TEST(CoordinateGrid, DecimalsOfAllSizes) {
  Random random(3);
  for (int round = 0; round < 600; ++round) {
    const int decimals = pick(random, 6, 14);
    // At least a few digits, and at most 15.
    const double size =
        log_uniform(random, std::pow(10, 4 - decimals), std::pow(10, 14 - decimals));
    const std::vector<dvec3> points = rounded(random_points(random, pick(random, 10, 30), size),
                                              [&](double x) { return written(x, decimals); });
    for (const CoordinateGrid& grid : {grid_of(points), weighted_grid_of(points, random)}) {
      EXPECT_EQ(grid.kind, Kind::decimals) << decimals << " " << size;
      EXPECT_EQ(grid.decimals, decimals) << size;
      EXPECT_EQ(grid.step, std::strtod(("1e-" + std::to_string(decimals)).c_str(), nullptr));
    }
  }
}

TEST(CoordinateGrid, FewDecimalsAreMeant) {
  Random random(4);
  for (int decimals = 0; decimals <= 5; ++decimals) {
    const std::vector<dvec3> points =
        rounded(random_points(random, 30, 20), [&](double x) { return written(x, decimals); });
    EXPECT_EQ(grid_of(points).kind, Kind::none) << decimals;
    EXPECT_EQ(weighted_grid_of(points, random).kind, Kind::none) << decimals;
  }
}

TEST(CoordinateGrid, NumbersThatNeedNoRounding) {
  EXPECT_EQ(grid_of({{0, 0, 0}, {40, 30, 20}}).kind, Kind::none);
  EXPECT_EQ(grid_of({{1234567, 99999, -345677}, {16777215, 8388609, 3}}).kind, Kind::none);
  // 64ths of an inch have six decimals, and 40 of them and a 64th many bits.
  EXPECT_EQ(grid_of({{1.0 / 64, 3.0 / 64, 63.0 / 64}, {-5.0 / 64, 40 + 1.0 / 64, 0}}).kind,
            Kind::none);
  // Micrometres, in metres.
  EXPECT_EQ(grid_of({{0.000004, 0.000254, 0}, {0.000999, -0.000125, 0.00004}}).kind, Kind::none);
  EXPECT_EQ(grid_of({{0.001254, 0.002541, 0}, {0.001999, -0.003126, 0.00004}}).decimals, 6);
  EXPECT_EQ(grid_of({{25.4, 12.7, 6.35}, {3.175, 1.5875, 0.79375}}).kind, Kind::none);
}

TEST(CoordinateGrid, HalfOfTheNumbersMustUseTheLastPlaces) {
  const double fine = written(0.123457, 6);
  EXPECT_EQ(grid_of({{fine, fine, 1.5}, {2.5, fine, 1}}).kind, Kind::decimals);
  EXPECT_EQ(grid_of({{fine, fine, 1.5}, {2.5, 2.1234, 1}}).kind, Kind::none);
  // The fifth of six decimals is one of the last two.
  EXPECT_EQ(grid_of({{fine, 0.12345, 1.5}, {2.5, 2.12345, 1}}).decimals, 6);
  EXPECT_EQ(grid_of({{0.12345, 0.12344, 1.5}, {2.5, 2.12345, 1}}).kind, Kind::none);
  const double bits = to_float32(0.1);
  EXPECT_EQ(grid_of({{bits, bits, 1.5}, {2.5, bits, 1}}).kind, Kind::float32);
  EXPECT_EQ(grid_of({{bits, bits, 1.5}, {2.5, 3, 1}}).kind, Kind::none);
}

TEST(CoordinateGrid, OneNumberOffTheGridIsEnough) {
  Random random(5);
  std::vector<dvec3> points = rounded(random_points(random, 20, 10), to_float32);
  points[7].y = 0.1;
  EXPECT_EQ(grid_of(points).kind, Kind::none);
  points = rounded(random_points(random, 20, 10), [](double x) { return written(x, 6); });
  points[19].z = std::sqrt(2.0);
  EXPECT_EQ(grid_of(points).kind, Kind::none);
}

TEST(CoordinateGrid, OrderDoesNotMatter) {
  Random random(6);
  for (int round = 0; round < 100; ++round) {
    std::vector<dvec3> points = random_points(random, 12, 3);
    for (dvec3& p : points) {
      for (int i = 0; i < 3; ++i) p[i] = written(p[i], pick(random, 3, 8));
    }
    const CoordinateGrid grid = grid_of(points);
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(grid_of(points).kind, grid.kind);
    EXPECT_EQ(grid_of(points).decimals, grid.decimals);
    std::sort(points.begin(), points.end(),
              [](const dvec3& a, const dvec3& b) { return a.x < b.x; });
    EXPECT_EQ(grid_of(points).kind, grid.kind);
    EXPECT_EQ(grid_of(points).decimals, grid.decimals);
  }
}

TEST(CoordinateGrid, NumbersBeyondFloat32) {
  EXPECT_EQ(grid_of({{1e300, -1e300, 1e-300}}).kind, Kind::none);
  EXPECT_EQ(grid_of({{3.5e38, 1.5, 2}}).kind, Kind::none);
}

}  // namespace
}  // namespace taut_test::coordinate_grids
