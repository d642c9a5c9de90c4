#include "taut/hull/decide/direction_cube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "models.h"
#include "taut/hull/decide/cell_tree.h"

namespace {

using namespace taut_test;  // NOLINT: random numbers
using taut::CellTree;
using taut::DirectionMap;
using taut::dvec3;
using taut::MapCell;
using taut::place_on_cube;

/// A corner of cells on an edge of the cube is computed from two faces of it.
TEST(DirectionCube, CornersAreOnePlaceFromAllFaces) {
  Random random(3);
  long compared = 0;
  for (int k = 0; k < 10'000; ++k) {
    const double along = std::round(std::ldexp(uniform(random, -1, 1), 29)) / std::ldexp(1.0, 29);
    for (int face = 0; face < 6; ++face) {
      for (const double side : {-1.0, 1.0}) {
        const dvec3 d = DirectionMap::direction(face, side, along);
        const auto place = place_on_cube(d);
        for (int other = 0; other < 6; ++other) {
          if (other == face) continue;
          const taut::FaceAxes axes = taut::face_axes(other);
          const double height = glm::dot(d, axes.own);
          if (height < 1 - 1e-12) continue;
          const double s = std::round(std::ldexp(glm::dot(d, axes.first), 29));
          const double t = std::round(std::ldexp(glm::dot(d, axes.second), 29));
          EXPECT_EQ(
              place_on_cube(DirectionMap::direction(other, std::ldexp(s, -29), std::ldexp(t, -29))),
              place);
          ++compared;
        }
      }
    }
  }
  EXPECT_GE(compared, 100'000);
}

TEST(CellTree, TellsTheSmallestCellsApart) {
  const auto cell = [](int level, std::uint32_t i, std::uint32_t j) {
    MapCell result;
    result.level = level;
    result.i = i;
    result.j = j;
    return result;
  };
  const std::vector<MapCell> cells = {cell(30, 0, 1U << 28), cell(30, 1, 0), cell(28, 1, 1),
                                      cell(29, 1U << 28, 1), cell(30, 1, 1U << 29)};
  const CellTree tree(cells);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double size = std::ldexp(2.0, -cells[k].level);
    EXPECT_EQ(tree.at(0, -1 + size * (cells[k].i + 0.5), -1 + size * (cells[k].j + 0.5)), int(k));
  }
}

}  // namespace
