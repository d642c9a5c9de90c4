#include "taut/hull/trace/surface_seeds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "freeform.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// The quarters of all patches, mixed in both senses.
std::vector<CulledCell> quarters(const Scene& scene) {
  std::vector<CulledCell> cells;
  for (int patch = 0; patch < int(scene.model().parts().at(0).patches().size()); ++patch) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      cells.push_back({0, patch, PatchCell().child(k), CellState::mixed, {}});
    }
  }
  return cells;
}

void expect_same_place(const Contact& a, const Contact& b, const std::string& name) {
  EXPECT_TRUE(same_element(a, b)) << name;
  EXPECT_EQ(a.u, b.u) << name;
  EXPECT_EQ(a.v, b.v) << name;
}

/// What is known of corners that patches share tells no more than a look at each patch alone.
/// Number of the changes.
std::size_t expect_same_alone(const Shape& shape, const std::string& name) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const std::vector<CulledCell> cells = quarters(scene);
  std::vector<SupportChange> alone;
  for (std::size_t k = 0; k < cells.size(); k += 4) {
    const std::vector<CulledCell> own(cells.begin() + std::ptrdiff_t(k),
                                      cells.begin() + std::ptrdiff_t(k + 4));
    for (const SupportChange& c : support_changes(geometry, query, own)) alone.push_back(c);
  }
  const long each = query.queries();
  const std::vector<SupportChange> all = support_changes(geometry, query, cells);
  EXPECT_EQ(all.size(), alone.size()) << name;
  for (std::size_t k = 0; k < std::min(all.size(), alone.size()); ++k) {
    expect_same_place(all[k].on, alone[k].on, name);
    expect_same_place(all[k].off, alone[k].off, name);
    EXPECT_EQ(all[k].sign, alone[k].sign) << name;
  }
  EXPECT_LT(query.queries() - each, each) << name;
  return all.size();
}

TEST(SupportChanges, SharedCornersChangeNothing) {
  EXPECT_GT(expect_same_alone(torus(2, 0.5), "torus"), 0U);
  EXPECT_GT(expect_same_alone(teapot(), "teapot"), 0U);
  EXPECT_GT(expect_same_alone(dented_body({Dent()}), "dented body"), 0U);
}

/// The plate leaves a corner of the sphere's patches inwards: its own plane there supports nothing,
/// although the sphere's does.
TEST(SupportChanges, OtherNormalsAtACornerAreLookedAt) {
  const BezierPatch plate{1, 1, {{1, 0, 0, 1}, {0.5, 0, 0, 1}, {1, 0, -0.1, 1}, {0.5, 0, -0.1, 1}}};
  EXPECT_EQ(expect_same_alone(sphere() + of_patch(plate), "sphere with a plate"), 0U);
}

}  // namespace
}  // namespace taut
