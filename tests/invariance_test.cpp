// The same hull from the same model moved, scaled, ordered, written or surrounded differently.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "exact_checks.h"
#include "freeform.h"
#include "hull_checks.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/precise_hull.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// What must not depend on how a model is given. Lengths in model units.
struct Outcome {
  FaceCounts faces;
  int triple_points = 0;
  int free_ends = 0;
  double volume = 0, area = 0, mean_width = 0;
};

Outcome outcome_of(const Scene& scene, const Hull& hull) {
  expect_complete(*hull.boundary);
  const CurveEnds ends = curve_ends(*hull.boundary);
  const BoundaryMeasures measured = measures_of(scene, hull);
  return {face_counts(*hull.boundary),
          ends.triple_points,
          ends.free_ends,
          measured.volume,
          measured.area,
          measured.mean_width};
}

Outcome outcome_of(const Shape& shape) {
  const Scene scene = make_scene(shape);
  return outcome_of(scene, boundary_of(scene));
}

void expect_same_counts(const Outcome& is, const Outcome& was) {
  EXPECT_EQ(is.faces, was.faces);
  EXPECT_EQ(is.triple_points, was.triple_points);
  EXPECT_EQ(is.free_ends, was.free_ends);
}

/// Lengths are `scale` times as large.
void expect_same_measures(const Outcome& is, const Outcome& was, double relative,
                          double scale = 1) {
  EXPECT_NEAR(is.volume / (scale * scale * scale), was.volume, relative * was.volume);
  EXPECT_NEAR(is.area / (scale * scale), was.area, relative * was.area);
  EXPECT_NEAR(is.mean_width / scale, was.mean_width, relative * was.mean_width);
}

/// Twice what the quadratures promise at free ends (measure()).
constexpr double same = 2e-10;

void expect_same(const Outcome& is, const Outcome& was, double scale = 1) {
  expect_same_counts(is, was);
  expect_same_measures(is, was, same, scale);
}

struct Subject {
  const char* name;
  std::function<Shape()> shape;
};

std::ostream& operator<<(std::ostream& out, const Subject& subject) { return out << subject.name; }

Shape shape_named(const std::string& name) {
  for (const Truth& truth : truths()) {
    if (truth.name == name) return truth.shape;
  }
  throw InvalidInput("no truth is called " + name);
}

class Invariance : public testing::TestWithParam<Subject> {
 protected:
  const Shape shape_ = GetParam().shape();
  const Outcome was_ = outcome_of(shape_);
};

TEST_P(Invariance, Turned) {
  Random random(7);
  for (int k = 0; k < 3; ++k) {
    const dvec3 shift = random_point(random);
    expect_same(outcome_of(mapped(shape_, random_rotation(random), shift)), was_);
  }
}

TEST_P(Invariance, OfAnySize) {
  for (const double scale : {1e-6, 1e6}) {
    expect_same(outcome_of(scaled(shape_, scale)), was_, scale);
  }
}

TEST_P(Invariance, InAnyOrder) {
  Shape turned = shape_;
  std::reverse(turned.surfaces.begin(), turned.surfaces.end());
  std::reverse(turned.curves.begin(), turned.curves.end());
  std::reverse(turned.points.begin(), turned.points.end());
  expect_same(outcome_of(turned), was_);
}

/// Patches that are split stay in one source face, so that faces of the hull do not multiply.
TEST_P(Invariance, Split) {
  // Sides of faces that meet along other directions end inside of each other then.
  expect_same(outcome_of(split(shape_, std::sqrt(0.2), std::sqrt(0.3))), was_);
}

class SplitInHalves : public Invariance {};

TEST_P(SplitInHalves, IsTheSame) { expect_same(outcome_of(split(shape_, 0.5, 0.5)), was_); }

/// A join this far from a cusp of Gauss, as a share of a patch: a contact changes over it when the
/// other one is twice as far from it.
TEST(SplitBesideAFreeEnd, IsTheSame) {
  const Shape shape = blob(2);
  const Outcome was = outcome_of(shape);
  const dvec2 cusp(0.499635188562, 0.103682513951);
  for (const double off : {-1e-3, -1e-5, 0.0, 1e-8, 1e-4}) {
    expect_same(outcome_of(split(shape, cusp.x + off, 0.3)), was);
    expect_same(outcome_of(split(shape, 0.3, cusp.y + off)), was);
  }
}

/// Every patch a surface of its own: what lies on several of them is divided, nothing else.
TEST_P(Invariance, InPiecesOfOneFaceEach) {
  Shape pieces = shape_;
  pieces.surfaces.clear();
  for (const NurbsSurface& surface : shape_.surfaces) {
    for (const PatchPiece& piece : decompose(surface)) {
      pieces.surfaces.push_back(as_nurbs(piece.bezier));
    }
  }
  const Outcome is = outcome_of(pieces);
  EXPECT_GE(is.faces.patches, was_.faces.patches);
  EXPECT_EQ(is.faces.scrolls, was_.faces.scrolls);
  EXPECT_EQ(is.faces.facets, was_.faces.facets);
  expect_same_measures(is, was_, same);
}

TEST_P(Invariance, OfHigherDegree) { expect_same(outcome_of(with_higher_degrees(shape_)), was_); }

TEST_P(Invariance, Reversed) { expect_same(outcome_of(with_reversed_parameters(shape_)), was_); }

TEST_P(Invariance, Transposed) { expect_same(outcome_of(with_exchanged_parameters(shape_)), was_); }

/// A point of the hull's inside: the mean of eight support points.
dvec3 inside_of(const Shape& shape) {
  const Scene scene = make_scene(shape);
  SupportQuery query(scene);
  dvec3 sum(0.0);
  for (int k = 0; k < 8; ++k) {
    const dvec3 n(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    sum += query(glm::normalize(n)).point;
  }
  return scene.frame().to_model(sum / 8.0);
}

TEST_P(Invariance, WithPointsInside) {
  const dvec3 c = inside_of(shape_);
  const double near = 1e-3 * make_scene(shape_).diagonal();
  Random random(3);
  Shape more = shape_;
  for (int k = 0; k < 10; ++k) more.points.push_back(c + near * random_point(random));
  expect_same(outcome_of(more), was_);
}

/// A smaller copy about a point of the inside lies inside.
TEST_P(Invariance, WithACopyInside) {
  const dvec3 c = inside_of(shape_);
  expect_same(outcome_of(shape_ + mapped(shape_, dmat3(0.6), 0.4 * c)), was_);
}

/// The points of the hull of A x are A times those of the hull of x, with normals A^-T n.
TEST_P(Invariance, UnderAffineMaps) {
  const dmat3 A(1.2, 0.3, -0.1, 0.2, 0.8, 0.4, -0.3, 0.1, 1.1);
  const dvec3 shift(0.4, -0.2, 0.7);
  const Scene scene = make_scene(shape_);
  const Hull hull = boundary_of(scene);
  const Scene image = make_scene(mapped(shape_, A, shift));
  const Outcome is = outcome_of(image, boundary_of(image));
  expect_same_counts(is, was_);
  EXPECT_NEAR(is.volume, glm::determinant(A) * was_.volume, same * is.volume);
  SupportQuery query(image);
  double worst = 0;
  for (const SeparatingArc& arc : hull.boundary->arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& r : piece.rulings) {
        const dvec3 n = glm::normalize(glm::transpose(glm::inverse(A)) * r.n);
        const dvec3 x = image.frame().to_frame(A * scene.frame().to_model(r.point[0]) + shift);
        worst = std::max(worst, std::abs(query(n).h - glm::dot(x, n)));
      }
    }
  }
  EXPECT_LE(worst, 1e-11);  // the map's condition times what the hull's own rulings keep
}

class FarAway : public Invariance {};

/// Coordinates a million diagonals away are rounded by 1e-10 of the diagonal, several times until
/// the surfaces' control points are those of Bezier patches.
void expect_same_far_away(const Shape& shape, const dvec3& shift, const Outcome& was) {
  constexpr double rounding = 64 * 1e6 * std::numeric_limits<double>::epsilon();
  const double D = make_scene(shape).diagonal();
  const Outcome far = outcome_of(shifted(shape, 1e6 * D * shift));
  expect_same_counts(far, was);
  expect_same_measures(far, was, rounding);
}

TEST_P(FarAway, IsTheSame) { expect_same_far_away(shape_, {0.48, -0.6, 0.64}, was_); }

class FarAwayTurned : public Invariance {};

TEST_P(FarAwayTurned, IsTheSame) {
  Random random(11);
  for (int k = 0; k < 3; ++k) {
    const Shape turned = mapped(shape_, random_rotation(random));
    expect_same_far_away(turned, random_direction(random), was_);
  }
}

class GivenTwice : public Invariance {};

TEST_P(GivenTwice, IsTheSame) { expect_same(outcome_of(shape_ + shape_), was_); }

class WithPointsOfTheHull : public Invariance {};

/// The points in which planes touch the hull twice, as points of the model too.
TEST_P(WithPointsOfTheHull, IsTheSame) {
  const Scene scene = make_scene(shape_);
  const Hull hull = boundary_of(scene);
  Shape more = shape_;
  for (const HullCurve& curve : hull.boundary->curves) {
    for (const dvec3& x : curve.points) more.points.push_back(scene.frame().to_model(x));
  }
  expect_same(outcome_of(more), was_);
}

class NearlyTwice : public testing::TestWithParam<Subject> {};

/// A copy shifted by little more than rounding: what of the exact hull is lost is told, and the
/// mesh's distance holds.
TEST_P(NearlyTwice, HasACertifiedHull) {
  const Shape shape = GetParam().shape();
  const double D = make_scene(shape).diagonal();
  for (const double share : {1e-9, 1e-8, 1e-7}) {
    const Shape twice = shape + shifted(shape, share * D * dvec3(0.48, -0.6, 0.64));
    const Scene scene = make_scene(twice);
    const Hull hull = precise_hull(scene, {.relative = 1e-3, .threads = 1, .progress = {}});
    EXPECT_LE(hull.distance_bound, 1e-3 * D * 1.001);
    SupportQuery query(scene);
    Random random(5);
    for (int k = 0; k < 300; ++k) {
      const dvec3 n = random_direction(random);
      // Of all vertices: no walk along edges tells twins apart.
      double highest = -std::numeric_limits<double>::infinity();
      for (const auto v : hull.mesh.vertices()) {
        highest = std::max(highest, glm::dot(position(hull.mesh, v) - scene.frame().center, n));
      }
      const double gap = scene.frame().length_to_model(query(n).h) - highest;
      EXPECT_LE(gap, hull.distance_bound);
      EXPECT_GE(gap, -1e-12 * D);
    }
  }
}

class HullOfTheHull : public testing::TestWithParam<Subject> {};

/// The mesh is convex: its hull has the same measures.
TEST_P(HullOfTheHull, IsItself) {
  const Scene scene = make_scene(GetParam().shape());
  const Hull hull = precise_hull(scene, {.relative = 1e-3, .progress = {}});
  const PolygonMesh mesh = polygons(hull.mesh);
  Part part;
  part.add_polygons(mesh);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  const Hull again = convex_hull(model);
  const Measures is = measure(polygons(again.mesh));
  const Measures was = measure(mesh);
  EXPECT_LE(again.distance_bound, 1e-13 * scene.diagonal());
  EXPECT_NEAR(is.volume, was.volume, 1e-12 * was.volume);
  EXPECT_NEAR(is.area, was.area, 1e-12 * was.area);
}

const Subject teapot_subject = {"Teapot", teapot};
const Subject blob_subject = {"Blob", [] { return blob(2); }};
const Subject bean_subject = {"Bean", bean};
const Subject oloid_subject = {"Oloid", oloid};
const Subject tori_subject = {"TwoTori", [] { return shape_named("tori like an oloid"); }};
const Subject spheres_subject = {"ThreeSpheres", [] { return shape_named("three spheres"); }};
const Subject cylinder_subject = {"Cylinder", [] { return solid_cylinder(1, 2); }};
const Subject filleted_subject = {"FilletedBox", [] { return filleted_box(1, 2, 3, 0.2); }};
const Subject torus_subject = {"Torus", [] { return torus(1, 0.25); }};
const Subject box_subject = {"Box", [] { return box(1, 2, 3); }};
const Subject cone_subject = {"Cone", [] { return cone(1, 2); }};
const Subject cylinders_subject = {
    "TwoCylinders", [] {
      return solid_cylinder(1, 2) + shifted(solid_cylinder(1, 2), {3, 0, 0});
    }};
const Subject beside_box_subject = {
    "CylinderAndBox", [] {
      return solid_cylinder(1, 2) + shifted(box(1, 1, 2), {3, 0, 0});
    }};
const Subject saddle_subject = {"Saddle", saddle};

std::string name_of(const testing::TestParamInfo<Subject>& info) { return info.param.name; }

const auto general =
    testing::Values(teapot_subject, blob_subject, bean_subject, oloid_subject, tori_subject);
const auto aligned = testing::Values(spheres_subject);
const auto flat = testing::Values(cylinder_subject, filleted_subject, torus_subject, saddle_subject,
                                  box_subject, cone_subject, cylinders_subject, beside_box_subject);

INSTANTIATE_TEST_SUITE_P(General, Invariance, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, Invariance, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, Invariance, flat, name_of);

INSTANTIATE_TEST_SUITE_P(General, SplitInHalves, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, SplitInHalves, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, SplitInHalves, flat, name_of);

INSTANTIATE_TEST_SUITE_P(General, FarAway, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, FarAway, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, FarAway, flat, name_of);
INSTANTIATE_TEST_SUITE_P(General, FarAwayTurned, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, FarAwayTurned, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, FarAwayTurned, flat, name_of);

INSTANTIATE_TEST_SUITE_P(Curves, GivenTwice, testing::Values(oloid_subject), name_of);
INSTANTIATE_TEST_SUITE_P(Surfaces, GivenTwice,
                         testing::Values(teapot_subject, blob_subject, bean_subject, tori_subject,
                                         spheres_subject),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Flat, GivenTwice, flat, name_of);

INSTANTIATE_TEST_SUITE_P(General, WithPointsOfTheHull, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, WithPointsOfTheHull, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, WithPointsOfTheHull, flat, name_of);

INSTANTIATE_TEST_SUITE_P(Bodies, NearlyTwice,
                         testing::Values(teapot_subject, blob_subject, spheres_subject,
                                         cylinder_subject, box_subject),
                         name_of);

INSTANTIATE_TEST_SUITE_P(General, HullOfTheHull, general, name_of);
INSTANTIATE_TEST_SUITE_P(Aligned, HullOfTheHull, aligned, name_of);
INSTANTIATE_TEST_SUITE_P(Flat, HullOfTheHull, flat, name_of);

}  // namespace
}  // namespace taut
