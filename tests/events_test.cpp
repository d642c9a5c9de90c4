// Scenes whose hulls show one event or one degeneracy each. What is expected follows from geometry
// alone: see the comment of each scene.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exact_checks.h"
#include "freeform.h"
#include "taut/hull/precise_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

constexpr int unknown = -1;

struct Expected {
  FaceCounts faces;
  int triple_points = unknown;
  int free_ends = unknown;
  double volume = unknown;
};

HullOptions coarse_options() {
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  return options;
}

Hull expect_exact(const Scene& scene, const Expected& expected) {
  Hull hull = precise_hull(scene, coarse_options());
  if (hull.boundary == nullptr) {
    ADD_FAILURE() << "no boundary";
    return hull;
  }
  expect_complete(*hull.boundary);
  EXPECT_EQ(face_counts(*hull.boundary), expected.faces);
  const CurveEnds ends = curve_ends(*hull.boundary);
  if (expected.triple_points != unknown) {
    EXPECT_EQ(ends.triple_points, expected.triple_points);
  }
  if (expected.free_ends != unknown) {
    EXPECT_EQ(ends.free_ends, expected.free_ends);
  }
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
  const BoundaryMeasures measured = measures_of(scene, hull);
  EXPECT_LE(measured.accuracy, 1e-9);
  if (expected.volume != unknown) {
    EXPECT_NEAR(measured.volume, expected.volume, 1e-9 * expected.volume);
  }
  return hull;
}

Hull expect_exact(const Shape& shape, const Expected& expected) {
  return expect_exact(make_scene(shape), expected);
}

/// Of a closed surface without creases, of one source face: Euler's relation too.
Hull expect_smooth(const Shape& shape, const Expected& expected) {
  Hull hull = expect_exact(shape, expected);
  const CurveEnds ends = curve_ends(*hull.boundary);
  EXPECT_EQ(ends.surplus, 2 * region_characteristic(*hull.boundary) - 4);
  return hull;
}

Shape ball(double r, const dvec3& center) {
  // Turned, so that nothing lines up by chance.
  return shifted(mapped(sphere(r), skew_rotation()), center);
}

// ---- Straight edges

/// Their ends are contacts, wherever they are divided.
TEST(Events, StraightEdgesOfManyPieces) {
  const NurbsSurface sheet{1, 1, {0, 0, 0.3, 0.6, 1, 1}, {0, 0, 0.4, 1, 1}, [] {
                             std::vector<dvec4> points;
                             for (const double x : {0.0, 0.3, 0.6, 1.0}) {
                               for (const double y : {0.0, 0.4, 1.0})
                                 points.emplace_back(x, y, 0, 1);
                             }
                             return points;
                           }()};
  const Shape pyramid = {{sheet}, {}, {{0.4, 0.3, 1}}};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    expect_exact(mapped(split(box(1, 2, 3), 0.3, 0.6), turn), {{0, 0, 6}, unknown, unknown, 6});
    expect_exact(mapped(pyramid, turn), {{0, 0, 5}, unknown, unknown, 1.0 / 3});
  }
}

// ---- Curves and patches

/// z = 4 x^3 - 3 x has three points at its top and at its bottom each: two facets with three arcs.
/// Two arcs end where the torsion vanishes, so four arcs in all.
void expect_tied_curve(double start) {
  const Hull hull = expect_exact(tied_curve(start), {{0, 4, 2}, 2, 2});
  const double unit = hull.boundary->frame.length_to_model(1);
  for (const HullFace& face : hull.boundary->faces) {
    if (face.kind != FaceKind::facet) continue;
    EXPECT_NEAR(std::abs(face.n.z), 1, 1e-12);
    ASSERT_EQ(face.points.size(), 3U);
    const dvec3 normal =
        glm::cross(face.points[1] - face.points[0], face.points[2] - face.points[0]);
    EXPECT_NEAR(0.5 * glm::length(normal) * unit * unit, 0.75 * std::sqrt(3.0), 1e-11);
  }
}

TEST(Events, TiedCurve) { expect_tied_curve(0.3); }

/// The pieces' joints lie in the free ends.
TEST(Events, TiedCurveWithJointsInItsFreeEnds) { expect_tied_curve(0); }

/// The scroll that ends in the godron runs to the border y = 1, whose wall is a facet as those of
/// the other three borders, which are planar curves; the four corners lie in a plane by symmetry.
TEST(Events, Godron) {
  const Hull hull = expect_exact(godron(1, 0.5, 1), {{1, 1, 5}, 0, 1});
  const SceneFrame& frame = hull.boundary->frame;
  for (const SeparatingArc& arc : hull.boundary->arcs) {
    for (const int end : {0, 1}) {
      if (arc.closed || arc.facet[std::size_t(end)] >= 0) continue;
      const Ruling& last =
          end == 0 ? arc.pieces.front().rulings.front() : arc.pieces.back().rulings.back();
      EXPECT_NEAR(glm::distance(last.n, dvec3(0, 0, 1)), 0, 1e-6);
      EXPECT_NEAR(glm::distance(last.point[0], frame.to_frame(dvec3(0.0))), 0, 1e-6);
    }
  }
}

// ---- Dents

/// Up to an affine map a dented sphere, on which the hull touches the dent's rim where the circles
/// do that fit into it: their centres form a tree with an end at each of the rim's lobes. A valley
/// has one scroll across it, which dies at both ends.
TEST(Events, DentWithinAPatch) { expect_smooth(ellipsoid_with_a_valley(), {{1, 1, 0}, 0, 2}); }

/// Three valleys that meet: a scroll across each, which dies outside and ends in one facet inside.
/// The patch is the affine image of an equilateral triangle on the sphere: its rim is nearest, and
/// so highest, in the middle of three sides.
TEST(Events, ThreefoldDentWithinAPatch) {
  expect_smooth(ellipsoid_with_a_threefold_dent(), {{1, 3, 1}, 1, 3});
}

TEST(Events, DentAcrossPatches) {
  expect_smooth(split(ellipsoid_with_a_valley(), 0.48, 0.53), {{1, 1, 0}, 0, 2});
}

TEST(Events, ThreefoldDentAcrossPatches) {
  expect_smooth(split(ellipsoid_with_a_threefold_dent(), 0.48, 0.53), {{1, 3, 1}, 1, 3});
}

/// However many lobes the rims have: of each tree of curves, facets are its nodes of degree three.
void expect_dents(const std::vector<Dent>& dents, double start) {
  const Scene scene = make_scene(dented_body(dents, start));
  const Hull hull = precise_hull(scene, {.relative = 1e-2, .threads = 1, .progress = {}});
  expect_complete(*hull.boundary);
  const FaceCounts faces = face_counts(*hull.boundary);
  const CurveEnds ends = curve_ends(*hull.boundary);
  const int trees = int(dents.size());
  EXPECT_EQ(faces, (FaceCounts{1, 2 * ends.triple_points + trees, ends.triple_points}));
  EXPECT_EQ(ends.free_ends, ends.triple_points + 2 * trees);
  EXPECT_EQ(region_characteristic(*hull.boundary), 2 - trees);
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
}

TEST(Events, DentsInASpline) {
  const dvec3 one(0.8, 0.5, 0.2);
  const dvec3 other(-0.7, -0.6, -0.1);
  for (const double turn : {0.0, 0.7, 1.4}) {
    SCOPED_TRACE(turn);
    expect_dents({{one, 2, turn}}, 0);
    expect_dents({{one, 3, turn}}, 0.2 * turn);
    expect_dents({{one, 2, turn}, {other, 3, turn}}, 0.1);
  }
}

/// It is hollow along x above its middle, and bends away across and at its sides.
TEST(Events, Bean) { expect_smooth(bean(), {{1, 1, 0}, 0, 2}); }

TEST(Events, DentedEllipsoid) { expect_smooth(dented_ellipsoid(), {{1, 1, 0}, 0, 2}); }

/// A plane touches all of the rim: a disc, in which no curve ends.
TEST(Events, CraterOfRevolution) { expect_smooth(dented(), {{1, 0, 1}, 0, 0}); }

/// The scroll is a piece of a cone, between two caps.
TEST(Events, Dumbbell) { expect_smooth(dumbbell(), {{2, 1, 0}, 0, 0}); }

// ---- Several bodies

/// As the oloid between two circles: one closed scroll, one connected part of each torus.
TEST(Events, LinkedTori) {
  const Shape ring = torus(1, 0.25);
  const dmat3 upright(1, 0, 0, 0, 0, -1, 0, 1, 0);
  expect_smooth(ring + mapped(ring, upright, {1, 0, 0}), {{2, 1, 0}, 0, 0});
  const dmat3 tilt(1, 0, 0, 0, 0.96, 0.28, 0, -0.28, 0.96);
  expect_smooth(ring + mapped(torus(0.9, 0.2), tilt * upright, {1, 0.1, 0.05}), {{2, 1, 0}, 0, 0});
}

TEST(Events, OverlappingSpheres) {
  expect_smooth(ball(1, {0, 0, 0}) + ball(0.8, {0.3, 0.5, 0.7}), {{2, 1, 0}, 0, 0});
}

TEST(Events, SphereWithinAnother) {
  expect_smooth(ball(1, {0, 0, 0}) + ball(0.5, {0.1, 0.2, 0.3}), {{1, 0, 0}, 0, 0, 4 * pi / 3});
}

TEST(Events, BeanWithinASphere) {
  expect_smooth(ball(3, {0, 0, 0}) + bean(), {{1, 0, 0}, 0, 0, 36 * pi});
}

TEST(Events, SphereTouchingAnotherFromInside) {
  for (const dvec3& d : {dvec3(0, 0, 0.5), 0.5 * dvec3(0.36, 0.48, 0.8)}) {
    expect_smooth(sphere() + shifted(sphere(0.5), d), {{1, 0, 0}, 0, 0, 4 * pi / 3});
  }
}

TEST(Events, SpheresTouchingFromOutside) {
  const Shape two = ball(1, {0, 0, 0}) + ball(1, 2.0 * dvec3(0.36, 0.48, 0.8));
  expect_smooth(two, {{2, 1, 0}, 0, 0, 4 * pi / 3 + 2 * pi});
}

/// Edge circle, tip and sphere are bounded by each other: three arcs between two facets. The third
/// facet is the cone's base.
TEST(Events, ConeBesideASphere) {
  expect_exact(solid_cone(1, 2) + ball(1, {3.5, 0.3, 1.5}), {{1, 3, 3}, 2, 0});
}

// ---- Coincident geometry

/// The same hull, given once, as two instances, as two surfaces of a part and as two parts.
void expect_same_twice(const Shape& shape, const Expected& expected) {
  const auto expect = [&](const Model& model, const char* name) {
    SCOPED_TRACE(name);
    expect_exact(Scene(model, {.threads = 1, .progress = {}}), expected);
  };
  const Model once = make_model(shape);
  expect(once, "once");
  Model instances = once;
  instances.add_instance(0, RigidMotion{});
  expect(instances, "two instances");
  expect(make_model(shape + shape), "two surfaces");
  Model parts = once;
  parts.add_part(once.parts()[0], 0);
  expect(parts, "two parts");
}

TEST(Events, SphereTwice) { expect_same_twice(sphere(), {{1, 0, 0}, 0, 0, 4 * pi / 3}); }
TEST(Events, BeanTwice) { expect_same_twice(bean(), {{1, 1, 0}, 0, 2}); }
TEST(Events, CylinderTwice) {
  expect_same_twice(solid_cylinder(1, 2), {{0, 1, 2}, unknown, 0, 2 * pi});
}
TEST(Events, BoxTwice) { expect_same_twice(box(1, 2, 3), {{0, 0, 6}, 0, 0, 6}); }

/// Nothing of the lid between them is left, and the scroll runs past it.
TEST(Events, StackedCylinders) {
  const Shape one = solid_cylinder(1, 1);
  expect_exact(one + shifted(one, {0, 0, 1}), {{0, 1, 2}, unknown, 0, 2 * pi});
}

TEST(Events, BoxesSideBySide) {
  const Shape one = box(1, 2, 3);
  expect_exact(one + shifted(one, {1, 0, 0}), {{0, 0, 6}, 0, 0, 12});
}

// ---- Contacts in line

/// A convex arc in the plane z = 0 from (-1, 0) to (1, 0), below y = 0.
struct Arc {
  std::vector<dvec3> points;  ///< Bezier
  double area = 0;            ///< between it and its chord

  NurbsCurve curve(double z) const {
    BezierCurve result;
    for (const dvec3& p : points) result.points.emplace_back(p.x, p.y, z, 1);
    return as_nurbs(result);
  }
  /// The sheet from z = 0 to z = 1.
  NurbsSurface sheet() const {
    BezierPatch result{int(points.size()) - 1, 1, {}};
    for (const dvec3& p : points) {
      for (const double z : {0.0, 1.0}) result.points.emplace_back(p.x, p.y, z, 1);
    }
    return as_nurbs(result);
  }
};

/// A parabola; and a cubic whose curvature vanishes at its end, as that of natural splines does.
std::vector<Arc> arcs() {
  return {{{{-1, 0, 0}, {0, -2, 0}, {1, 0, 0}}, 4.0 / 3},
          {{{-1, 0, 0}, {0, -2, 0}, {0.5, -1, 0}, {1, 0, 0}}, 1.5}};
}

/// The middle one of three equal spheres touches the scroll of the others all around.
TEST(Events, SpheresInARow) {
  const dvec3 along = skew_rotation() * dvec3(0, 0, 3);
  const Shape row = ball(1, -along) + ball(1, dvec3(0.0)) + ball(1, along);
  expect_exact(row, {{2, 1, 0}, 0, 0, 4 * pi / 3 + 6 * pi});
}

/// The middle one of three equal curves lies on the scroll between the others; two lids, and a flat
/// side through the curves' ends.
TEST(Events, CurvesInARow) {
  for (const Arc& arc : arcs()) {
    Shape row;
    for (const double z : {0.0, 1.0, 2.0}) row.curves.push_back(arc.curve(z));
    expect_exact(mapped(row, skew_rotation()), {{0, 1, 3}, unknown, 0, 2 * arc.area});
  }
}

/// A sheet and a point in line with its last ruling: a lid, the flat side, and a facet of no area,
/// where the sheet, the cone from the point and the edge of the flat side meet along one line.
TEST(Events, PointInLineWithARuling) {
  for (const Arc& arc : arcs()) {
    for (const double side : {1.0, -1.0}) {
      const Shape shape = {{arc.sheet()}, {}, {{side, 0, 2}}};
      const Expected expected = {{0, 2, 3}, unknown, 0, 4 * arc.area / 3};
      expect_exact(mapped(shape, skew_rotation()), expected);
    }
  }
}

// ---- A parabolic curve that touches a border

/// z = F(u) G(v), both positive and convex, G least in the middle, F flat at u = 0: the parabolic
/// curve touches the border there in its middle, whose plane supports the sheet from below. Two
/// curves end in it, one from either side.
TEST(Events, ParabolicCurveTouchingABorder) {
  const std::array<double, 4> f = {2, 1.5, 1, 1.2};
  const std::array<double, 3> g = {1, 0, 1};
  BezierPatch sheet{3, 2, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      sheet.points.emplace_back(double(i) / 3, double(j) / 2, f[i] * g[j], 1);
    }
  }
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(Shape{{as_nurbs(sheet)}, {}, {}}, turn));
    const Hull hull = precise_hull(scene, {.relative = 1e-2, .threads = 1, .progress = {}});
    ASSERT_NE(hull.boundary, nullptr);
    expect_complete(*hull.boundary);
    const dvec3 middle = hull.boundary->frame.to_frame(turn * dvec3(0, 0.5, 1));
    const dvec3 normal = turn * glm::normalize(dvec3(-0.75, 0, -1));
    int ends = 0;
    for (const SeparatingArc& arc : hull.boundary->arcs) {
      for (const std::size_t e : {0U, 1U}) {
        if (arc.closed || arc.facet[e] >= 0) continue;
        const Ruling& r =
            e == 0 ? arc.pieces.front().rulings.front() : arc.pieces.back().rulings.back();
        if (glm::distance(r.point[0], middle) > 1e-3) continue;
        EXPECT_LT(glm::distance(r.point[0], middle), 1e-10);
        EXPECT_LT(glm::distance(r.n, normal), 1e-9);
        ++ends;
      }
    }
    EXPECT_EQ(ends, 2);
    const BoundaryFacts facts = boundary_facts(scene, hull, 300);
    EXPECT_TRUE(facts.sound()) << facts;
    EXPECT_LE(measures_of(scene, hull).accuracy, 1e-9);
  }
}

// ---- Faces beside straight edges

/// A sheet over x in [-1, 1], y in [0, 1], of degree (2, 3): z = -(a x^2 + b x + c) y - (d x^2 + e)
/// y^power, the power being 2 or 3.
Shape sheet_beside_an_edge(const dvec3& rise, double d, double e, int power) {
  const auto square = [](const dvec3& f) {  // Bernstein coefficients over [-1, 1]
    return std::array<double, 3>{f.x - f.y + f.z, f.z - f.x, f.x + f.y + f.z};
  };
  const std::array<double, 3> linear = square(rise);
  const std::array<double, 3> bent = square({d, 0, e});
  BezierPatch sheet{2, 3, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double y = double(j) / 3;
      const double raised = j == 3 ? 1 : j == 2 && power == 2 ? 1.0 / 3 : 0;
      sheet.points.emplace_back(double(i) - 1, y, -linear[i] * y - bent[i] * raised, 1);
    }
  }
  return {{as_nurbs(sheet)}, {}, {}};
}

/// The hull, with a facet in z = 0 whose corners are those of the edge y = 0 at these x. `thin`:
/// of a row of patches at the edge.
void expect_in_line(const Shape& sheet, const std::vector<double>& corners, double thin = 1e-3) {
  for (const Shape& shape : {sheet, split(sheet, 0.55, 0.5), split(sheet, 0.3, thin)}) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const Scene scene = make_scene(mapped(shape, turn));
      const Hull hull = precise_hull(scene, coarse_options());
      ASSERT_NE(hull.boundary, nullptr);
      expect_complete(*hull.boundary);
      const dvec3 normal = turn * dvec3(0, 0, 1);
      const auto touches = [&](const HullFace& face) {
        const auto has = [&](double x) {
          const dvec3 place = hull.boundary->frame.to_frame(turn * dvec3(x, 0, 0));
          return std::any_of(face.points.begin(), face.points.end(), [&](const dvec3& point) {
            return glm::distance(point, place) < 1e-9;
          });
        };
        return face.kind == FaceKind::facet && glm::distance(face.n, normal) < 1e-12 &&
               std::all_of(corners.begin(), corners.end(), has);
      };
      const std::vector<HullFace>& faces = hull.boundary->faces;
      EXPECT_EQ(std::count_if(faces.begin(), faces.end(), touches), 1);
      BoundaryFacts facts = boundary_facts(scene, hull, 300);
      facts.flat = 0;  // as it is beside the edge
      EXPECT_TRUE(facts.sound()) << facts;
      EXPECT_LE(measures_of(scene, hull).accuracy, 1e-9);
    }
  }
}

/// z = -((x - 0.1)^2 y + y^m): the plane that turns about the edge y = 0 meets the sheet in
/// (0.1, 0, 0), as z = 0, in line with the edge's ends. A curve leads from there to each of them.
TEST(Events, FaceTouchedInsideOfItsStraightEdge) {
  for (const int power : {2, 3}) {
    SCOPED_TRACE(power);
    expect_in_line(sheet_beside_an_edge({1, -0.2, 0.01}, 0, 1, power), {-1, 0.1, 1});
  }
}

/// z = -(1 + x^2) y^m: a plane that turns on from z = 0 by d is surpassed over (x, 0) by
/// f = (1 + x^2)^(-1/(m - 1)), up to a factor that d tells. The concave hull of f over [-1, 1] has
/// chords from both ends, tangent to it: for m = 2 where x = sqrt 2 - 1.
TEST(Events, FaceTouchedAlongItsStraightEdge) {
  for (const int power : {2, 3}) {
    SCOPED_TRACE(power);
    const double exponent = -1.0 / (power - 1);
    const auto misses = [&](double x) {
      const double f = std::pow(1 + x * x, exponent);
      const double slope = 2 * x * exponent * f / (1 + x * x);
      return f + slope * (1 - x) < std::pow(2, exponent);
    };
    double low = 0;
    double high = 0.9;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (misses(middle) ? high : low) = middle;
    }
    if (power == 2) {
      EXPECT_NEAR(low, std::sqrt(2) - 1, 1e-14);
    }
    // Along the edge the curvature falls with y^m: of thinner patches it is rounding.
    expect_in_line(sheet_beside_an_edge(dvec3(0.0), 1, 1, power), {-1, -low, low, 1}, 0.4);
  }
}

// ---- Tips, open borders, flat faces

/// All directions of a fan belong to each tip; the surface itself is the hull.
TEST(Events, Lemon) { expect_exact(lemon(), {{1, 0, 0}, 0, 0}); }

TEST(Events, Ogive) {
  expect_exact(ogive(), {{1, 0, 1}, 0, 0});
  expect_exact(ogive() + disc(1, 0), {{1, 0, 1}, 0, 0});
}

/// The outer half of the tube; half discs above and below; and the two ends' circles, which lie in
/// one plane with the segments between them.
TEST(Events, HalfTorus) {
  expect_exact(half_torus(1, 0.25), {{1, 0, 3}, 0, 0});
  expect_exact(mapped(half_torus(1, 0.25), skew_rotation()), {{1, 0, 3}, 0, 0});
}

/// The floor touches four corners of the box and the sphere. Counter-clockwise around the sphere it
/// meets: the floor, a lower corner beside it (cone), that one's lower edge (facet), the lower
/// corner farther away (cone), the upright edge there (facet), the upper corner (cone), the upper
/// edge (facet), and the same mirrored. The box's far side is the seventh facet.
TEST(Events, SphereAndBoxOnTheFloor) {
  const Shape on_floor = shifted(box(2, 1.4, 1.5), {-1, -0.7, 0}) + ball(1, {3, 0, 1});
  expect_exact(on_floor, {{1, 6, 7}, 5, 0});
}

/// The torus touches the lid's plane in a circle, within the hull. Above a disc, below four cones
/// from the lid's corners between four facets on its edges; five faces of the box.
TEST(Events, TorusOnTheLidOfABox) {
  const Shape lid = shifted(box(4, 4, 1), {-2, -2, -1});
  expect_exact(lid + shifted(torus(1, 0.25), {0, 0, 0.25}), {{1, 4, 10}, 4, 0});
}

/// The floor touches all of a circle and the box's corners: a facet with a curved side. The disc
/// above, the box's far side and two upright edges and an upper one with the torus make five more;
/// the cones' tips are its four far corners.
TEST(Events, TorusAndBoxOnTheFloor) {
  const Shape low = shifted(box(2, 1.2, 0.3), {-1, -0.6, 0});
  expect_exact(low + shifted(torus(1, 0.25), {4, 0, 0.25}), {{1, 4, 6}, 3, 0});
}

/// Rounded edges bend away from the floor: four corners of the flat face within them and the ball
/// make one facet, and the flat face on the far side another, beside those with three contacts.
TEST(Events, FilletedBoxOnTheFloorBesideABall) {
  const Shape rounded = shifted(filleted_box(2, 1.4, 1.5, 0.2), {0, 0, 0.75});
  const Scene scene = make_scene(rounded + ball(1, {3, 0, 1}));
  const Hull hull = precise_hull(scene, {.relative = 1e-2, .threads = 1, .progress = {}});
  ASSERT_NE(hull.boundary, nullptr);
  expect_complete(*hull.boundary);
  std::vector<std::size_t> sizes;
  for (const HullFace& face : hull.boundary->faces) {
    if (face.kind == FaceKind::facet && face.contacts.size() != 3) {
      sizes.push_back(face.contacts.size());
    }
  }
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{4, 5}));
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
}

}  // namespace
}  // namespace taut
