#include "taut/hull/stitch/ruled_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "exact_checks.h"
#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// A facet's normal with the index of its face, -1: none.
struct Facet {
  dvec3 n;
  int face = -1;
};

struct LabelCase {
  const char* name;
  Shape shape;
  std::vector<int> scrolls;  ///< the faces of all, ascending
  std::vector<Facet> facets;
};

/// The curve moved along a segment.
Shape extruded(const NurbsCurve& curve, const dvec3& along) {
  NurbsSurface surface{curve.degree, 1, curve.knots, {0, 0, 1, 1}, {}};
  surface.points.reserve(2 * curve.points.size());
  for (const dvec4& p : curve.points) {
    surface.points.push_back(p);
    surface.points.push_back(p + dvec4(p.w * along, 0));
  }
  return {{surface}, {}, {}};
}

Shape parallelogram(const dvec3& a, const dvec3& b, const dvec3& c) {
  return extruded(segment(a, b), c - a);
}

/// A triangle's three walls.
Shape prism_walls() {
  const dvec3 a(0, 0, 0);
  const dvec3 b(2, 0, 0);
  const dvec3 c(0.5, 1.5, 0);
  const dvec3 up(0.2, 0.1, 1);
  return extruded(segment(a, b), up) + extruded(segment(b, c), up) + extruded(segment(c, a), up);
}

std::vector<LabelCase> label_cases() {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const dvec3 z(0, 0, 1);
  const Shape can = solid_cylinder(1, 2);
  const Shape half_y = extruded(half_circle(dvec3(0.0), {0, 1, 0}, {1, 0, 0}), 2.0 * z);
  const Shape half_minus_y = extruded(half_circle(dvec3(0.0), {0, -1, 0}, {1, 0, 0}), 2.0 * z);
  const Shape roof = {{}, {}, {{0.5, 0.5, 3}}};
  std::vector<int> strips;
  strips.reserve(12);
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 2; k < 6; ++k) strips.push_back(6 * axis + k);
  }
  const dvec3 u = unit(glm::cross(dvec3(2, 0, 0), dvec3(0.2, 0.1, 1)));
  const dvec3 v = unit(glm::cross(dvec3(-1.5, 1.5, 0), dvec3(0.2, 0.1, 1)));
  const dvec3 w = unit(glm::cross(dvec3(-0.5, -1.5, 0), dvec3(0.2, 0.1, 1)));
  return {
      {"solid cylinder", can, {0}, {{-z, 1}, {z, 2}}},
      {"cylinder without lids", cylinder(1, 2), {0}, {{-z}, {z}}},
      {"the lids alone", disc(1, 0) + disc(1, 2), {-1}, {{-z, 0}, {z, 1}}},
      {"solid cone", solid_cone(1, 2), {0}, {{-z, 1}}},
      {"frustum", frustum(1, 0.5, 2), {0}, {{-z}, {z}}},
      {"its lids", disc(1, 0) + disc(0.5, 2), {-1}, {{-z, 0}, {z, 1}}},
      {"oblique cylinder", mapped(can, {1, 0, 0, 0, 1, 0, 0.3, 0.1, 1}), {0}, {{-z, 1}, {z, 2}}},
      // Bent about its lids' rims the lateral face lies inside.
      {"with a wider lid", cylinder(1, 2) + disc(1.5, 2), {-1}, {{-z}, {z, 1}}},
      {"in two halves", half_y + half_minus_y, {-1}, {{-z}, {z}}},
      {"box", box(1, 2, 3), {}, {{-x, 0}, {-y, 1}, {-z, 2}, {x, 3}, {y, 4}, {z, 5}}},
      {"filleted box",
       filleted_box(1, 2, 3, 0.2),
       strips,
       {{-x, 0}, {x, 1}, {-y, 6}, {y, 7}, {-z, 12}, {z, 13}}},
      {"prism without ends", prism_walls(), {}, {{u, 0}, {v, 1}, {w, 2}, {-z}, {z}}},
      {"torus", torus(2, 0.5), {}, {{-z}, {z}}},
      {"two spheres", two_spheres(1, 0.5, 3), {-1}, {}},
      {"oloid", oloid(), {-1}, {}},
      // Ruled, but not plane.
      {"saddle of lines",
       bilinear_saddle(),
       {},
       {{unit(dvec3(1, 1, -1))},
        {unit(dvec3(-1, -1, -1))},
        {unit(dvec3(1, -1, 1))},
        {unit(dvec3(-1, 1, 1))}}},
      // The first of those in one plane, whatever part of the facet it is.
      {"a floor of two faces",
       parallelogram({0.2, 0.2, 0}, {0.4, 0.2, 0}, {0.2, 0.4, 0}) +
           parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) + roof,
       {},
       {{-z, 0},
        {unit(dvec3(6, 0, 1))},
        {unit(dvec3(-6, 0, 1))},
        {unit(dvec3(0, 6, 1))},
        {unit(dvec3(0, -6, 1))}}},
      // Parallel to a facet is not in it.
      {"a face inside",
       box(1, 1, 1) + shifted(disc(0.2, 0), {0.5, 0.5, 0.5}),
       {},
       {{-x, 0}, {-y, 1}, {-z, 2}, {x, 3}, {y, 4}, {z, 5}}},
  };
}

/// Of an index in the first instance; -1 stays.
int face_of(const Model& model, int source) {
  if (source < 0) return -1;
  const Source s = model.source(source);
  EXPECT_EQ(s.kind, SourceKind::face);
  return s.index;
}

void expect_labels(const Scene& scene, const LabelCase& each, const dmat3& turn) {
  const Hull hull = boundary_of(scene);
  expect_complete(*hull.boundary);
  std::vector<int> scrolls;
  std::size_t facets = 0;
  for (const HullFace& face : hull.boundary->faces) {
    const int index = face_of(scene.model(), face.source);
    if (face.kind == FaceKind::scroll) scrolls.push_back(index);
    if (face.kind != FaceKind::facet) continue;
    ++facets;
    const auto expected = std::find_if(each.facets.begin(), each.facets.end(), [&](const Facet& f) {
      return glm::distance(turn * f.n, face.n) < 1e-9;
    });
    ASSERT_NE(expected, each.facets.end());
    EXPECT_EQ(index, expected->face);
  }
  EXPECT_EQ(facets, each.facets.size());
  std::sort(scrolls.begin(), scrolls.end());
  EXPECT_EQ(scrolls, each.scrolls);
}

TEST(RuledFaces, OfShapesInAnyPlace) {
  for (const LabelCase& each : label_cases()) {
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(each.name + std::string(turned ? ", turned" : ""));
      const dmat3 turn = turned ? skew_rotation() : dmat3(1.0);
      expect_labels(make_scene(mapped(each.shape, turn)), each, turn);
    }
  }
}

/// Rounded, rows of surfaces that touch the same plane no longer do so exactly.
TEST(RuledFaces, OfAFilletedBoxElsewhere) {
  for (const LabelCase& each : label_cases()) {
    if (each.name != std::string("filleted box")) continue;
    const Shape shape = mapped(each.shape, skew_rotation(), {1, 2, 3});
    expect_labels(make_scene(shape), each, skew_rotation());
  }
}

std::vector<int> sources(const Scene& scene, FaceKind kind) {
  const Hull hull = boundary_of(scene);
  expect_complete(*hull.boundary);
  std::vector<int> all;
  for (const HullFace& face : hull.boundary->faces) {
    if (face.kind == kind) all.push_back(face.source);
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Sources are those of the instance that lies there.
TEST(RuledFaces, OfInstances) {
  Model model = make_model(solid_cylinder(1, 2));
  model.add_instance(0, {dmat3(1.0), {0, 0, 2}});
  const Scene scene(model, {.threads = 1, .progress = {}});
  const auto source = [&](int instance, int face) {
    return model.source_id({SourceKind::face, instance, face});
  };
  EXPECT_EQ(sources(scene, FaceKind::facet), (std::vector<int>{source(0, 1), source(1, 2)}));
  // The scroll runs along the rulings of both, one behind the other.
  EXPECT_EQ(sources(scene, FaceKind::scroll), std::vector<int>{-1});
}

/// A cylinder that goes on smoothly into half spheres: its face is the scroll.
TEST(RuledFaces, WhereTheyJoinSmoothly) {
  const Shape half = {{revolved(as_nurbs(BezierCurve{
                          {{1, 0, 0, 1}, homogeneous({1, 0, 1}, std::sqrt(0.5)), {0, 0, 1, 1}}}))},
                      {},
                      {}};
  const dmat3 over(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const Shape capsule = cylinder(1, 2) + shifted(half, {0, 0, 2}) + mapped(half, over);
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(capsule, turn));
    EXPECT_EQ(sources(scene, FaceKind::scroll), std::vector<int>{0});
    EXPECT_EQ(sources(scene, FaceKind::patch), (std::vector<int>{1, 2}));
  }
}

}  // namespace
}  // namespace taut
