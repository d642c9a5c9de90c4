#include "taut/hull/decide/direction_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "judge/families.h"
#include "judge/support_reference.h"
#include "models.h"
#include "taut/hull/decide/map_topology.h"
#include "taut/surface/resolution.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::ContactGeometry;
using taut::direction_map;
using taut::DirectionMap;
using taut::MapCell;
using taut::MapCellKind;
using taut::MapNode;
using taut::MapTopology;
using taut::Scene;

/// A model with its map at the resolution that is the model's.
struct Mapped {
  explicit Mapped(const Shape& shape)
      : scene(make_model(shape)), geometry(scene), map(direction_map(geometry, options())) {}
  taut::DirectionMapOptions options() const {
    taut::DirectionMapOptions options;
    options.resolution = rho();
    options.cell_limit = 100'000;
    return options;
  }
  double rho() const {
    return scene.frame().length_to_frame(taut::resolution_of(scene.model(), scene.diagonal()).rho);
  }

  Scene scene;
  ContactGeometry geometry;
  DirectionMap map;
};

/// Numbers of a map on the sphere.
struct Known {
  const char* name;
  Shape shape;
  int regions, arcs, nodes;
};

std::ostream& operator<<(std::ostream& os, const Known& known) { return os << known.name; }

/// Of as many copies.
Shape in_a_row(const Shape& shape, int count, const dvec3& step) {
  Shape row;
  for (int k = 0; k < count; ++k) row = row + shifted(shape, double(k) * step);
  return row;
}

Shape on_a_cube(const Shape& shape) {
  Shape all;
  for (int k = 0; k < 8; ++k) {
    all = all + shifted(shape, {k & 1 ? 3.0 : 0.0, k & 2 ? 4.0 : 0.0, k & 4 ? 5.0 : 0.0});
  }
  return all;
}

/// Two parts of spheres that meet in a shallow fold around the waist.
Shape waisted() {
  const Shape upper = shifted(spherical_cap(1.05), {0, 0, 0.05});
  const dmat3 mirror(dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, -1));
  return upper + mapped(upper, mirror);
}

/// Regions are contacts that hang together; arcs between them scrolls, straight edges among them;
/// nodes facets.
std::vector<Known> known_maps() {
  return {
      {"point", {{}, {}, {{1, 2, 3}}}, 1, 0, 0},
      {"segment", {{}, {}, {{0, 0, 0}, {1, 2, 3}}}, 2, 1, 0},
      {"tetrahedron", bilinear_saddle(), 4, 6, 4},
      {"box", box(3, 2, 1), 8, 12, 6},
      {"cylinder", cylinder(1, 2), 2, 1, 2},
      {"cylinder_with_lids", solid_cylinder(1, 2), 2, 1, 2},
      {"cylinder_twice", cylinder(1, 2) + cylinder(1, 2), 2, 1, 2},
      {"cone", cone(1, 2), 2, 1, 1},
      {"frustum", frustum(2, 1, 1), 2, 1, 2},
      {"sphere", sphere(), 1, 0, 0},
      {"sphere_twice", sphere() + sphere(), 1, 0, 0},
      {"ellipsoid", ellipsoid(3, 2, 1), 1, 0, 0},
      {"two_spheres", two_spheres(1, 0.5, 3), 2, 1, 0},
      {"sphere_inside", two_spheres(1, 0.5, 0.3), 1, 0, 0},
      {"spheres_in_a_row", in_a_row(sphere(), 4, {2, 1, 0.5}), 2, 1, 0},
      {"spheres_on_a_cube", on_a_cube(mapped(sphere(), skew_rotation())), 8, 12, 6},
      {"points_on_a_grid",
       in_a_row(in_a_row({{}, {}, {{0, 0, 0}}}, 4, {1, 0, 0}) +
                    in_a_row({{}, {}, {{0, 3, 0}}}, 4, {1, 0, 0}),
                5, {0, 0, 1}),
       8, 12, 6},
      {"torus", torus(2, 0.5), 1, 0, 2},
      {"waisted", waisted(), 2, 1, 0},
      {"oloid", oloid(), 2, 1, 0},
      {"filleted_box", filleted_box(4, 3, 2, 0.5), 8, 12, 6},
  };
}

void expect_known(const Known& known, const Shape& shape) {
  const Mapped mapped(shape);
  const MapTopology topology = map_topology(mapped.geometry, mapped.map);
  int nodes = 0;
  for (const MapNode& node : topology.nodes) nodes += node.is_facet || node.arcs > 2 ? 1 : 0;
  EXPECT_EQ(topology.regions, known.regions);
  EXPECT_EQ(topology.arcs.size(), std::size_t(known.arcs));
  EXPECT_EQ(nodes, known.nodes);
  EXPECT_EQ(mapped.map.statistics.of_kind[std::size_t(MapCellKind::undecided)], 0);
}

class KnownMaps : public testing::TestWithParam<Known> {};

TEST_P(KnownMaps, AreFound) { expect_known(GetParam(), GetParam().shape); }

INSTANTIATE_TEST_SUITE_P(Clean, KnownMaps, testing::ValuesIn(known_maps()),
                         [](const auto& info) { return info.param.name; });

class KnownMapsTurned : public testing::TestWithParam<Known> {};

TEST_P(KnownMapsTurned, AreFound) {
  taut_test::Random random(1);
  for (const Variant variant : {Variant::turned, Variant::float32, Variant::decimals}) {
    SCOPED_TRACE(name_of(variant));
    expect_known(GetParam(), placed({scaled(GetParam().shape, 10)}, variant, random).shape);
  }
}

INSTANTIATE_TEST_SUITE_P(Turned, KnownMapsTurned, testing::ValuesIn(known_maps()),
                         [](const auto& info) { return info.param.name; });

/// The cells are all of the sphere, once.
TEST(DirectionMap, CellsCoverTheCube) {
  const Mapped mapped(torus(2, 0.5));
  double area = 0;
  for (const MapCell& cell : mapped.map.cells) area += std::ldexp(1.0, -2 * cell.level);
  EXPECT_EQ(area, 6);
}

/// In directions of a cell the support function is attained, within the resolution, where the cell
/// says that something may touch.
void expect_holds(const Shape& shape) {
  const Mapped mapped(shape);
  const SupportReference reference(shape);
  taut_test::Random random(3);
  const double rho = mapped.rho();
  const std::size_t step = 1 + mapped.map.cells.size() / 200;
  for (std::size_t k = 0; k < mapped.map.cells.size(); k += step) {
    const MapCell& cell = mapped.map.cells[k];
    if (cell.contacts.empty()) continue;
    const auto d = DirectionMap::corners(cell);
    const dvec3 n = taut::unit(d[0] + uniform(random, 0, 1) * (d[2] - d[0]) +
                               uniform(random, 0, 1) * (d[1] - d[0]));
    const dvec3 x = mapped.scene.frame().to_frame(reference(n).x);
    double highest = -taut::infinity;
    for (const taut::Box& box : cell.contacts) {
      dvec3 corner;
      for (int i = 0; i < 3; ++i) corner[i] = n[i] > 0 ? box.upper[i] : box.lower[i];
      highest = std::max(highest, glm::dot(corner, n));
    }
    EXPECT_GE(highest, glm::dot(x, n) - rho) << k << " level " << cell.level;
  }
}

TEST(DirectionMap, HoldsWhatSupports) {
  expect_holds(teapot());
  expect_holds(torus(2, 0.5));
  expect_holds(filleted_box(4, 3, 2, 0.5));
}

class Families : public testing::TestWithParam<FamilyGroup> {};

/// Of all families, as files have them. Cages have no support reference of this kind.
TEST_P(Families, HoldWhatSupports) {
  for (const Family& family : GetParam().families) {
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(family.name + " " + name_of(variant));
      taut_test::Random random(1);
      const Natural natural = placed(family.make(random), variant, random);
      if (!natural.cage) expect_holds(natural.shape);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, Families, testing::ValuesIn(family_groups()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
