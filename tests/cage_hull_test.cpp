#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "cages.h"
#include "judge/judge.h"
#include "models.h"
#include "sound_hull.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/model_support.h"
#include "taut/bounds/scene.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/io/document/boundary_document.h"
#include "taut/verify/verify_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: cages

Hull whole_hull(const Model& model, const std::string& name) {
  const Hull hull = convex_hull(model, {.relative = 1e-2, .progress = {}});
  EXPECT_TRUE(hull.boundary) << name;
  if (hull.boundary && !hull.boundary->unresolved.empty()) {
    ADD_FAILURE() << name << ": " << hull.boundary->unresolved.size()
                  << " unresolved: " << hull.boundary->unresolved.front().reason;
  }
  return hull;
}

/// The document of an exact hull is that of the model's, checked by what it says alone.
void expect_verified(const Model& model, const Hull& hull, const std::string& name,
                     double tolerance = 1e-12) {
  const Scene scene(model);
  VerifyOptions options;
  options.random_directions = 2000;
  const HullVerification found = verify(document_of(scene, hull), scene, options);
  EXPECT_EQ(found.euler, 2) << name;
  EXPECT_TRUE(found.closed) << name;
  EXPECT_TRUE(found.is_hull(tolerance)) << name << ": " << text_of(found);
}

/// As a file holds it. Compilers have taken rounding there and back of two numbers at once for
/// none.
dvec3 to_float32(dvec3 x) {
  for (int i = 0; i < 3; ++i) {
    volatile float rounded = float(x[i]);
    x[i] = double(rounded);
  }
  return x;
}

/// Permutations of coordinates with an even number of changed signs; for the cube any number.
void expect_symmetry(const Model& model, bool all_signs, const std::string& name) {
  const Scene scene(model);
  SupportQuery query(scene);
  const double bound = 2 * model.deviation_bound() + 1e-13;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 50; ++k) {
    const dvec3 n = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    const double h = support(query, scene, n).h;
    for (int signs = 0; signs < 8; ++signs) {
      const dvec3 s((signs & 1) != 0 ? -1 : 1, (signs & 2) != 0 ? -1 : 1,
                    (signs & 4) != 0 ? -1 : 1);
      if (!all_signs && s.x * s.y * s.z < 0) continue;
      for (const dvec3& p : {n, dvec3(n.y, n.z, n.x), dvec3(n.z, n.x, n.y), dvec3(n.y, n.x, n.z),
                             dvec3(n.x, n.z, n.y), dvec3(n.z, n.y, n.x)}) {
        EXPECT_NEAR(support(query, scene, s * p).h, h, bound) << name;
      }
    }
  }
}

// Closed and convex: all of the limit surface is its hull, proven cell by cell.
TEST(CageHull, OfCubeAndTetrahedra) {
  struct Case {
    std::string name;
    ControlCage cage;
    double accuracy;
    bool all_signs;
  };
  for (const Case& c :
       {Case{"cube", cube_cage(), 1e-9, true},
        Case{"tetrahedron", tetrahedron_cage(CageScheme::catmark), 1e-9, false},
        Case{"tetrahedron, loop", tetrahedron_cage(CageScheme::loop), 1e-6, false}}) {
    const Model model = cage_model(c.cage, c.accuracy);
    const Hull hull = whole_hull(model, c.name);
    EXPECT_EQ(hull.statistics.map_undecided, 0) << c.name;
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), 0) << c.name;
    EXPECT_EQ(hull.boundary->count(FaceKind::scroll), 0) << c.name;
    EXPECT_EQ(hull.boundary->count(FaceKind::patch), int(c.cage.faces.size())) << c.name;
    expect_symmetry(model, c.all_signs, c.name);
  }
}

/// A regular torus has a crest on its top and its bottom, and two flat disks; with a NURBS model, a
/// curve and points it makes one hull.
TEST(CageHull, OfTorusAndMixedScenes) {
  const Model ring = cage_model(torus_cage(6, 5));
  const Hull torus = whole_hull(ring, "torus");
  ASSERT_TRUE(torus.boundary);
  expect_verified(ring, torus, "torus");
  EXPECT_EQ(torus.boundary->count(FaceKind::facet), 2);
  EXPECT_EQ(torus.boundary->count(FaceKind::scroll), 0);
  Model mixed = cage_model(torus_cage(6, 5));
  Part others;
  const Shape pot = teapot();
  for (const auto& surface : pot.surfaces) others.add_surface(surface, "pot");
  others.add_point({0, 0, 2});
  others.add_point({3, 0, 0});
  NurbsCurve line;
  line.degree = 1;
  line.knots = {0, 0, 1, 1};
  line.points = {{0, -3, 0, 1}, {0, -3, 1, 1}};
  others.add_curve(line, "line");
  mixed.add_part(std::move(others), smooth_join_angle);
  const Hull hull = convex_hull(mixed, {.relative = 1e-2, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_EQ(hull.kind, HullKind::solid);
}

/// A bent cube of five faces and two quads beside it.
ControlCage cube_and_strip_cage() {
  ControlCage cage;
  cage.points = {{0.1219, 0.0969, -0.1371}, {-0.1939, -0.0102, 1.0762}, {-0.0147, 0.8542, -0.0496},
                 {0.1435, 0.8619, 1.1048},  {1.0523, 0.0481, 0.0767},   {0.9454, -0.0118, 1.1802},
                 {0.9615, 0.9581, -0.1401}, {0.9532, 1.074, 1.125},     {1.6191, -0.0564, 1.7309},
                 {1.6397, 0.7742, 2.1121},  {2.1215, 2.2544, 1.4898},   {3.1138, 0.309, 2.2132},
                 {3.5261, 0.8605, 1.9992},  {3.0539, 1.8818, 1.9726}};
  cage.faces = {{0, 1, 3, 2}, {0, 4, 5, 1},   {2, 3, 7, 6},   {0, 2, 6, 4},
                {1, 5, 7, 3}, {8, 11, 12, 9}, {9, 12, 13, 10}};
  cage.creases = {{{0, 2}, 10}, {{2, 3}, 3}};
  return cage;
}

/// A separating curve's contact crosses into an edge beside the point in which the face's convex
/// region touches it: the contacts that give way to each other there differ in height by less than
/// rounding.
TEST(CageHull, WhereFacesAreLevelAcrossEdges) {
  const Model model = cage_model(cube_and_strip_cage());
  const Hull hull = whole_hull(model, "cube and strip");
  ASSERT_TRUE(hull.boundary);
  const Scene scene(model);
  VerifyOptions options;
  options.random_directions = 2000;
  const HullVerification found = verify(hull_document(scene, *hull.boundary), scene, options);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.euler, 2);
  EXPECT_EQ(found.uncovered, 0);
  EXPECT_LE(found.worst_length(), 1e-12 + found.rounding);
}

/// A face far below sheets makes them small: where parabolic curves touch their boundaries, in ends
/// of two separating curves each, rounding leaves nothing of the curvature. The parts of their
/// boundaries on the hull are those between these ends.
TEST(CageHull, OfSmallSheets) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 16; ++k) {
    ControlCage cage = sheet_cage(4, 4);
    for (dvec3& x : cage.points) x = 0.04 * (x + dvec3(0, 0, 0.03 * normal(random)));
    const int first = int(cage.points.size());
    for (const dvec3& x :
         {dvec3(-1, -1, -2), dvec3(1, -1, -2), dvec3(1, 1, -2), dvec3(-1, 1, -2)}) {
      cage.points.push_back(x);
    }
    cage.faces.push_back({first, first + 1, first + 2, first + 3});
    whole_hull(cage_model(cage), "sheet " + std::to_string(k));
  }
}

/// In a corner of the sheet that is a planar quad the surface is flat to second order, and two
/// contacts merge in it.
TEST(CageHull, OfASheetWithAPlanarCorner) {
  const std::array<int, 16> heights = {-2, -1, -1, 0, -2, -1, 0, -2, 0, 1, 2, 1, 1, 2, 1, 0};
  ControlCage cage = sheet_cage(3, 3);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    cage.points[k] = 0.1 * dvec3(double(k / 4), double(k % 4), heights[k]);
  }
  for (const dvec3& x : {dvec3(3, 3, -1), dvec3(4, 3, -1), dvec3(4, 4, -1), dvec3(3, 4, -1)}) {
    cage.points.push_back(x);
  }
  cage.faces.push_back({16, 17, 18, 19});
  whole_hull(cage_model(cage), "sheet");
}

/// The square top, its edges and corners sharp, has a rim of straight edges: in its middle each of
/// the four round sides is touched by a plane that turns about its edge.
TEST(CageHull, OfABoxWithASharpTop) {
  ControlCage cage = rimmed_cage(true);
  for (const CageCrease& edge : rimmed_cage(true).creases) {
    cage.corners.push_back({edge.vertices[0], infinite_sharpness});
  }
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "box");
  // The top and, of no area, one at each of its edges.
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 5);
}

/// The upright edges are sharp too, down to the round bottom: each side is in one plane with the
/// top's edge all along it, and its contacts begin along the middle of that.
TEST(CageHull, OfABoxWithARoundBottom) {
  ControlCage cage = rimmed_cage(true);
  for (int k = 0; k < 4; ++k) cage.creases.push_back({{k, k + 4}, infinite_sharpness});
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "box");
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 5);
  EXPECT_EQ(hull.boundary->count(FaceKind::scroll), 4);
  EXPECT_EQ(hull.boundary->count(FaceKind::patch), 5);
}

/// The rim is a smooth curve; about its corners' limits the patches of the top get thin.
TEST(CageHull, OfCubesWithSharpRims) {
  for (const bool flat : {true, false}) {
    const std::string name = flat ? "flat rim" : "bent rim";
    const Model model = cage_model(rimmed_cage(flat));
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    expect_verified(model, hull, name);
    EXPECT_EQ(hull.boundary->count(FaceKind::patch), 5) << name;
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), flat ? 1 : 0) << name;
    EXPECT_EQ(hull.boundary->count(FaceKind::scroll), flat ? 0 : 1) << name;
  }
}

/// Smooth but for sharp vertices: the surface comes to a point there, and is concave around.
TEST(CageHull, OfCubesWithApexes) {
  for (const int count : {1, 4}) {
    const std::string name = std::to_string(count) + " apexes";
    ControlCage cage = cube_cage();
    for (int v = 0; v < count; ++v) cage.corners.push_back({v, infinite_sharpness});
    for (const bool loop : {false, true}) {
      const Model model = cage_model(loop ? triangulated(cage) : cage);
      EXPECT_LE(model.deviation_bound(), 1e-8) << name;
      const Hull hull = whole_hull(model, name);
      ASSERT_TRUE(hull.boundary);
      expect_verified(model, hull, name);
    }
  }
}

/// At the notch's ends, regular vertices of the cage, the Gaussian curvature vanishes: contacts of
/// two patches that only have the corner in common merge there.
TEST(CageHull, OfLProfiles) {
  for (const bool has_rim : {false, true}) {
    ControlCage cage = l_profile_cage();
    for (int k = 0; k < 6 && has_rim; ++k) {
      cage.creases.push_back({{6 + k, 6 + (k + 1) % 6}, infinite_sharpness});
    }
    const std::string name = has_rim ? "L profile with a rim" : "L profile";
    const Model model = cage_model(cage);
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    expect_verified(model, hull, name);
  }
}

/// Rounded about its edges: faces and edges keep flat and cylindrical middles, beside which other
/// patches are level.
ControlCage semi_sharp_cube() {
  ControlCage cage = cube_cage();
  for (int v = 0; v < 8; ++v) {
    for (const int axis : {1, 2, 4}) {
      if ((v & axis) == 0) cage.creases.push_back({{v, v | axis}, 2});
    }
  }
  return cage;
}

/// By Gauss quadrature of the support function: 2.690348304 of 600 by 1200 directions, 2.690348259
/// of 1500 by 3000, the error of which falls with their number.
TEST(CageHull, MeanWidthOfASemiSharpCube) {
  const Hull hull = whole_hull(cage_model(semi_sharp_cube()), "semi-sharp cube");
  ASSERT_TRUE(hull.boundary);
  const Scene scene(cage_model(semi_sharp_cube()));
  EXPECT_NEAR(measure(scene, ContactGeometry(scene), *hull.boundary).mean_width, 2.690348254, 1e-8);
}

TEST(CageHull, OfASemiSharpCube) {
  const Model model = cage_model(semi_sharp_cube());
  const Hull hull = whole_hull(model, "semi-sharp cube");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "semi-sharp cube");
}

/// The area in the closed uniform cubic B-spline of these control points.
double area_in_spline(const std::vector<dvec2>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto at = [&](std::size_t k) { return p[(i + k) % p.size()]; };
    // Three Gauss nodes are exact for the fifth degree of x dy - y dx.
    for (const auto& [t, weight] : {std::pair{0.5 - std::sqrt(0.15), 5.0 / 18},
                                    {0.5, 8.0 / 18},
                                    {0.5 + std::sqrt(0.15), 5.0 / 18}}) {
      const double r = 1 - t;
      const dvec2 c = (r * r * r * at(0) + (3 * t * t * t - 6 * t * t + 4) * at(1) +
                       (3 * r * r * r - 6 * r * r + 4) * at(2) + t * t * t * at(3)) /
                      6.0;
      const dvec2 d = 0.5 * (-r * r * at(0) + (3 * t * t - 4 * t) * at(1) +
                             (4 * r - 3 * r * r) * at(2) + t * t * at(3));
      twice += weight * (c.x * d.y - c.y * d.x);
    }
  }
  return 0.5 * std::abs(twice);
}

/// A box without lids is a cone's frustum over such a spline.
double volume_of_tube(int k, double taper) {
  std::vector<dvec2> square;
  for (const dvec2& from : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)}) {
    for (int i = 0; i < k; ++i)
      square.push_back(from + double(i) / k * (dvec2(-from.y, from.x) - from));
  }
  const double top = 1 - 2 * taper;
  return area_in_spline(square) * 2 * (1 + top + top * top) / 3;
}

/// In 3 x 3 quads a side, its middle is plane and the edges' middles are cylinders, beyond whose
/// ends the surface departs with the third power: contacts stay on the seams there.
TEST(CageHull, OfABoxWithFlatSides) {
  ControlCage cage = box_cage({3});
  for (const char* name : {"clean", "turned", "turned and rounded"}) {
    SCOPED_TRACE(name);
    for (dvec3& x : cage.points) {
      if (name == std::string("turned")) x = skew_rotation() * x;
      if (name == std::string("turned and rounded")) x = to_float32(x);
    }
    const Model model = cage_model(cage);
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(hull.boundary->count(FaceKind::patch), 24);
    EXPECT_EQ(hull.boundary->count(FaceKind::scroll), 12);
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), 6);
    for (const HullFace& face : hull.boundary->faces) EXPECT_LE(face.tolerant, hull.resolution.rho);
  }
}

/// In 2 x 2 quads a side, surfaces have no curvature across the sides' middles, where contacts and
/// ends of edges are level; in 3 x 3 the middles are plane, and facets' sides run along seams.
TEST(CageHull, OfBoxesWithoutLids) {
  for (const int k : {2, 3}) {
    for (const double taper : {0.0, 0.1}) {
      for (const bool open_bottom : {false, true}) {
        const std::string name = std::to_string(k) + (open_bottom ? ", both open" : ", open");
        const Model model = cage_model(box_cage({k, taper, true, open_bottom}));
        const Hull hull = whole_hull(model, name);
        ASSERT_TRUE(hull.boundary);
        expect_verified(model, hull, name);
        if (!open_bottom) continue;
        const Scene scene(model);
        const double volume = measure(scene, ContactGeometry(scene), *hull.boundary).volume;
        EXPECT_NEAR(volume, volume_of_tube(k, taper), 1e-11) << name;
      }
    }
  }
}

/// In 3 x 3 squares a side, each of two triangles, the edges' middles are cylinders, and beyond
/// their ends Loop's surface swells by a millionth: scrolls lead from the one swelling to the
/// other, over the cylinder's steepest ruling and up to where it stops to swell; from there on the
/// cylinder itself is on the hull.
TEST(CageHull, OfATriangulatedBox) {
  const Model model = cage_model(triangulated(box_cage({3})));
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "box");
  EXPECT_EQ(hull.boundary->count(FaceKind::scroll), 12);
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 6);
}

/// Cones from the corner touch the sides in curves through the vertices in their middles, about
/// which the surface is plane: there nothing but third derivatives tells the direction.
TEST(CageHull, OfATriangulatedBoxWithACorner) {
  ControlCage cage = triangulated(box_cage({2}));
  const auto corner = std::find(cage.points.begin(), cage.points.end(), dvec3(-1, -1, 1));
  cage.corners.push_back({int(corner - cage.points.begin()), infinite_sharpness});
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  // By caps' deviations patches may be below each other's planes.
  expect_verified(model, hull, "box", 1e-11);
}

/// Separating curves of a sharp edge and of the faces beside it, through or to where both are
/// level: in 3 x 3 quads a side they begin at chords of the facets' sides.
TEST(CageHull, OfBoxesWithASharpEdge) {
  for (const int k : {2, 3}) {
    ControlCage cage = box_cage({k});
    make_sharp(cage, [](const dvec3& x) { return x.x == 1 && x.z == 1; });
    ASSERT_EQ(int(cage.creases.size()), k);
    const std::string name = std::to_string(k) + " edges";
    const Model model = cage_model(cage);
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    expect_verified(model, hull, name);
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), k == 2 ? 0 : 6) << name;
  }
}

/// The sharp edges go on smoothly into each other about the box's corner, above parts of cylinders.
/// Where these end the plane touches a segment: on its other side the face, up to the end of a
/// chord, across which a scroll leaves. That begins where the strip between the two is deeper than
/// the resolution, and may do so more than once; facets on segments, which have no area, are none.
TEST(CageHull, OfABoxWithTwoSharpEdges) {
  ControlCage cage = box_cage({2});
  make_sharp(cage, [](const dvec3& x) { return x.x == 1 && x.z == 1; });
  make_sharp(cage, [](const dvec3& x) { return x.y == -1 && x.z == 1; });
  ASSERT_EQ(int(cage.creases.size()), 4);
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "box");
  EXPECT_GE(hull.boundary->count(FaceKind::scroll), 3);
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 1);
  // What the mesh calls facets is level with them.
  const HullMesh& mesh = hull.mesh;
  std::map<int, dvec3> normals;
  for (const auto f : mesh.faces()) {
    if (mesh.data(f).kind != FaceKind::facet) continue;
    std::vector<dvec3> corners;
    for (const auto v : mesh.fv_range(f)) corners.push_back(position(mesh, v));
    const dvec3 n = unit(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const dvec3& first = normals.emplace(mesh.data(f).hull_face, n).first->second;
    EXPECT_LT(glm::distance(n, first), 1e-9);
  }
  EXPECT_EQ(normals.size(), 1U);
}

/// Beside the sharp edges the sides are cylinders, all along rulings of which planes touch; beyond
/// these they swell by less than directions tell, and what is found there lies in rulings known.
TEST(CageHull, OfABoxWithSharpUprights) {
  ControlCage cage = box_cage({3});
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      make_sharp(cage, [&](const dvec3& p) { return p.x == x && p.y == y; });
    }
  }
  ASSERT_EQ(int(cage.creases.size()), 12);
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "box");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "box");
  EXPECT_EQ(hull.boundary->count(FaceKind::scroll), 16);
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 6);
}

/// A sharp edge of three divisions a side, or all of those of the top: flat middles of the sides
/// reach the edge's straight part, beyond which strips between scrolls get narrower than directions
/// tell apart on their way to the flat sides' planes.
TEST(CageHull, OfBoxesWithFlatSidesUpToSharpEdges) {
  for (const bool all : {false, true}) {
    ControlCage cage = box_cage({3});
    make_sharp(cage, [&](const dvec3& x) { return x.z == 1 && (all || x.x == 1); });
    const std::string name = all ? "lid" : "edge";
    const Model model = cage_model(cage);
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    expect_verified(model, hull, name);
    EXPECT_EQ(hull.boundary->count(FaceKind::patch), all ? 12 : 24) << name;
    EXPECT_EQ(hull.boundary->count(FaceKind::scroll), all ? 8 : 13) << name;
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), 6) << name;
  }
}

/// The same of a rim of four divisions, turned and rounded to floats: sides that were cylinders,
/// with lines across the parameters beside the corners, are bent by rounding.
TEST(CageHull, OfABoxWithASharpRimOfFloats) {
  ControlCage cage = box_cage({4});
  make_sharp(cage, [](const dvec3& x) { return x.z == 1; });
  for (dvec3& x : cage.points) {
    x = skew_rotation() * x;
    x = {double(float(x.x)), double(float(x.y)), double(float(x.z))};
  }
  const Model model = cage_model(cage);
  const Hull hull = whole_hull(model, "rim");
  ASSERT_TRUE(hull.boundary);
  expect_verified(model, hull, "rim");
  EXPECT_EQ(hull.boundary->count(FaceKind::patch), 12);
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 6);
}

/// The curve of an apex and the sides around runs through the flat middles of the sides; of four
/// apexes, ends there, where two of them are in one plane with a middle.
TEST(CageHull, OfBoxesWithApexes) {
  for (const bool all : {false, true}) {
    ControlCage cage = box_cage({2});
    for (int v = 0; v < int(cage.points.size()); ++v) {
      const dvec3& x = cage.points[std::size_t(v)];
      const bool is_top = x.z == 1 && std::abs(x.x) == 1 && std::abs(x.y) == 1;
      if (is_top && (all || x.x + x.y == 2)) cage.corners.push_back({v, infinite_sharpness});
    }
    const std::string name = std::to_string(cage.corners.size()) + " apexes";
    const Model model = cage_model(cage);
    const Hull hull = whole_hull(model, name);
    ASSERT_TRUE(hull.boundary);
    expect_verified(model, hull, name);
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), all ? 5 : 0) << name;
    EXPECT_EQ(hull.boundary->count(FaceKind::scroll), all ? 4 : 1) << name;
  }
}

/// A cage file from elsewhere.
void expect_whole(const char* file, double accuracy, std::optional<Scheme> scheme) {
  const std::optional<Model> model = model_from_elsewhere(file, scheme, accuracy);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with " << file;
  expect_verified(*model, whole_hull(*model, file), file);
}

/// Two rings of quads about a pole, where they have a corner twice.
ControlCage bowl(int sides) {
  ControlCage cage;
  for (const dvec2& ring : {dvec2(1, -0.78), dvec2(0.3, -1)}) {
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      cage.points.emplace_back(ring.x * std::cos(angle), ring.y, ring.x * std::sin(angle));
    }
  }
  cage.points.emplace_back(0, -1, 0);
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    cage.faces.push_back({k, next, sides + next, sides + k});
    cage.faces.push_back({sides + k, sides + next, 2 * sides, 2 * sides});
  }
  return cage;
}

// Needles about a pole support all but equally.
TEST(CageHull, OfAPoleOfNeedles) {
  const Model model = cage_model(bowl(12));
  const HullOptions options{.relative = 1e-3, .progress = {}};
  const Hull hull = convex_hull(model, options);
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_LT(hull.statistics.support_queries, 50'000);
  EXPECT_EQ(hull.kind, HullKind::solid);
  EXPECT_LE(hull.distance_bound, tolerance_for(options, Scene(model).diagonal()));
  for (const auto edge : hull.mesh.halfedges()) EXPECT_FALSE(hull.mesh.is_boundary(edge));
}

/// A unit cube with a corner as far off as a slip of a digit brings it, turned and rounded to
/// float.
ControlCage cube_with_far_corner() {
  ControlCage cage = cube_cage();
  for (dvec3& p : cage.points) p = (p + dvec3(1.0)) / 2.0;
  cage.points[7].x = 4.2e9;
  const dmat3 turn(0.8, 0.6, 0, -0.36, 0.48, 0.8, 0.48, -0.64, 0.6);
  for (dvec3& p : cage.points) p = dvec3(glm::vec3(turn * p));
  cage.creases = {{{0, 1}, 2.5}};
  cage.corners = {{6, 3}};
  return cage;
}

// Next to the far corner the others are one point to rounding: what parts them is not sought long.
TEST(CageHull, OfACubeWithAFarCorner) {
  const HullOptions options{.relative = 1e-3, .progress = {}};
  Hull hull;
  try {
    hull = convex_hull(cage_model(cube_with_far_corner()), options);
  } catch (const HullNotConverged& failure) {
    hull = *failure.best;
  }
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_LT(hull.statistics.support_queries, 30'000);
}

TEST(CageHull, OfSheetsWithCornersAndBoundary) {
  expect_whole("A16_osd_edgecorner_boundary.obj", 1e-9, Scheme::catmark);
}
TEST(CageHull, OfANonManifoldCage) {
  expect_whole("A17_osd_nonmanifold_edges.obj", 1e-9, Scheme::catmark);
}
/// Dents that are no deeper than the resolution lie between ridges of its mudguards.
TEST(CageHull, OfACarWithCreases) {
  expect_whole("A15_osd_car_creases_boundary.obj", 1e-9, std::nullopt);
}
/// Contacts run along planes of symmetry, which are joins of thousands of small patches.
TEST(CageHull, OfSemiSharpLoopCages) {
  expect_whole("A18_osd_loop_icos_semisharp.obj", 1e-9, std::nullopt);
}
TEST(CageHull, OfAnOffTorus) { expect_whole("A19_torus_quad_smooth.off", 1e-9, Scheme::catmark); }
TEST(CageHull, OfATriangulatedCube) { expect_whole("A20_cube_binary.ply", 1e-9, Scheme::catmark); }

/// A sheet over a square lattice with heights and creases at random: straight and bent stretches of
/// borders and creases go on into each other.
ControlCage lattice_cage(unsigned seed) {
  std::mt19937 random(seed);
  ControlCage cage = sheet_cage(3, 3);
  for (dvec3& p : cage.points) p = dvec3(3.0 * p.x, 3.0 * p.y, double(random() % 5));
  constexpr std::array<double, 4> sharpness = {1, 2, 3, infinite_sharpness};
  std::set<std::array<int, 2>> edges;
  for (const std::vector<int>& face : cage.faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const int a = face[k];
      const int b = face[(k + 1) % face.size()];
      if (!edges.insert({std::min(a, b), std::max(a, b)}).second || random() % 4 != 0) continue;
      cage.creases.push_back({{a, b}, sharpness[random() % sharpness.size()]});
    }
  }
  return cage;
}

/// A plane touches a crease in its end and a little beside it, lower by less than the resolution.
TEST(CageHull, OfALatticeWithCornersThatMerge) {
  const Model model = cage_model(lattice_cage(25));
  const Hull hull = whole_hull(model, "lattice 25");
  ASSERT_TRUE(hull.boundary);
  EXPECT_LE(deepest_tolerant(*hull.boundary), hull.resolution.rho);
  expect_verified(model, hull, "lattice 25");
}

TEST(CageHull, OfLattices) {
  for (const unsigned seed :
       {0U,  1U,  2U,  3U,  4U,  6U,  7U,  8U,  9U,  10U, 11U, 12U, 13U, 14U, 15U, 16U, 17U, 19U,
        20U, 22U, 24U, 25U, 26U, 27U, 28U, 29U, 30U, 31U, 32U, 33U, 34U, 35U, 36U, 37U, 38U, 39U,
        40U, 41U, 42U, 43U, 44U, 45U, 46U, 47U, 48U, 49U, 50U, 53U, 73U, 78U, 80U, 88U, 91U}) {
    const std::string name = "lattice " + std::to_string(seed);
    const Model model = cage_model(lattice_cage(seed));
    const Hull hull = whole_hull(model, name);
    if (hull.boundary && hull.boundary->unresolved.empty()) expect_verified(model, hull, name);
  }
}

/// The same of triangles, with its points moved at random: contacts that support values hardly tell
/// apart in the small patches about boundaries' vertices.
ControlCage loop_lattice_cage(unsigned seed) {
  ControlCage cage = triangulated(lattice_cage(seed));
  for (CageCrease& crease : cage.creases)
    crease.sharpness = crease.sharpness > 3 ? 2 : crease.sharpness;
  std::mt19937 random(seed);
  for (dvec3& p : cage.points) {
    for (int k = 0; k < 3; ++k) p[k] += double(random() % 1000) / 2000;
  }
  return cage;
}

TEST(CageHull, OfLatticesOfTriangles) {
  for (const unsigned seed : {2U, 4U, 9U, 14U}) {
    const std::string name = "lattice of triangles " + std::to_string(seed);
    const Model model = cage_model(loop_lattice_cage(seed));
    const Hull hull = whole_hull(model, name);
    if (hull.boundary && hull.boundary->unresolved.empty()) expect_verified(model, hull, name);
  }
}

}  // namespace
}  // namespace taut
