#include "taut/hull/decide/direction_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cages.h"
#include "judge/families.h"
#include "judge/patterns.h"
#include "judge/support_reference.h"
#include "judge/sweeps.h"
#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/hull/solve/known_arcs.h"
#include "taut/surface/resolution.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::ContactGeometry;
using taut::direction_map;
using taut::DirectionMap;
using taut::MapCell;
using taut::MapCellKind;
using taut::Scene;
using taut::unit;

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

Shape with_rims(Shape shape, double radius, double height, const dvec3& off) {
  for (const double z : {0.0, height}) {
    shape.curves.push_back(circle(dvec3(0, 0, z) + off, {radius, 0, 0}, {0, radius, 0}));
  }
  return shape;
}

Shape capsule_of_one_size() {
  Random random(1);
  return scaled(capsule(random).shape, 0.1);
}

Shape turned(const Shape& shape, double angle) {
  return mapped(shape, dmat3(1, 0, -angle, 0, 1, 0, angle, 0, 1));
}

/// The eight corners on a sphere of radius 1.
Shape box_in_a_sphere() {
  return sphere() +
         shifted(box(2 * 2.0 / 3, 2 * 2.0 / 3, 2 * 1.0 / 3), {-2.0 / 3, -2.0 / 3, -1.0 / 3});
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
      // The same surfaces and curves in other parameters, or nearly the same.
      {"sphere_of_two_seams", sphere() + mapped(sphere(), skew_rotation()), 1, 0, 0},
      {"ellipsoid_of_two_seams",
       ellipsoid(3, 2, 1) + mapped(mapped(sphere(), skew_rotation()),
                                   dmat3(dvec3(3, 0, 0), dvec3(0, 2, 0), dvec3(0, 0, 1))),
       1, 0, 0},
      {"spheres_of_two_seams_in_a_row",
       in_a_row(sphere(), 2, {4, 2, 1}) + shifted(mapped(sphere(), skew_rotation()), {2, 1, 0.5}),
       2, 1, 0},
      {"walls_that_overlap", cylinder(1, 2) + mapped(cylinder(1, 2), turn_about_z(0.5), {0, 0, 1}),
       2, 1, 2},
      {"cylinder_with_rims", with_rims(solid_cylinder(1, 2), 1, 2, dvec3(0.0)), 2, 1, 2},
      {"cylinder_with_rims_off_it", with_rims(solid_cylinder(1, 2), 1, 2, {1e-9, 0, -1e-9}), 2, 1,
       2},
      {"capsule", capsule_of_one_size(), 2, 1, 0},
      {"capsule_turned_a_little", capsule_of_one_size() + turned(capsule_of_one_size(), 1e-8), 2, 1,
       0},
      {"sphere_that_touches_another", two_spheres(1, 0.5, 0.5), 1, 0, 0},
      {"box_in_a_sphere", box_in_a_sphere(), 1, 0, 0},
      // Arcs that end where their contacts meet.
      {"moment_curve", {{}, {twisted_cubic()}, {}}, 1, 1, 0},
      {"dented_ellipsoid", dented_ellipsoid(), 1, 1, 0},
  };
}

void expect_known(const Known& known, const Shape& shape) {
  const Mapped mapped(shape);
  taut::SupportQuery query(mapped.scene);
  const taut::ContactSystem system(mapped.geometry);
  const taut::RulingSearch search(system, query, mapped.map);
  const taut::MapGraph graph = taut::known_arcs(search).graph;
  int nodes = 0;
  for (const auto& node : graph.nodes) nodes += node.is_facet || node.ends.size() > 2 ? 1 : 0;
  EXPECT_EQ(graph.regions(), known.regions);
  EXPECT_EQ(graph.arcs.size(), std::size_t(known.arcs));
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

/// Where an arc ends cells are of one contact or two, as it happens.
TEST(FreeEnds, AreFoundTurned) {
  for (const std::uint64_t seed : {9, 10}) {
    taut_test::Random random(seed);
    for (const Variant variant : {Variant::turned, Variant::float32, Variant::decimals}) {
      SCOPED_TRACE(std::to_string(seed) + name_of(variant));
      for (const Known& known : {Known{"", {{}, {twisted_cubic()}, {}}, 1, 1, 0},
                                 Known{"", dented_ellipsoid(), 1, 1, 0}}) {
        expect_known(known, placed({scaled(known.shape, 10)}, variant, random).shape);
      }
    }
  }
}

/// A shape beside another one, at a distance.
struct Neighbors {
  const char* name;
  std::function<Shape(double)> at;
  double far;  ///< in diagonals
  /// Numbers far below the resolution, and from there on.
  std::array<int, 3> one, two;
};

Shape two_seams_at(double off) {
  return sphere() + shifted(mapped(sphere(), skew_rotation()), off * unit({2, 1, -2}));
}
Shape rims_at(double off) { return with_rims(cylinder(1, 2), 1, 2, off * unit({1, 0, -1})); }
Shape radii_at(double off) { return cylinder(1, 2) + shifted(cylinder(1 + off, 2), {0, 0, 2}); }
Shape overlapping_radii_at(double off) {
  return cylinder(1, 2) + mapped(cylinder(1 + off, 2), turn_about_z(0.5), {0, 0, 1});
}
Shape filleted_boxes_at(double off) {
  const Shape one = filleted_box(4, 3, 2, 0.5);
  return one + shifted(one, off * unit({3, 2, 1}));
}

/// What is nearer than an eighth of the resolution is one; what is eight times as far is told
/// apart, or where edges would be joined what is eight times as far as that.
TEST(DirectionMap, TellsNeighborsApart) {
  const std::vector<Neighbors> all = {
      {"two_seams", two_seams_at, 8 * taut::resolution_floor, {1, 0, 0}, {2, 1, 0}},
      {"rims", rims_at, 8 * taut::join_distance, {2, 1, 2}, {4, 4, 4}},
      {"radii", radii_at, 8 * taut::join_distance, {2, 1, 2}, {3, 2, 2}},
      {"radii_that_overlap",
       overlapping_radii_at,
       8 * taut::resolution_floor,
       {2, 1, 2},
       {3, 2, 2}},
      {"filleted_boxes", filleted_boxes_at, 1e-5, {8, 12, 6}, {14, 24, 12}},
  };
  for (const Neighbors& neighbors : all) {
    SCOPED_TRACE(neighbors.name);
    const double diagonal = make_scene(neighbors.at(0)).diagonal();
    const auto& [one, two] = std::tie(neighbors.one, neighbors.two);
    expect_known({"one", {}, one[0], one[1], one[2]},
                 neighbors.at(taut::tie_share * taut::resolution_floor * diagonal));
    for (const double share : {1, 10, 100}) {
      SCOPED_TRACE(share);
      expect_known({"two", {}, two[0], two[1], two[2]},
                   neighbors.at(share * neighbors.far * diagonal));
    }
  }
}

/// The cells are all of the sphere, once.
TEST(DirectionMap, CellsCoverTheCube) {
  const Mapped mapped(torus(2, 0.5));
  double area = 0;
  for (const MapCell& cell : mapped.map.cells) area += std::ldexp(1.0, -2 * cell.level);
  EXPECT_EQ(area, 6);
}

/// A map at a resolution that is told, a length of the model.
DirectionMap map_at(const Scene& scene, double rho) {
  taut::DirectionMapOptions options;
  options.resolution = scene.frame().length_to_frame(rho);
  options.cell_limit = 100'000;
  return direction_map(ContactGeometry(scene), options);
}

long count(const DirectionMap& map, MapCellKind kind) {
  return map.statistics.of_kind[std::size_t(kind)];
}

const MapCell& cell_at(const DirectionMap& map, const dvec3& n) {
  const auto holds = [&](const MapCell& cell) {
    const auto d = DirectionMap::corners(cell);
    const double height = glm::dot(n, glm::cross(d[1] - d[0], d[2] - d[0]));
    const dvec3 off = n * (glm::dot(d[0], glm::cross(d[1] - d[0], d[2] - d[0])) / height) - d[0];
    const double s = glm::dot(off, d[2] - d[0]) / glm::dot(d[2] - d[0], d[2] - d[0]);
    const double t = glm::dot(off, d[1] - d[0]) / glm::dot(d[1] - d[0], d[1] - d[0]);
    return glm::dot(n, d[0] + d[3]) > 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1;
  };
  return *std::find_if(map.cells.begin(), map.cells.end(), holds);
}

/// A sheet above [-1, 1] x [-1, 1] with two equal crests at x = -1/2 and 1/2, and between them a
/// dent: z = -16 depth (x^2 - 1/4)^2 - y^2.
Shape dented(double depth) {
  std::vector<std::vector<dvec3>> rows;
  for (int i = 0; i <= 4; ++i) {
    // Blossoms of the powers of x at so many ones, and else minus ones.
    const double sum = 2.0 * i - 4;
    const double x2 = (sum * sum - 4) / 12;
    const double x4 = i % 2 == 0 ? 1 : -1;
    std::vector<dvec3> row;
    for (int j = 0; j <= 2; ++j) {
      const double z = -16 * depth * (x4 - 0.5 * x2 + 1.0 / 16) - (j == 1 ? -1 : 1);
      row.emplace_back(sum / 4, j - 1, z);
    }
    rows.push_back(row);
  }
  return {{spline(rows, 4, 2)}, {}, {}};
}

/// Whatever takes a branch for one contact leaves a dent that is deeper than the resolution: where
/// it is shallow it is told from its ends, or left open.
TEST(DirectionMap, DentsStayApart) {
  constexpr double rho = 1e-5;
  for (const double depth : {4 * rho, 64 * rho, 1000 * rho}) {
    SCOPED_TRACE(depth);
    const dmat3 rotation = skew_rotation();
    const Scene scene = make_scene(mapped(dented(depth), rotation));
    const DirectionMap map = map_at(scene, rho);
    const MapCell& cell = cell_at(map, rotation * dvec3(0, 0, 1));
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    if (depth < 100 * rho) {
      EXPECT_NE(cell.kind, MapCellKind::region);
    } else {
      EXPECT_EQ(cell.kind, MapCellKind::arc);
    }
  }
}

/// The control values of degree four that take values at 0, 1/4, 1/2, 3/4 and 1.
std::array<double, 5> interpolated(const std::array<double, 5>& y) {
  return {y[0], (-13 * y[0] + 48 * y[1] - 36 * y[2] + 16 * y[3] - 3 * y[4]) / 12,
          (13 * y[0] - 64 * y[1] + 120 * y[2] - 64 * y[3] + 13 * y[4]) / 18,
          (-3 * y[0] + 16 * y[1] - 36 * y[2] + 48 * y[3] - 13 * y[4]) / 12, y[4]};
}

/// A sheet above [-1, 1] x [-1, 1] of a height that is of degree four in s and t, which are x and y
/// turned by an angle.
template <class Height>
Shape sheet(double angle, const Height& height) {
  std::array<std::array<double, 5>, 5> heights;  // by x, then y
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 4; ++j) {
      const double x = 0.5 * i - 1;
      const double y = 0.5 * j - 1;
      heights[std::size_t(i)][std::size_t(j)] = height(std::cos(angle) * x + std::sin(angle) * y,
                                                       std::cos(angle) * y - std::sin(angle) * x);
    }
  }
  for (auto& row : heights) row = interpolated(row);
  std::vector<std::vector<dvec3>> rows(5);
  for (std::size_t j = 0; j < 5; ++j) {
    std::array<double, 5> column;
    for (std::size_t i = 0; i < 5; ++i) column[i] = heights[i][j];
    column = interpolated(column);
    for (std::size_t i = 0; i < 5; ++i) {
      rows[i].emplace_back(0.5 * double(i) - 1, 0.5 * double(j) - 1, column[i]);
    }
  }
  return {{spline(rows, 4, 4)}, {}, {}};
}

/// The same dent, turned against the parameters.
Shape dented_obliquely(double depth, double angle) {
  return sheet(angle, [&](double s, double t) {
    return -16 * depth * (s * s - 0.25) * (s * s - 0.25) - t * t;
  });
}

TEST(DirectionMap, ObliqueDentsStayApart) {
  constexpr double rho = 1e-5;
  for (const double angle : {0.3, 0.7}) {
    for (const double depth : {4 * rho, 64 * rho, 1000 * rho}) {
      SCOPED_TRACE(depth);
      const dmat3 rotation = skew_rotation();
      const Scene scene = make_scene(mapped(dented_obliquely(depth, angle), rotation));
      const DirectionMap map = map_at(scene, rho);
      EXPECT_EQ(count(map, MapCellKind::undecided), 0);
      const MapCell& cell = cell_at(map, rotation * dvec3(0, 0, 1));
      EXPECT_TRUE(cell.kind == MapCellKind::arc || depth < 100 * rho);
      EXPECT_NE(cell.kind, MapCellKind::region);
    }
  }
}

/// Beside a parabolic line contacts are maxima along a ridge, on one side of it only.
TEST(DirectionMap, ContactsUpToAParabolicLineAreOne) {
  const Shape shape = sheet(0.7, [](double s, double t) { return -t * t - 0.2 * s * s * s; });
  for (const Variant variant : {Variant::clean, Variant::turned, Variant::float32}) {
    SCOPED_TRACE(taut_test::name_of(variant));
    taut_test::Random random(1);
    const Mapped mapped(placed({shape}, variant, random).shape);
    EXPECT_EQ(count(mapped.map, MapCellKind::undecided), 0);
    EXPECT_LT(mapped.map.statistics.cells, 740);
  }
}

/// Where a sheet ends without bending, as subdivision surfaces do, contacts leave its edge at once.
TEST(DirectionMap, ContactsLeaveEdges) {
  const Shape shape = sheet(0, [](double s, double t) {
    const double across = t - 0.4 * (s + 1) * (s + 1);
    return -across * across - 0.1 * (s + 1) * (s + 1) * (s + 1);
  });
  const Mapped mapped(shape);
  EXPECT_EQ(count(mapped.map, MapCellKind::undecided), 0);
  EXPECT_LT(mapped.map.statistics.cells, 1000);
}

/// A crest and the edge beside it, with a dent between.
TEST(DirectionMap, DentsBesideAnEdgeStayApart) {
  constexpr double rho = 1e-5;
  for (const double depth : {4 * rho, 64 * rho, 1000 * rho}) {
    SCOPED_TRACE(depth);
    const Shape shape =
        sheet(0, [&](double s, double t) { return -6.75 * depth * (s + 1) * s * s - t * t; });
    const dmat3 rotation = skew_rotation();
    const Scene scene = make_scene(mapped(shape, rotation));
    const DirectionMap map = map_at(scene, rho);
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    EXPECT_NE(cell_at(map, rotation * dvec3(0, 0, 1)).kind, MapCellKind::region);
  }
}

/// Three quarters of a cap, without that in which it is the highest: two edges are.
TEST(DirectionMap, ReentrantCornersPartEdges) {
  Shape shape;
  for (const auto& [x, y] : {std::array{-1, -1}, {-1, 0}, {0, -1}}) {
    std::vector<std::vector<dvec3>> rows(3);
    for (int i = 0; i <= 2; ++i) {
      for (int j = 0; j <= 2; ++j) {
        // Blossoms of (x - 0.3)^2 and (y - 0.3)^2.
        const auto square = [](double from, int k) {
          const double a = from - 0.3 + (k == 2 ? 1 : 0);
          const double b = from - 0.3 + (k >= 1 ? 1 : 0);
          return a * b;
        };
        rows[std::size_t(i)].emplace_back(x + 0.5 * i, y + 0.5 * j, -square(x, i) - square(y, j));
      }
    }
    shape.surfaces.push_back(spline(rows, 2, 2));
  }
  const dmat3 rotation = skew_rotation();
  for (const bool turned : {false, true}) {
    const dmat3 own = turned ? rotation : dmat3(1.0);
    const Scene scene = make_scene(mapped(shape, own));
    const DirectionMap map = map_at(scene, 1e-3);
    EXPECT_NE(cell_at(map, own * dvec3(0, 0, 1)).kind, MapCellKind::region);
  }
}

/// A curve or sheet in Bezier form whose numbers of control points are its degrees plus one.
NurbsCurve one_piece(const std::vector<dvec3>& points) {
  return spline(points, int(points.size()) - 1);
}

/// Two arcs that meet in a notch as deep as told, with what closes the hull below.
Shape notched(double depth) {
  Shape shape;
  shape.curves = {one_piece({{-1, -0.5, 0}, {-0.5, 2 * depth, 0}, {0, 0, 0}}),
                  one_piece({{0, 0, 0}, {0.5, 2.002 * depth, 0.3 * depth}, {1, -0.5, 0}})};
  shape.points = {{0, -3, 1}, {0, -3, -1}};
  return shape;
}

/// From a vertex both edges that end there may rise, though each is concave.
TEST(DirectionMap, NotchesStayApart) {
  taut_test::Random random(1);
  for (const double depth : {0.1, 0.02, 1e-3}) {
    for (int k = 0; k < 20; ++k) {
      SCOPED_TRACE(depth);
      const dmat3 rotation = random_rotation(random);
      const Mapped mapped(taut_test::mapped(notched(depth), rotation));
      const MapCell& cell = cell_at(mapped.map, rotation * dvec3(0, 1, 0));
      // The notch is over a chord of length 0.6 and more.
      const bool is_one = cell.kind == MapCellKind::region &&
                          taut::diagonal(cell.contacts.front()) > 0.5 * std::sqrt(depth);
      EXPECT_FALSE(is_one) << k;
    }
  }
}

/// Sheets side by side along x, from one place to the next with a height in the middle of their
/// control points, that fall to both sides in y.
struct Strip {
  double from, to;
  std::array<double, 3> heights;
};

Shape strips(const std::vector<Strip>& all) {
  Shape shape;
  for (const Strip& strip : all) {
    std::vector<std::vector<dvec3>> rows;
    for (int i = 0; i <= 2; ++i) {
      std::vector<dvec3> row;
      for (int j = 0; j <= 2; ++j) {
        row.emplace_back(strip.from + 0.5 * i * (strip.to - strip.from), j - 1,
                         strip.heights[std::size_t(i)] + (j == 1 ? 0.1 : -0.1));
      }
      rows.push_back(row);
    }
    shape.surfaces.push_back(spline(rows, 2, 2));
  }
  return shape;
}

/// Two crests, and between them a groove with a fillet so small that it is flat to within rho.
Shape grooved(double half_width, double rho) {
  const double slope = 1.5 * rho / half_width;
  const double z = 0.5 * slope * half_width;
  const double length = 1 - half_width;
  const double top = z + 0.5 * slope * length;
  const double end = z + 0.1 * slope * length;
  return strips({{-1, -half_width, {end, top, z}},
                 {-half_width, half_width, {z, -z, z}},
                 {half_width, 1, {z, top, end}}});
}

/// The same with a kink instead.
Shape kinked(double kink) {
  return strips({{-1, 0, {0.05 * kink, 0.25 * kink, 0}}, {0, 1, {0, 0.25 * kink, 0.05 * kink}}});
}

/// Slopes may grow from one nearly concave sheet to the next.
TEST(DirectionMap, GroovesStayApart) {
  taut_test::Random random(2);
  std::vector<Shape> all;
  for (const double half_width : {1e-2, 1e-3, 1e-4}) all.push_back(grooved(half_width, 3e-8));
  for (const double kink : {9.9e-4, 1e-4, 1e-5}) all.push_back(kinked(kink));
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(k);
      const dmat3 rotation = turned ? random_rotation(random) : dmat3(1.0);
      const Scene scene = make_scene(mapped(all[k], rotation));
      const DirectionMap map = map_at(scene, 1e-8 * scene.diagonal());
      EXPECT_NE(cell_at(map, rotation * dvec3(0, 0, 1)).kind, MapCellKind::region);
    }
  }
}

/// Kinks of which each is nothing make a dent together.
TEST(DirectionMap, ManyKinksMakeADent) {
  constexpr int count = 64;
  constexpr double rho = 2.8e-6;
  std::vector<Strip> all;
  for (int k = 0; k < count; ++k) {
    const auto height = [&](double x) { return 0.3 * rho * count / 4 * x * x; };
    const double from = -1 + 2.0 * k / count;
    const double to = from + 2.0 / count;
    const double middle = 0.5 * (height(from) + height(to)) + 1e-5 * rho;
    all.push_back({from, to, {height(from), middle, height(to)}});
  }
  const Scene scene = make_scene(strips(all));
  EXPECT_NE(cell_at(map_at(scene, rho), {0, 0, 1}).kind, MapCellKind::region);
}

/// Two crests with a kink between them of this size at y = 0, which vanishes at five places along
/// it; the sheets are highest about y = 0.03.
Shape with_a_kink_that_vanishes(double kink) {
  const auto product = [](const std::vector<double>& own, double root) {
    std::vector<double> result(own.size() + 1, 0.0);
    for (std::size_t i = 0; i < own.size(); ++i) {
      result[i] += own[i];
      result[i + 1] -= own[i] / root;
    }
    return result;
  };
  std::vector<double> slope = {0.5 * kink};
  for (const double root : {0.1, 0.3, 0.5, 0.7, 0.9}) slope = product(slope, root);
  const std::vector<double> height = {-5 * 0.03 * 0.03, 10 * 0.03, -5, 0, 0, 0};
  // Powers of y as means of them in Bernstein form.
  const auto coefficient = [](const std::vector<double>& powers, int j) {
    double sum = 0;
    double share = 1;
    for (int i = 0; i <= j; ++i) {
      sum += share * powers[std::size_t(i)];
      share *= double(j - i) / (5 - i);
    }
    return sum;
  };
  Shape shape;
  for (const double side : {-1.0, 1.0}) {
    std::vector<std::vector<dvec3>> rows;
    for (int i = 0; i <= 2; ++i) {
      std::vector<dvec3> row;
      for (int j = 0; j <= 5; ++j) {
        const double z = coefficient(height, j) + 0.5 * i * coefficient(slope, j);
        row.emplace_back(0.5 * i * side, 0.2 * j, z - (i == 2 ? 0.275 * kink : 0));
      }
      rows.push_back(row);
    }
    shape.surfaces.push_back(spline(rows, 2, 5));
  }
  return shape;
}

TEST(DirectionMap, KinksAreMeasuredAllAlong) {
  for (const double kink : {9.9e-4, 1e-4}) {
    SCOPED_TRACE(kink);
    const Scene scene = make_scene(with_a_kink_that_vanishes(kink));
    const DirectionMap map = map_at(scene, 1e-8 * scene.diagonal());
    EXPECT_NE(cell_at(map, {0, 0, 1}).kind, MapCellKind::region);
  }
}

/// A point a little off the middle of two others may be left out, but not one far enough.
TEST(DirectionMap, PointsBesideASegment) {
  constexpr double rho = 1e-6;
  for (const double off : {-4 * rho, 0.0, 0.2 * rho, 4 * rho, 64 * rho}) {
    SCOPED_TRACE(off);
    const Scene scene = make_scene({{}, {}, {{0, 0, 0}, {1, 0, 0}, {0.4, 0, off}, {0.5, 1, -2}}});
    const DirectionMap map = map_at(scene, rho);
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    const dvec3 x = scene.frame().to_frame({0.4, 0, off});
    const bool is_told = std::any_of(map.cells.begin(), map.cells.end(), [&](const MapCell& cell) {
      return std::any_of(cell.contacts.begin(), cell.contacts.end(), [&](const taut::Box& box) {
        return glm::distance(box.lower, x) == 0 && glm::distance(box.upper, x) == 0;
      });
    });
    EXPECT_TRUE(is_told || std::abs(off) < 4 * rho);
    EXPECT_FALSE(is_told && off == 0);
  }
}

/// Sheets above straight sides: beside the sides they are shaped like saddles.
TEST(DirectionMap, DomesOnStraightSidesAreDecided) {
  const std::vector<std::vector<dvec3>> rows = {
      {{0, 0, 0}, {0, 10, 0}, {0, 20, 0}, {0, 30, 0}},
      {{10, 0, 0}, {10, 10, 9}, {10, 20, 12}, {10, 30, 0}},
      {{20, 0, 0}, {20, 10, 11}, {20, 20, 8}, {20, 30, 0}},
      {{30, 0, 0}, {30, 10, 0}, {30, 20, 0}, {30, 30, 0}}};
  taut_test::Random random(2);
  for (const taut_test::Variant variant : {Variant::clean, Variant::turned, Variant::decimals}) {
    SCOPED_TRACE(name_of(variant));
    const Mapped mapped(placed({{{spline(rows)}, {}, {}}}, variant, random).shape);
    EXPECT_EQ(count(mapped.map, MapCellKind::undecided), 0);
    // Where the sheet's region is a narrow tip between two corners' cells need not be as narrow.
    EXPECT_LE(mapped.map.statistics.cells, 4000);
  }
}

DirectionMap map_of_family(const std::string& name, Variant variant) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families) {
      if (group.name + "/" + family.name != name) continue;
      taut_test::Random random(1);
      return Mapped(placed(family.make(random), variant, random).shape).map;
    }
  }
  throw std::invalid_argument("no family " + name);
}

/// Edges and patches that bend both ways: what bends up holds no contacts, what is left is one
/// contact to within the resolution.
TEST(DirectionMap, WhatBendsBothWaysIsDecided) {
  for (const auto& [name, cells] : {std::pair{"swept/thread", 1500},
                                    {"curves_and_points/wires", 1000},
                                    {"sheets/terrain", 3000},
                                    {"sheets/ship", 2500}}) {
    for (const taut_test::Variant variant : {Variant::clean, Variant::turned, Variant::decimals}) {
      SCOPED_TRACE(std::string(name) + " " + name_of(variant));
      const DirectionMap map = map_of_family(name, variant);
      EXPECT_EQ(count(map, MapCellKind::undecided), 0);
      EXPECT_LE(map.statistics.cells, cells);
    }
  }
}

/// Two edges of a box and two rims of a cylinder beside it in one plane.
TEST(DirectionMap, RowsInAPlaneAreFacets) {
  for (const Variant variant : all_variants) {
    SCOPED_TRACE(name_of(variant));
    const DirectionMap map = map_of_family("assemblies/box_on_cylinder", variant);
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    EXPECT_EQ(count(map, MapCellKind::facet), 10);
  }
}

/// Thinner than the resolution, a model is its two ends.
TEST(DirectionMap, NeedlesHaveTwoContacts) {
  taut_test::Random random(5);
  for (int k = 0; k < 10; ++k) {
    Shape shape = torus(2, 0.5);
    const dmat3 thin(dvec3(1, 0, 0), dvec3(0, 1e-10, 0), dvec3(0, 0, 1e-10));
    const dmat3 rotation = k == 0 ? dmat3(1.0) : random_rotation(random);
    const Mapped mapped(taut_test::mapped(shape, rotation * thin));
    EXPECT_EQ(mapped.map.cells.size(), 6u);
    EXPECT_EQ(count(mapped.map, MapCellKind::arc), 6);
    const DirectionMap& map = mapped.map;
    for (int i = 0; i < 20; ++i) {
      const dvec3 n = random_direction(random);
      const dvec3 end = mapped.scene.frame().to_frame(
          rotation * dvec3(glm::dot(rotation * dvec3(1, 0, 0), n) > 0 ? 2.5 : -2.5, 0, 0));
      const MapCell& cell = cell_at(map, n);
      const taut::Box& box = cell.contacts[cell.contact_of(n, end)];
      const dvec3 off = glm::max(glm::max(box.lower - end, end - box.upper), dvec3(0.0));
      EXPECT_LE(glm::length(off), mapped.rho());
    }
  }
}

/// A point is no needle: its ends would be one.
TEST(DirectionMap, PointsHaveOneContact) {
  for (const std::size_t copies : {1u, 3u}) {
    const Scene scene = make_scene({{}, {}, std::vector<dvec3>(copies, dvec3(1, 2, 3))});
    const DirectionMap map = map_at(scene, 1e-8);
    EXPECT_EQ(count(map, MapCellKind::region), long(map.cells.size()));
  }
}

/// Patches that stand for the surface about extraordinary vertices.
TEST(DirectionMap, CagesAreDecided) {
  for (const taut::ControlCage& cage :
       {cube_cage(), tetrahedron_cage(CageScheme::loop), torus_cage(5, 4)}) {
    const Scene scene(cage_model(cage, taut::default_cage_accuracy));
    const DirectionMap map = map_at(scene, 1e-7 * scene.diagonal());
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    EXPECT_LT(map.statistics.cells, 20'000);
  }
}

/// Of what lies in a plane some cells beside the plane's normal see nothing else; where a point is
/// above it, it is no facet.
TEST(DirectionMap, FacetsTouch) {
  taut_test::Random random(2);
  int facets = 0;
  for (int k = 0; k < 40; ++k) {
    const double above = k % 4 == 0 ? 0 : log_uniform(random, 1e-3, 0.3);
    Shape flat;
    flat.curves = {one_piece({{-1, -1, 0}, {-2, 0, 0}, {-1, 1, 0}})};
    flat.points = {{3, 0, above}};
    const Shape shape = mapped(flat, random_rotation(random));
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    const DirectionMap map = map_at(scene, 1e-8);
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    const SupportReference reference(shape);
    for (const MapCell& cell : map.cells) {
      if (cell.kind != MapCellKind::facet) continue;
      ++facets;
      const dvec3 top = scene.frame().to_frame(reference(cell.normal).x);
      EXPECT_LE(glm::dot(top - geometry.jet(cell.contact).x, cell.normal), 4e-8) << above;
    }
  }
  EXPECT_GT(facets, 20);
}

/// The patch over a quadrangle, corners (0, 0), (0, 1), (1, 0), (1, 1), of a quadratic height with
/// a blossom.
template <class Height>
NurbsSurface quadric_over(const std::array<dvec2, 4>& corners, Height height) {
  const auto at = [&](int a, int c, int b, int d) {
    const dvec2 x = corners[std::size_t(2 * a + c)];
    const dvec2 y = corners[std::size_t(2 * b + d)];
    return dvec3(0.5 * (x + y), height(x, y));
  };
  std::vector<std::vector<dvec3>> rows(3);
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) {
      const int a = i > 1 ? 1 : 0;
      const int b = i > 0 ? 1 : 0;
      const int c = j > 1 ? 1 : 0;
      const int d = j > 0 ? 1 : 0;
      rows[std::size_t(i)].push_back(0.5 * (at(a, c, b, d) + at(a, d, b, c)));
    }
  }
  return spline(rows, 2, 2);
}

/// A cap over quadrangles that halve the sides of the triangles of a fan, each sliver three: in the
/// middle of it two parameter lines are all but parallel.
Shape fan_of_slivers(int count) {
  Shape shape;
  const auto add = [&](const std::array<dvec2, 4>& corners) {
    shape.surfaces.push_back(quadric_over(
        corners, [](const dvec2& x, const dvec2& y) { return -x.x * y.x - 2 * x.y * y.y; }));
  };
  const auto rim = [&](int k) {
    const double angle = 2 * pi * k / count;
    return dvec2(std::cos(angle), std::sin(angle));
  };
  for (int k = 0; k < count; ++k) {
    const std::array<dvec2, 3> corners = {dvec2(0.0), rim(k), rim((k + 1) % count)};
    const dvec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const dvec2 own = corners[c];
      add({own, 0.5 * (own + corners[(c + 2) % 3]), 0.5 * (own + corners[(c + 1) % 3]), middle});
    }
  }
  return shape;
}

/// What of a cap in several patches touches planes of a cell may lie in parts that do not hang
/// together: the cap around them does.
TEST(DirectionMap, FansOfSliversAreOneCap) {
  const dmat3 rotation = skew_rotation();
  for (const bool turned : {false, true}) {
    const Shape shape = fan_of_slivers(48);
    const Scene scene = make_scene(turned ? mapped(shape, rotation) : shape);
    const DirectionMap map = map_at(scene, 1e-8);
    EXPECT_EQ(count(map, MapCellKind::undecided), 0);
    EXPECT_LT(map.statistics.candidates, 200'000);
    const MapCell& cell = cell_at(map, (turned ? rotation : dmat3(1.0)) * unit({0.2, 0.3, 1}));
    EXPECT_EQ(cell.kind, MapCellKind::region);
    EXPECT_EQ(cell.contacts.size(), 1u);
  }
}

/// Of a cap with a notch, below which it would be the highest, both sides of the notch are; behind
/// it they hang together.
void expect_notches_part(int turns) {
  constexpr double half = 0.2;
  taut_test::Random random(4);
  for (const int sectors : {2, 3, 4, 5, 6}) {
    SCOPED_TRACE(sectors);
    Shape shape;
    const auto rim = [&](double k) {
      const double angle = half + (2 * pi - 2 * half) * k / sectors;
      return dvec2(std::cos(angle), std::sin(angle));
    };
    for (int k = 0; k < sectors; ++k) {
      shape.surfaces.push_back(quadric_over(
          {dvec2(0.0), rim(k), rim(k + 1), 1.5 * rim(k + 0.5)},
          [](const dvec2& x, const dvec2& y) { return -(x.x - 0.2) * (y.x - 0.2) - x.y * y.y; }));
    }
    for (int turn = 0; turn < turns; ++turn) {
      const dmat3 own = turn == 0 ? dmat3(1.0) : random_rotation(random);
      const Scene scene = make_scene(mapped(shape, own));
      const DirectionMap map = map_at(scene, 1e-5);
      EXPECT_EQ(count(map, MapCellKind::undecided), 0);
      for (const double tilt : {-0.1, -0.05, 0.0, 0.05}) {
        EXPECT_NE(cell_at(map, own * dvec3(tilt, 0, 1)).kind, MapCellKind::region) << tilt;
      }
    }
  }
}

TEST(DirectionMap, NotchesPartWhatMeetsBehindThem) { expect_notches_part(2); }
TEST(DirectionMap, TurnedNotchesPartWhatMeetsBehindThem) { expect_notches_part(8); }

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

/// In a direction the support function is attained, within the resolution, where its cell says.
void expect_attained(const Scene& scene, const DirectionMap& map, const SupportReference& reference,
                     const dvec3& n, double rho) {
  const MapCell& cell = cell_at(map, n);
  if (cell.kind == MapCellKind::undecided) return;
  double highest = -taut::infinity;
  for (const taut::Box& box : cell.contacts) {
    dvec3 corner;
    for (int i = 0; i < 3; ++i) corner[i] = n[i] > 0 ? box.upper[i] : box.lower[i];
    highest = std::max(highest, glm::dot(corner, n));
  }
  const dvec3 x = scene.frame().to_frame(reference(n).x);
  EXPECT_GE(highest, glm::dot(x, n) - scene.frame().length_to_frame(rho))
      << n.x << " " << n.y << " " << n.z << " level " << cell.level;
}

/// A plane that touches in a kink belongs to neither side of it, on edges as on surfaces.
TEST(DirectionMap, KinksSupport) {
  constexpr double kink = 9.9e-4;
  const Shape shape = kinked(kink);
  const Scene scene = make_scene(shape);
  const double rho = 1e-8 * scene.diagonal();
  const DirectionMap map = map_at(scene, rho);
  const SupportReference reference(shape);
  for (int k = -8; k <= 8; ++k) {
    for (const double y : {-0.3, 0.0, 0.2}) {
      expect_attained(scene, map, reference, unit({k * kink / 18, y, -1}), rho);
    }
  }
}

/// Two curves alike but for the weight of a control point that lies in the middle of all: the lower
/// one may be higher elsewhere.
Shape weighed(double weight, double up) {
  Shape shape;
  for (const bool second : {false, true}) {
    NurbsCurve curve = one_piece({{-1, 0, 0}, {-0.5, 1, 0}, {0, 0.5, 0}, {0.5, 1, 0}, {1, 0, 0}});
    for (taut::dvec4& p : curve.points) p.y += second ? up : 0;
    if (second) curve.points[2] *= weight;
    shape.curves.push_back(curve);
  }
  shape.points = {{0, -2, 1}, {0, -2, -1}};
  return shape;
}

/// As many arcs about the origin, each higher over its chord than the turn at its ends leaves: they
/// support, though their ends stand for them.
Shape scallops(int count) {
  const double bulge = 1.1 * std::pow(taut_test::pi / count, 2);
  const auto corner = [&](int k) {
    const double angle = 2 * taut_test::pi * (k % count) / count;
    return dvec3(std::cos(angle), std::sin(angle), 0);
  };
  Shape shape;
  for (int k = 0; k < count; ++k) {
    const dvec3 middle = 0.5 * (corner(k) + corner(k + 1));
    shape.curves.push_back(
        one_piece({corner(k), middle + 2 * bulge * unit(middle), corner(k + 1)}));
  }
  return shape;
}

/// The resolution at which the ends of scallops stand for them.
double scallop_resolution(int count) {
  return 2.2 * std::pow(taut_test::pi / count, 2) / (taut::cover_share - 0.01);
}

/// What is left out because of others is not above all that is left.
TEST(DirectionMap, WhatStandsForOthersStays) {
  taut_test::Random random(4);
  struct Case {
    Shape shape;
    double rho;
  };
  std::vector<Case> all;
  for (const double weight : {0.01, 3.0, 100.0}) {
    all.push_back({weighed(weight, 1e-2), 3e-8});
    all.push_back({weighed(weight, 1e-4), 3e-8});
  }
  for (const int count : {20, 40}) {
    const Shape ring = scallops(count);
    all.push_back({ring, scallop_resolution(count)});
    all.push_back({ring + shifted(ring, {0.1, 0.03, 0.5}), scallop_resolution(count)});
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    const Scene scene = make_scene(all[k].shape);
    taut::DirectionMapOptions options;
    options.resolution = scene.frame().length_to_frame(all[k].rho);
    options.cell_limit = 20'000;
    const DirectionMap map = direction_map(ContactGeometry(scene), options);
    const SupportReference reference(all[k].shape);
    for (int i = 0; i < 300; ++i) {
      expect_attained(scene, map, reference, random_direction(random), all[k].rho);
    }
  }
}

/// All numbers of a map, to the last bit.
class MapBits {
 public:
  explicit MapBits(const DirectionMap& map) {
    for (const MapCell& cell : map.cells) add(cell);
    const auto& statistics = map.statistics;
    for (const long count :
         {statistics.cells, statistics.candidates, statistics.queries, long(statistics.deepest)}) {
      add(double(count));
    }
    for (const long count : statistics.of_kind) add(double(count));
    add(map.resolution);
  }
  const std::vector<std::uint64_t>& all() const { return bits_; }

 private:
  void add(double x) { bits_.push_back(std::bit_cast<std::uint64_t>(x)); }
  void add(const dvec3& x) {
    for (int k = 0; k < 3; ++k) add(x[k]);
  }
  void add(const taut::Contact& c) {
    for (const double x : {double(c.instance), double(c.kind), double(c.element), c.u, c.v}) add(x);
  }
  void add(const MapCell& cell) {
    for (const double x : {double(cell.face), double(cell.level), double(cell.i), double(cell.j),
                           double(cell.kind), double(cell.contacts.size()), double(cell.apart)}) {
      add(x);
    }
    for (const taut::Box& box : cell.contacts) {
      add(box.lower);
      add(box.upper);
    }
    add(cell.contact);
    for (const MapCell::Translate& translate : cell.translates) {
      add(double(translate.of));
      add(translate.by);
    }
    for (const MapCell::Round& round : cell.rounds) {
      add(round.center);
      for (int k = 0; k < 3; ++k) add(round.root[k]);
    }
    add(cell.normal);
    add(cell.width);
  }

  std::vector<std::uint64_t> bits_;
};

/// Also where a limit leaves cells undecided.
TEST(DirectionMap, SameForAnyNumberOfThreads) {
  const struct {
    Shape shape;
    long cell_limit, candidate_limit;
  } all[] = {
      {torus(2, 0.5), 100'000, 1'000'000},
      {torus(2, 0.5), 300, 1'000'000},
      {teapot(), 100'000, 1'000'000},
      {teapot(), 100'000, 5'000},
      {filleted_box(4, 3, 2, 0.5), 100'000, 20'000},
      {on_a_cube(mapped(sphere(), skew_rotation())), 100'000, 1'000'000},
      {in_a_row(capsule_of_one_size(), 4, {2, 1, 0.5}), 100'000, 1'000'000},
      {oloid(), 100'000, 1'000'000},
      {box(3, 2, 1), 100'000, 1'000'000},
      {{{}, {}, {{0, 0, 0}, {1, 2, 3}}}, 100'000, 1'000'000},
  };
  for (const auto& model : all) {
    const Scene scene(make_model(model.shape));
    const ContactGeometry geometry(scene);
    taut::DirectionMapOptions options;
    options.resolution =
        scene.frame().length_to_frame(taut::resolution_of(scene.model(), scene.diagonal()).rho);
    options.cell_limit = model.cell_limit;
    options.candidate_limit = model.candidate_limit;
    options.threads = 1;
    const DirectionMap map = direction_map(geometry, options);
    const auto& statistics = map.statistics;
    const bool is_left = count(map, MapCellKind::undecided) > 0;
    EXPECT_EQ(is_left, statistics.cells >= options.cell_limit ||
                           statistics.candidates >= options.candidate_limit);
    for (const int threads : {2, 5}) {
      SCOPED_TRACE(std::to_string(&model - all) + " " + std::to_string(threads));
      options.threads = threads;
      EXPECT_TRUE(MapBits(direction_map(geometry, options)).all() == MapBits(map).all());
    }
  }
}

TEST(DirectionMap, TellsAShareThatRisesInSmallSteps) {
  const Scene scene = make_scene(torus(2, 0.5));
  for (const int threads : {1, 2}) {
    std::vector<double> shares = {0};
    taut::DirectionMapOptions options;
    options.resolution = 1e-8;
    options.threads = threads;
    options.report = [&](double share) { shares.push_back(share); };
    direction_map(ContactGeometry(scene), options);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_LT(shares.back(), 1);
    double most = 0;
    for (std::size_t k = 1; k < shares.size(); ++k) {
      most = std::max(most, shares[k] - shares[k - 1]);
    }
    EXPECT_LT(threads == 1 ? most : 0, 0.06);
    EXPECT_GT(shares.back(), 0.75);
  }
}

TEST(DirectionMap, StopsOnAnyNumberOfThreads) {
  const Scene scene = make_scene(torus(2, 0.5));
  std::stop_source source;
  source.request_stop();
  taut::DirectionMapOptions options;
  options.resolution = 1e-8;
  options.stop = source.get_token();
  for (const int threads : {1, 2, 5}) {
    options.threads = threads;
    EXPECT_THROW(direction_map(ContactGeometry(scene), options), taut::Cancelled);
  }
}

/// A patch about the segment from (-1, 0, 0) to (1, 0, 0).
Shape sliver(int degree_v, double width, taut_test::Random& random) {
  constexpr int degree_u = 3;
  NurbsSurface surface;
  surface.degree_u = degree_u;
  surface.degree_v = degree_v;
  surface.knots_u = {0, 0, 0, 0, 1, 1, 1, 1};
  surface.knots_v.assign(std::size_t(degree_v) + 1, 0);
  surface.knots_v.insert(surface.knots_v.end(), std::size_t(degree_v) + 1, 1);
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      const bool inside = i > 0 && i < degree_u;
      const double reach = inside ? 4 * width : width;
      surface.points.emplace_back(2.0 * i / degree_u - 1, uniform(random, -reach, reach),
                                  uniform(random, -reach, reach), 1);
    }
  }
  Shape shape;
  shape.surfaces.push_back(surface);
  return shape;
}

/// Of vertices and edges nearer to each other than the resolution one stands for the others, also
/// where what is between rises from it.
void expect_slivers_hold(int count) {
  taut_test::Random random(28);
  for (int k = 0; k < count; ++k) {
    SCOPED_TRACE(k);
    const double rho = std::pow(10.0, uniform(random, -4, -2.5));
    const double width = rho * std::pow(10.0, uniform(random, -0.7, 0.3));
    const Shape shape = sliver(1 + k % 3, width, random);
    const Scene scene = make_scene(shape);
    taut::DirectionMapOptions options;
    options.resolution = scene.frame().length_to_frame(rho);
    options.candidate_limit = 50'000;
    const DirectionMap map = direction_map(ContactGeometry(scene), options);
    const SupportReference reference(shape);
    for (int i = 0; i < 200; ++i) {
      const double angle = uniform(random, 0, 2 * taut_test::pi);
      const dvec3 n = unit({uniform(random, -0.04, 0.04), std::cos(angle), std::sin(angle)});
      expect_attained(scene, map, reference, n, rho);
    }
  }
}

TEST(DirectionMap, SliversHoldWhatSupports) { expect_slivers_hold(3); }
TEST(DirectionMap, ManySliversHoldWhatSupports) { expect_slivers_hold(24); }

TEST(DirectionMap, HoldsWhatSupports) {
  expect_holds(teapot());
  expect_holds(torus(2, 0.5));
  expect_holds(filleted_box(4, 3, 2, 0.5));
}

/// Of three equal spheres in a row the middle one is covered, with all of its patches; a
/// larger one is not.
TEST(DirectionMap, TellsWhatIsCovered) {
  const auto row = [](double middle) {
    return sphere(1) + shifted(sphere(middle), {3, 0, 0}) + shifted(sphere(1), {6, 0, 0});
  };
  const Mapped equal(row(1));
  ASSERT_EQ(equal.map.covered.size(), 8u);
  for (const taut::Contact& c : equal.map.covered) {
    const dvec3 x = equal.scene.frame().to_model(equal.geometry.point(c));
    EXPECT_NEAR(glm::distance(x, dvec3(3, 0, 0)), 1, 1e-12);
  }
  EXPECT_TRUE(Mapped(row(1.001)).map.covered.empty());
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
