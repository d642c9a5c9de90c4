#include "taut/surface/resolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "error_checks.h"
#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/io/document/read_document.h"
#include "taut/io/document/write_document.h"
#include "taut/subdivision/add_cage.h"

namespace taut_test::resolutions {
namespace {

using namespace taut;  // NOLINT: what is tested
using Kind = CoordinateGrid::Kind;
using Source = ResolutionSource;
using shapes::sphere;

double to_float32(double x) { return double(float(x)); }

auto to_decimals(int decimals) {
  return [decimals](double x) {
    const double power = std::pow(10.0, decimals);
    return std::round(x * power) / power;
  };
}

/// The shape with all coordinates rounded.
template <class Round>
Shape rounded(Shape shape, const Round& round) {
  const auto image = [&](const dvec3& x) { return dvec3(round(x.x), round(x.y), round(x.z)); };
  const auto round_all = [&](std::vector<dvec4>& points) {
    for (dvec4& p : points) p = homogeneous(image(euclidean(p)), p.w);
  };
  for (NurbsSurface& s : shape.surfaces) round_all(s.points);
  for (NurbsCurve& c : shape.curves) round_all(c.points);
  for (dvec3& p : shape.points) p = image(p);
  return shape;
}

/// In no symmetric position.
Shape turned(const Shape& shape, double size = 1) {
  return scaled(mapped(shape, skew_rotation(), dvec3(0.3, -0.7, 0.2)), size);
}

double largest_coordinate(const Shape& shape) {
  double largest = 0;
  const auto include = [&](const dvec3& x) {
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(x[i]));
  };
  for (const NurbsSurface& s : shape.surfaces) {
    for (const dvec4& p : s.points) include(euclidean(p));
  }
  for (const dvec3& p : shape.points) include(p);
  return largest;
}

Resolution resolution_of(const Model& model) {
  return taut::resolution_of(model, diagonal(model.control_box()));
}
Resolution resolution_of(const Shape& shape) { return resolution_of(make_model(shape)); }
double diagonal_of(const Shape& shape) { return diagonal(make_model(shape).control_box()); }

const std::vector<double> sizes = {1e-6, 1, 1e6};

TEST(Resolution, CleanModelsHaveTheFloor) {
  for (const Shape& shape :
       {sphere(), torus(2, 0.5), filleted_box(4, 3, 2, 0.5), solid_cone(1, 2)}) {
    for (const double size : sizes) {
      for (const Shape& placed : {scaled(shape, size), turned(shape, size)}) {
        const Resolution r = resolution_of(placed);
        EXPECT_EQ(r.source, Source::floor);
        EXPECT_DOUBLE_EQ(r.rho, 1e-8 * diagonal_of(placed));
        EXPECT_LE(r.worst_join, 1e-14 * size);
        EXPECT_FALSE(r.capped());
      }
    }
  }
}

TEST(Resolution, BoxOfWholeNumbersIsNotRounded) {
  const Resolution r = resolution_of(box(40, 30, 20));
  EXPECT_EQ(r.source, Source::floor);
  EXPECT_EQ(r.grid.kind, Kind::none);
  EXPECT_DOUBLE_EQ(r.rho, 1e-8 * std::sqrt(40. * 40 + 30. * 30 + 20. * 20));
}

TEST(Resolution, Float32IsFourHalfSteps) {
  for (const Shape& shape : {sphere(), torus(2, 0.5), teapot()}) {
    for (const double size : sizes) {
      const Shape placed = rounded(turned(shape, size), to_float32);
      const auto most = float(largest_coordinate(placed));
      const double step = double(std::nextafter(most, 2 * most)) - double(most);
      const Resolution r = resolution_of(placed);
      EXPECT_EQ(r.source, Source::coordinates);
      EXPECT_EQ(r.grid.kind, Kind::float32);
      EXPECT_EQ(r.rho, 2 * step);
    }
  }
}

TEST(Resolution, DecimalsAreFourHalfSteps) {
  const Resolution six = resolution_of(rounded(turned(sphere()), to_decimals(6)));
  EXPECT_EQ(six.source, Source::coordinates);
  EXPECT_EQ(six.grid.decimals, 6);
  EXPECT_DOUBLE_EQ(six.rho, 2e-6);
  const Resolution seven = resolution_of(rounded(turned(sphere()), to_decimals(7)));
  EXPECT_EQ(seven.source, Source::coordinates);
  EXPECT_DOUBLE_EQ(seven.rho, 2e-7);
  // 2e-9 is below the floor.
  const Shape nine = rounded(turned(sphere()), to_decimals(9));
  EXPECT_EQ(resolution_of(nine).grid.decimals, 9);
  EXPECT_EQ(resolution_of(nine).source, Source::floor);
  EXPECT_DOUBLE_EQ(resolution_of(nine).rho, 1e-8 * diagonal_of(nine));
  // A millionth of the size has a millionth of the resolution.
  const Resolution small = resolution_of(rounded(turned(sphere(), 1e-6), to_decimals(12)));
  EXPECT_EQ(small.source, Source::coordinates);
  EXPECT_DOUBLE_EQ(small.rho, 2e-12);
  EXPECT_EQ(resolution_of(rounded(turned(sphere(), 1e6), to_decimals(6))).source, Source::floor);
}

TEST(Resolution, CoarseGridsAreCappedAndSaidSo) {
  const Model model = make_model(rounded(turned(sphere(), 0.01), to_decimals(6)));
  const double size = diagonal(model.control_box());
  const Resolution r = taut::resolution_of(model, size);
  EXPECT_TRUE(r.capped());
  EXPECT_EQ(r.source, Source::coordinates);
  EXPECT_DOUBLE_EQ(r.rho, 1e-5 * size);
  EXPECT_DOUBLE_EQ(r.of_model, 2e-6);
  std::vector<std::string> warnings;
  Progress progress;
  progress.warn = [&](std::string_view code, std::string_view text) {
    warnings.emplace_back(code);
    EXPECT_NE(text.find("coordinates have 6 decimals"), text.npos) << text;
    EXPECT_NE(text.find("2e-06"), text.npos) << text;
    EXPECT_NE(text.find("--resolution"), text.npos) << text;
  };
  warn_if_capped(r, progress);
  EXPECT_EQ(warnings, std::vector<std::string>{"coarse-resolution"});
  // What is asked for is no surprise.
  const Resolution asked = taut::resolution_of(model, size, 1e-9);
  EXPECT_DOUBLE_EQ(asked.rho, 1e-9 * size);
  warn_if_capped(asked, progress);
  warn_if_capped(resolution_of(sphere()), progress);
  EXPECT_EQ(warnings.size(), 1U);
}

/// [0, 1] x [0, 1] x 0, moved.
Shape unit_square(const dvec3& translation) {
  const Shape square = of_patch(
      {1, 1, {dvec4(0, 0, 0, 1), dvec4(0, 1, 0, 1), dvec4(1, 0, 0, 1), dvec4(1, 1, 0, 1)}});
  return shifted(square, translation);
}

/// Side by side along y, the second one so much higher.
Shape two_squares(double gap) { return unit_square(dvec3(0)) + unit_square({1, 0, gap}); }

TEST(Resolution, JoinsThatMiss) {
  for (const double gap : {1e-7, 3e-8, 1e-9}) {
    for (const double size : sizes) {
      const Shape shape = scaled(two_squares(gap), size);
      const Resolution r = resolution_of(shape);
      EXPECT_NEAR(r.worst_join, gap * size, 1e-14 * size);
      const double floor = 1e-8 * size * std::sqrt(5 + gap * gap);
      EXPECT_EQ(r.source, 4 * gap * size > floor ? Source::joins : Source::floor);
      EXPECT_NEAR(r.rho, std::max(4 * gap * size, floor), 1e-13 * size);
    }
  }
  // What is farther apart is not joined.
  EXPECT_EQ(resolution_of(two_squares(3e-7)).worst_join, 0);
}

TEST(Resolution, SidesThatCollapseAndCornersThatMeet) {
  // A triangle whose third corner is a side of 1e-7 in length.
  const Shape triangle = of_patch(
      {1, 1, {dvec4(0, 0, 0, 1), dvec4(1, 0, 0, 1), dvec4(0, 1, 0, 1), dvec4(1e-7, 1, 0, 1)}});
  EXPECT_DOUBLE_EQ(resolution_of(triangle).worst_join, 1e-7);
  // One whose side is a curve of half that, from the corner to the corner.
  const Shape loop = of_patch({1,
                               2,
                               {dvec4(0, 0, 0, 1), dvec4(0.5, 0, 0, 1), dvec4(1, 0, 0, 1),
                                dvec4(0, 1, 0, 1), dvec4(0, 1, 5e-8, 1), dvec4(0, 1, 0, 1)}});
  EXPECT_DOUBLE_EQ(resolution_of(loop).worst_join, 5e-8);
  // Two squares that have a corner in common, all but 5e-8.
  const Shape squares = unit_square(dvec3(0)) + unit_square({1, 1, 5e-8});
  EXPECT_DOUBLE_EQ(resolution_of(squares).worst_join, 5e-8);
}

TEST(Resolution, DeviationOfStandIns) {
  Part part;
  for (const NurbsSurface& s : torus(2, 0.5).surfaces) part.add_surface(s, "face");
  part.include_deviation(3e-6);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  const Resolution r = resolution_of(model);
  EXPECT_EQ(r.source, Source::stand_ins);
  EXPECT_EQ(r.rho, 3e-6);
}

/// A cube's corners and faces.
ControlCage cube_cage(double size) {
  ControlCage cage;
  for (int k = 0; k < 8; ++k) {
    cage.points.push_back(skew_rotation() * dvec3((k & 1) != 0 ? size : -size,
                                                  (k & 2) != 0 ? size : -size,
                                                  (k & 4) != 0 ? size : -size));
  }
  cage.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cage;
}

Model cage_model(const ControlCage& cage) {
  Part part;
  add_cage(part, cage, "cage", {1e-7, {}});
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

TEST(Resolution, CagesAreJudgedByTheirOwnPoints) {
  ControlCage cage = cube_cage(1);
  const Model exact = cage_model(cage);
  EXPECT_EQ(resolution_of(exact).source, Source::stand_ins);
  EXPECT_EQ(resolution_of(exact).rho, exact.deviation_bound());
  for (dvec3& p : cage.points) {
    p = {to_decimals(6)(p.x), to_decimals(6)(p.y), to_decimals(6)(p.z)};
  }
  const Resolution r = resolution_of(cage_model(cage));
  EXPECT_EQ(r.grid.decimals, 6);
  EXPECT_EQ(r.source, Source::coordinates);
  EXPECT_DOUBLE_EQ(r.rho, 2e-6);
}

Model points_model(const std::vector<dvec3>& points) {
  Part part;
  part.add_points(points);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

TEST(Resolution, PointsHaveTheRoundingOfDoubles) {
  Random random(1);
  for (const double size : sizes) {
    std::vector<dvec3> points;
    dvec3 most(0.0);
    for (int k = 0; k < 50; ++k) {
      points.push_back(size * random_point(random));
      most = glm::max(most, glm::abs(points.back()));
    }
    const Resolution r = resolution_of(points_model(points));
    EXPECT_EQ(r.source, Source::rounding);
    EXPECT_DOUBLE_EQ(r.rho, 0x1p-49 * (most.x + most.y + most.z));
    for (dvec3& p : points) p = {to_float32(p.x), to_float32(p.y), to_float32(p.z)};
    EXPECT_EQ(resolution_of(points_model(points)).source, Source::coordinates);
  }
  PolygonMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
  Part part;
  part.add_polygons(triangle);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  EXPECT_EQ(resolution_of(model).source, Source::rounding);
  EXPECT_EQ(resolution_of(model).rho, 0x1p-49 * 4);
}

TEST(Resolution, OfAPointAndOfNothing) {
  EXPECT_EQ(taut::resolution_of(Model(), 0).rho, 0);
  const Resolution r = resolution_of(points_model({{1, 2, -3}}));
  EXPECT_EQ(r.rho, 0x1p-49 * 6);
  EXPECT_FALSE(r.capped());
}

TEST(Resolution, FarFromTheOriginDoublesAreCoarse) {
  const Resolution r = resolution_of(shifted(turned(sphere()), {1e9, 0, 0}));
  EXPECT_EQ(r.source, Source::rounding);
  EXPECT_NEAR(r.rho, 0x1p-49 * 1e9, 0x1p-49 * 10);
}

TEST(Resolution, OfWhatIsPlacedInAnyOrder) {
  const std::vector<Shape> shapes = {turned(sphere()), rounded(turned(sphere()), to_float32),
                                     rounded(turned(torus(2, 0.5)), to_decimals(6)),
                                     two_squares(1e-7)};
  std::vector<int> order = {0, 1, 2, 3};
  do {
    Model model;
    for (const int k : order) {
      Part part = make_model(shapes[std::size_t(k)]).parts()[0];
      model.add_part(std::move(part), smooth_join_angle);
    }
    const Resolution r = resolution_of(model);
    EXPECT_DOUBLE_EQ(r.rho, 2e-6);
    EXPECT_EQ(r.grid.decimals, 6);
    EXPECT_NEAR(r.worst_join, 1e-7, 1e-14);
    // Without the coarsest one, and that in float32 turned and moved.
    model.clear_instances();
    for (int k = 0; k < 4; ++k) {
      if (order[std::size_t(k)] != 2) model.add_instance(k, {skew_rotation(), dvec3(1, 2, 3)});
    }
    EXPECT_EQ(resolution_of(model).rho,
              std::max(4 * resolution_of(model).worst_join, resolution_of(shapes[1]).rho));
    EXPECT_EQ(resolution_of(model).grid.kind, Kind::float32);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Resolution, OptionDecides) {
  const Shape shape = rounded(turned(sphere()), to_float32);
  const Model model = make_model(shape);
  const double size = diagonal_of(shape);
  for (const double share : {1e-12, 1e-7, 1e-3, 1.0}) {
    const Resolution r = taut::resolution_of(model, size, share);
    EXPECT_EQ(r.source, Source::option);
    EXPECT_DOUBLE_EQ(r.rho, share * size);
    EXPECT_EQ(r.of_model, resolution_of(model).rho);
  }
  const Box box = model.control_box();
  const dvec3 most = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  EXPECT_DOUBLE_EQ(taut::resolution_of(model, size, 0.0).rho, 0x1p-49 * (most.x + most.y + most.z));
  for (const double wrong : {-1e-9, 1.5, infinity, std::nan("")}) {
    expect_invalid([&] { taut::resolution_of(model, size, wrong); }, "from 0 to 1");
  }
}

TEST(Resolution, TextAndBinaryHaveTheSame) {
  for (const Shape& shape : {teapot(), rounded(turned(teapot()), to_float32),
                             rounded(turned(filleted_box(4, 3, 2, 0.5)), to_decimals(7))}) {
    const Model model = make_model(shape);
    const Resolution r = resolution_of(model);
    for (const DocumentEncoding encoding : {DocumentEncoding::json, DocumentEncoding::cbor}) {
      Model read;
      read_document("model", to_document(model, encoding), encoding, read, {});
      EXPECT_EQ(resolution_of(read).rho, r.rho);
      EXPECT_EQ(resolution_of(read).source, r.source);
      EXPECT_EQ(resolution_of(read).worst_join, r.worst_join);
    }
  }
}

TEST(Resolution, NamesAreThoseOfReports) {
  EXPECT_STREQ(name_of(Source::rounding), "rounding");
  EXPECT_STREQ(name_of(Source::floor), "floor");
  EXPECT_STREQ(name_of(Source::coordinates), "coordinates");
  EXPECT_STREQ(name_of(Source::joins), "joins");
  EXPECT_STREQ(name_of(Source::stand_ins), "stand-ins");
  EXPECT_STREQ(name_of(Source::option), "option");
}

TEST(Resolution, TiesAreThoseOfEachPart) {
  Model model = make_model(turned(sphere()));
  model.add_part(make_model(rounded(turned(torus(2, 0.5)), to_decimals(6))).parts()[0], 0);
  Part standing_in = make_model(turned(box(1, 1, 1))).parts()[0];
  standing_in.include_deviation(1e-9);
  model.add_part(std::move(standing_in), 0);
  const Resolution r = resolution_of(model);
  EXPECT_DOUBLE_EQ(r.rho, 2e-6);
  const Box clean = model.parts()[0].control_box();
  const dvec3 most = glm::max(glm::abs(clean.lower), glm::abs(clean.upper));
  EXPECT_DOUBLE_EQ(tie_of(model, 0, r), 0x1p-49 * (most.x + most.y + most.z));
  EXPECT_DOUBLE_EQ(tie_of(model, 1, r), 2e-6 / 8);
  EXPECT_DOUBLE_EQ(tie_of(model, 2, r), 1e-9);
  // At a coarser resolution, what rounding to six decimals does to a point.
  EXPECT_DOUBLE_EQ(tie_of(model, 1, taut::resolution_of(model, 1, 1e-3)), std::sqrt(0.75) * 1e-6);
  // No coarser than an eighth, be it of the finest there is.
  const Resolution finest = taut::resolution_of(model, 1, 0.0);
  for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(tie_of(model, k, finest), finest.rho / 8);
  // Far away doubles are coarser.
  model.add_instance(0, {skew_rotation(), dvec3(0, 3e6, 0)});
  EXPECT_NEAR(tie_of(model, 3, r), 0x1p-49 * 3e6, 0x1p-49 * 10);
}

/// How far points that lay in the plane of three corners are from it once all are rounded.
TEST(Resolution, CoversPointsOfRoundedPlanes) {
  Random random(7);
  double worst = 0;
  const auto image = [](const dvec3& x) {
    return dvec3(to_decimals(6)(x.x), to_decimals(6)(x.y), to_decimals(6)(x.z));
  };
  for (int round = 0; round < 30000; ++round) {
    const std::array<dvec3, 3> corners = {random_point(random), random_point(random),
                                          random_point(random)};
    const double s = uniform(random, 0, 1);
    const double t = uniform(random, 0, 1 - s);
    const dvec3 inside = (1 - s - t) * corners[0] + s * corners[1] + t * corners[2];
    const dvec3 a = image(corners[0]);
    const dvec3 n = glm::cross(image(corners[1]) - a, image(corners[2]) - a);
    if (glm::length(n) < 0.01) continue;
    worst = std::max(worst, std::abs(glm::dot(image(inside) - a, glm::normalize(n))));
  }
  EXPECT_LE(worst, grid_resolution * 0.5e-6);
  EXPECT_GE(worst, grid_resolution * 0.5e-6 / 4);
}

}  // namespace
}  // namespace taut_test::resolutions
