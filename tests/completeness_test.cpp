// What is proven of all cells of a model's patches once its separating curves are traced.

#include <gtest/gtest.h>

#include <string>

#include "freeform.h"
#include "models.h"
#include "taut/hull/trace/cell_crossings.h"
#include "taut/hull/trace/separating_graph.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// The mixed cells that neither a proof nor a known contact accounts for.
long cells_searched(const Shape& shape) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const Culling culling = cull(scene, GaussMap(scene), {.threads = 1, .progress = {}});
  const SeparatingGraph graph =
      trace_separating_curves(geometry, query, culling.samples, culling.cells);
  EXPECT_TRUE(graph.unresolved.empty());
  return graph.cells_searched;
}

TEST(Completeness, AllCellsOfTheTruthsAreDecided) {
  for (const Truth& truth : truths()) {
    if (truth.name == "teapot") continue;
    EXPECT_EQ(cells_searched(truth.shape), 0) << truth.name;
    EXPECT_EQ(cells_searched(mapped(truth.shape, skew_rotation(), {3, -1, 2})), 0) << truth.name;
  }
}

TEST(Completeness, AllCellsOfTwoToriOnATableAreDecided) {
  EXPECT_EQ(cells_searched(torus(1, 0.25) + shifted(torus(1, 0.25), {4, 0, 0})), 0);
}

/// Where free ends lie near a cell's border, or two curves run side by side, some are left.
TEST(Completeness, MostCellsOfBlobsAreDecided) {
  int complete = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) complete += cells_searched(blob(seed)) == 0;
  EXPECT_GE(complete, 15);
}

/// 1024 cells a patch there would be at the second level below the first.
TEST(Completeness, FewCellsOfTheTeapotAreSearched) { EXPECT_LE(cells_searched(teapot()), 1000); }

CulledCell cell(int patch, int level, std::uint32_t i, std::uint32_t j) {
  return {0, patch, {level, i, j}, CellState::mixed, {}};
}

/// A torus of four by four patches; u runs around the axis.
TEST(CellCrossings, AreSeenFromBothSidesOfABorder) {
  const Scene scene = make_scene(torus(2, 0.5));
  const ContactGeometry geometry(scene);
  CellCrossings crossings(geometry);
  crossings.add(Contact{0, SourceKind::face, 0, 1, 0.3});
  EXPECT_TRUE(crossings.crosses(cell(0, 2, 3, 1)));
  EXPECT_FALSE(crossings.crosses(cell(0, 2, 2, 1)));
  EXPECT_TRUE(crossings.crosses(cell(0, 2, 2, 1), 1));
  EXPECT_FALSE(crossings.crosses(cell(0, 2, 3, 2)));
  const Border& border = scene.model().parts()[0].patches()[0].borders[std::size_t(Side::u1)];
  ASSERT_EQ(border.kind, BorderKind::smooth);
  int crossed = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) {
      crossed += crossings.crosses(cell(border.neighbor, 2, i, j));
    }
  }
  EXPECT_EQ(crossed, 1);
}

/// A pole is the same point in all patches that meet there.
TEST(CellCrossings, AtAPoleAreInAllItsPatches) {
  const Scene scene = make_scene(sphere());
  const ContactGeometry geometry(scene);
  const std::vector<Patch>& patches = scene.model().parts()[0].patches();
  CellCrossings crossings(geometry);
  for (const Side side : all_sides) {
    if (patches[0].borders[std::size_t(side)].kind != BorderKind::collapsed) continue;
    const dvec2 pole = on_side(side, 0.25);
    crossings.add(Contact{0, SourceKind::face, 0, pole.x, pole.y});
  }
  int patches_crossed = 0;
  for (int p = 0; p < int(patches.size()); ++p) {
    int cells = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t j = 0; j < 4; ++j) cells += crossings.crosses(cell(p, 2, i, j));
    }
    EXPECT_TRUE(cells == 0 || cells == 4) << p;
    patches_crossed += cells == 4;
  }
  EXPECT_EQ(patches_crossed, 4);
}

}  // namespace
}  // namespace taut
