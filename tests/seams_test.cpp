// Rulings, crests, seams and repeated patches: what Part::connect finds beside edges.

#include <gtest/gtest.h>

#include <cmath>

#include "shapes.h"
#include "taut/bounds/scene.h"
#include "taut/core/tolerances.h"
#include "taut/surface/model.h"

namespace taut {
namespace {

using shapes::Shape;

Part connected_part(const Shape& shape) {
  Part part;
  for (const NurbsSurface& s : shape.surfaces) part.add_surface(s, "surface");
  for (const NurbsCurve& c : shape.curves) part.add_curve(c, "curve");
  part.connect(smooth_join_angle);
  return part;
}

Shape of_surface(NurbsSurface surface) { return {{std::move(surface)}, {}, {}}; }

/// Rows of this rotation are no round numbers.
dmat3 turned() {
  const dvec3 a = glm::normalize(dvec3(1, 0.7, -0.4));
  const dvec3 b = glm::normalize(glm::cross(a, dvec3(0.2, 1, 0.9)));
  return {a, b, glm::cross(a, b)};
}

int seam_pieces(const Part& part) {
  int count = 0;
  for (const EdgePiece& piece : part.pieces()) count += piece.edge < 0 ? 1 : 0;
  return count;
}

struct Counts {
  std::size_t patches;
  std::size_t edges;
  int vertices;  ///< but for those of seams
  int seam_pieces;
  int seam_vertices;

  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.patches << " patches, " << c.edges << " edges, " << c.vertices << " vertices, "
             << c.seam_pieces << " pieces of seams, " << c.seam_vertices << " of their vertices";
}

Counts counts(const Part& part) {
  return {part.patches().size(), part.edges().size(),
          static_cast<int>(part.vertices().size()) - part.seam_vertex_count(), seam_pieces(part),
          part.seam_vertex_count()};
}

/// The shape as it is, and turned, moved, large and small.
void expect_counts(const Shape& shape, const Counts& expected) {
  EXPECT_EQ(counts(connected_part(shape)), expected);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Shape other = shapes::mapped(shape, scale * turned(), scale * dvec3(3, -20, 7));
    EXPECT_EQ(counts(connected_part(other)), expected) << "scale " << scale;
  }
}

/// Pieces of seams come last, and both of their patches know them.
void expect_seams_joined(const Part& part) {
  const std::size_t first = part.pieces().size() - static_cast<std::size_t>(seam_pieces(part));
  std::vector<int> sides(part.pieces().size());
  for (const Patch& patch : part.patches()) {
    for (const Border& b : patch.borders) {
      if (b.kind != BorderKind::smooth || b.piece < 0) continue;
      EXPECT_EQ(b.edge, -1);
      EXPECT_GE(b.neighbor, 0);
      EXPECT_GE(static_cast<std::size_t>(b.piece), first);
      ++sides[static_cast<std::size_t>(b.piece)];
    }
  }
  for (std::size_t i = first; i < sides.size(); ++i) {
    EXPECT_EQ(part.pieces()[i].edge, -1);
    EXPECT_EQ(sides[i], 2) << "piece " << i;
  }
}

NurbsSurface quarter_ball(double z, double sign) {
  return shapes::revolved(as_nurbs(BezierCurve{
      {{1, 0, z, 1}, homogeneous({1, 0, z + sign}, std::sqrt(0.5)), {0, 0, z + sign, 1}}}));
}

Shape capsule() {
  return {{quarter_ball(0, -1), shapes::revolved(shapes::segment({1, 0, 0}, {1, 0, 2})),
           quarter_ball(2, 1)},
          {},
          {}};
}

/// The meridian's quarters begin at this angle over the equator.
NurbsCurve meridian(double angle, double R = 2, double r = 0.5) {
  const double c = r * std::cos(angle);
  const double s = r * std::sin(angle);
  return shapes::circle({R, 0, 0}, {c, 0, s}, {-s, 0, c});
}

NurbsSurface exchanged(const NurbsSurface& s) {
  NurbsSurface t{s.degree_v, s.degree_u, s.knots_v, s.knots_u, {}};
  t.points.reserve(s.points.size());
  for (int j = 0; j < s.count_v(); ++j) {
    for (int i = 0; i < s.count_u(); ++i) {
      t.points.push_back(s.points[static_cast<std::size_t>(i * s.count_v() + j)]);
    }
  }
  return t;
}

// ---- Rulings

TEST(Rulings, OfCylindersConesAndPlanes) {
  const auto expect = [](const Shape& shape, bool u, bool v) {
    const Part part = connected_part(shape);
    for (const Patch& patch : part.patches()) {
      EXPECT_EQ(patch.ruled_u, u);
      EXPECT_EQ(patch.ruled_v, v);
    }
  };
  for (const dmat3& m : {dmat3(1.0), 1e-5 * turned(), 1e5 * turned()}) {
    const auto placed = [&](const Shape& s) { return shapes::mapped(s, m, m * dvec3(9, 8, 7)); };
    expect(placed(shapes::cylinder(1, 2)), false, true);
    expect(placed(shapes::cone(1, 2)), false, true);
    expect(placed(of_surface(exchanged(shapes::cylinder(1, 2).surfaces[0]))), true, false);
    expect(placed(shapes::disc(1, 0.3)), true, true);
    expect(placed(shapes::bilinear_saddle()), true, true);
    expect(placed(shapes::sphere()), false, false);
    expect(placed(shapes::torus(2, 0.5)), false, false);
    expect(placed(shapes::saddle()), false, false);
  }
}

TEST(Rulings, RaisedDegrees) {
  for (const PatchPiece& piece : decompose(shapes::cylinder(1, 2).surfaces[0])) {
    for (const dmat3& m : {dmat3(1.0), turned()}) {
      const Shape raised = shapes::of_patch(elevated(piece.bezier, 4, 5));
      const Part part = connected_part(shapes::mapped(raised, m));
      EXPECT_FALSE(part.patches()[0].ruled_u);
      EXPECT_TRUE(part.patches()[0].ruled_v);
    }
  }
}

/// A bend that is well above rounding is none.
TEST(Rulings, SlightBends) {
  for (const double bend : {0.0, 1e-12}) {
    BezierPatch patch{2, 2, {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        patch.points.push_back(homogeneous({i, j, (i == 1 ? bend : 0) + (j == 1 ? 0.5 : 0)}));
      }
    }
    const Part part = connected_part(shapes::of_patch(patch));
    EXPECT_EQ(part.patches()[0].ruled_u, bend == 0);
    EXPECT_FALSE(part.patches()[0].ruled_v);
  }
}

// ---- Seams

TEST(Seams, NoneOnWhatIsSmoothThroughout) {
  expect_counts(shapes::sphere(), {8, 0, 0, 0, 0});
  expect_counts(shapes::ellipsoid(3, 2, 1), {8, 0, 0, 0, 0});
}

TEST(Seams, NoneOnASolidCylinder) { expect_counts(shapes::solid_cylinder(1, 2), {12, 2, 0, 0, 0}); }

/// The straight segments of the one go on in the other, along parameter lines.
TEST(Seams, NoneBetweenCylindersInOneLine) {
  const Shape lower = shapes::cylinder(1, 2);
  expect_counts(lower + shapes::shifted(lower, {0, 0, 2}), {8, 2, 0, 0, 0});
}

TEST(Seams, CapsuleHasTwoClosedOnes) {
  expect_counts(capsule(), {12, 0, 0, 8, 0});
  const Part part = connected_part(capsule());
  expect_seams_joined(part);
  for (const EdgePiece& piece : part.pieces()) {
    for (const int neighbor : piece.end_neighbor) EXPECT_GE(neighbor, 0);
    for (const int vertex : piece.end_vertex) EXPECT_EQ(vertex, -1);
  }
  Model model;
  model.add_part(part, smooth_join_angle);
  EXPECT_EQ(model.edge_count(), 0);
  EXPECT_EQ(model.vertex_count(), 0);
  EXPECT_EQ(model.source_count(), 3);
}

/// Spheres' eighths meet quarters of cylinders in arcs; these meet planes in straight lines.
TEST(Seams, FilletedBox) {
  const Shape shape = shapes::filleted_box(3, 2, 1, 0.25);
  expect_counts(shape, {26, 0, 0, 24, 24});
  const Part part = connected_part(shape);
  expect_seams_joined(part);
  for (const Patch& patch : part.patches()) {
    for (const int vertex : patch.corner_vertex) EXPECT_GE(vertex, 0);
  }
  Model model;
  model.add_part(part, smooth_join_angle);
  EXPECT_EQ(model.vertex_count(), 0);
  EXPECT_EQ(model.source_count(), 26);
}

/// A ball's eighth beside a cylinder's quarter: the open borders go on where the seam ends.
/// z = -x^2/2 over [0, 1]^2, and z = -x^2/2 - x^2 y (1 - y) beyond x = 0.
Shape parabolic_cylinder_going_on() {
  BezierPatch cylinder{2, 1, {}};
  for (const auto& [x, z] : {std::pair(0.0, 0.0), std::pair(0.5, 0.0), std::pair(1.0, -0.5)}) {
    for (const double y : {0.0, 1.0}) cylinder.points.push_back(homogeneous(dvec3(x, y, z)));
  }
  BezierPatch beyond{2, 2, {}};
  for (const auto& [x, square] :
       {std::pair(-1.0, 1.0), std::pair(-0.5, 0.0), std::pair(0.0, 0.0)}) {
    for (const auto& [y, factor] :
         {std::pair(0.0, -0.5), std::pair(0.5, -1.0), std::pair(1.0, -0.5)}) {
      beyond.points.push_back(homogeneous(dvec3(x, y, square * factor)));
    }
  }
  return {{as_nurbs(cylinder), as_nurbs(beyond)}, {}, {}};
}

TEST(Seams, EdgesDoNotSeeThem) {
  // The bent sides go on in bent ones: no vertices of edges there.
  expect_counts(parabolic_cylinder_going_on(), {2, 6, 4, 1, 2});
  const Part part = connected_part(parabolic_cylinder_going_on());
  for (const EdgePiece& piece : part.pieces()) {
    if (piece.edge >= 0) continue;
    for (const int v : piece.end_vertex) {
      EXPECT_GE(v, static_cast<int>(part.vertices().size()) - part.seam_vertex_count());
    }
  }
}

TEST(Seams, EndAtVerticesWhereStraightSidesBecomeBent) {
  const Shape all = shapes::filleted_box(3, 2, 1, 0.25);
  // The first patch after two planes is a quarter of a cylinder, with a ball's eighth at its end.
  const Part whole = connected_part(all);
  const int ball = whole.patches()[2].borders[2].neighbor;
  ASSERT_GE(ball, 18);
  const Shape two = {{all.surfaces[2], all.surfaces[static_cast<std::size_t>(ball)]}, {}, {}};
  const Part part = connected_part(two);
  EXPECT_EQ(seam_pieces(part), 1);
  EXPECT_EQ(part.seam_vertex_count(), 0);
}

// ---- Crests

TEST(Crests, OfATorusAtBorders) { expect_counts(shapes::torus(2, 0.5), {16, 0, 0, 8, 0}); }

TEST(Crests, OfATorusInsidePatches) {
  for (const double angle : {0.3, -0.5, 0.785398163397448, 1.2}) {
    const NurbsSurface surface = shapes::revolved(meridian(angle));
    expect_counts(of_surface(surface), {24, 0, 0, 8, 0});
    expect_counts(of_surface(exchanged(surface)), {24, 0, 0, 8, 0});
    expect_seams_joined(connected_part(of_surface(surface)));
  }
}

/// Patches still are the same surface of the same parameters, as a grid.
TEST(Crests, SplitsAreExact) {
  const NurbsSurface surface = shapes::revolved(meridian(0.3));
  const std::vector<PatchPiece> before = decompose(surface);
  const Part part = connected_part(of_surface(surface));
  ASSERT_EQ(part.faces()[0].patch_count, 24);
  for (std::size_t k = 0; k < 24; ++k) {
    const Patch& patch = part.patches()[k];
    if (k > 0 && k % 6 == 0) {
      EXPECT_EQ(patch.u.lower, part.patches()[k - 1].u.upper);
    }
    if (k % 6 != 0) {
      EXPECT_EQ(patch.v.lower, part.patches()[k - 1].v.upper);
    }
    for (const PatchPiece& piece : before) {
      const bool within = piece.u.lower <= patch.u.lower && patch.u.upper <= piece.u.upper &&
                          piece.v.lower <= patch.v.lower && patch.v.upper <= piece.v.upper;
      if (!within) continue;
      for (const double s : {0.0, 0.3, 1.0}) {
        for (const double t : {0.0, 0.6, 1.0}) {
          const double u = (patch.u.at(s) - piece.u.lower) / (piece.u.upper - piece.u.lower);
          const double v = (patch.v.at(t) - piece.v.lower) / (piece.v.upper - piece.v.lower);
          EXPECT_LT(glm::distance(point(patch.bezier, s, t), point(piece.bezier, u, v)), 2e-15);
        }
      }
    }
  }
  for (const EdgePiece& piece : part.pieces()) {
    for (const double t : {0.0, 0.4, 1.0}) {
      EXPECT_NEAR(std::abs(point(piece.bezier, t).z), 0.5, 1e-15);
    }
  }
}

/// Strips as thin as rounding, or as what counts as one point, would be no patches.
TEST(Crests, NextToBorders) {
  for (const double angle : {1e-16, 1e-12, 1e-9, 1e-7, -1e-7}) {
    const Part part = connected_part(of_surface(shapes::revolved(meridian(angle))));
    EXPECT_EQ(part.patches().size(), 16u) << angle;
    EXPECT_EQ(part.edges().size(), 0u) << angle;
  }
}

/// A quarter of a torus, continued by a straight pipe: splits go on into the pipe.
TEST(Crests, SplitsGoOnInNeighbors) {
  Shape shape;
  for (const PatchPiece& piece : decompose(shapes::revolved(meridian(0.3)))) {
    if (piece.u.lower == 0) shape.surfaces.push_back(as_nurbs(piece.bezier));
  }
  ASSERT_EQ(shape.surfaces.size(), 4u);
  const NurbsCurve circle = meridian(0.3);
  NurbsSurface pipe{circle.degree, 1, circle.knots, {0, 0, 1, 1}, {}};
  for (const dvec4& p : circle.points) {
    pipe.points.push_back(p);
    pipe.points.push_back(p - p.w * dvec4(0, 1, 0, 0));
  }
  shape.surfaces.push_back(pipe);
  const Part part = connected_part(shape);
  // Two crests, and the circle in which they end, as they do at the rim.
  EXPECT_EQ(counts(part), (Counts{12, 5, 0, 2 + 6, 4}));
  expect_seams_joined(part);
  int open = 0;
  for (const Patch& patch : part.patches()) {
    for (const Border& b : patch.borders) open += b.neighbor < 0 ? 1 : 0;
  }
  EXPECT_EQ(open, 12);
}

// ---- Repeated patches

TEST(RepeatedPatches, CubeTwice) {
  const Shape cube = shapes::box(1, 2, 3);
  const Part part = connected_part(cube + cube);
  EXPECT_EQ(counts(part), (Counts{12, 12, 8, 0, 0}));
  for (const Edge& edge : part.edges()) EXPECT_EQ(edge.faces.size(), 2u);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(part.patches()[static_cast<std::size_t>(i)].repeats, i < 6 ? -1 : i - 6);
  }
}

BezierPatch reversed_u(const BezierPatch& patch) {
  BezierPatch result = patch;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) result.at(i, j) = patch.at(patch.degree_u - i, j);
  }
  return result;
}

/// In all eight ways, with other weights and rounded.
TEST(RepeatedPatches, MappingsAndBorders) {
  const std::vector<PatchPiece> pieces = decompose(shapes::torus(2, 0.5).surfaces[0]);
  for (int way = 0; way < 8; ++way) {
    Shape shape;
    for (const PatchPiece& piece : pieces) shape.surfaces.push_back(as_nurbs(piece.bezier));
    BezierPatch again = pieces[5].bezier;
    if ((way & 1) != 0) again = reversed_u(again);
    if ((way & 2) != 0) again = taut::transposed(again);
    if ((way & 4) != 0) again = reversed_u(again);
    for (dvec4& p : again.points) p = 3.0 * p + p.w * dvec4(1e-14, 0, 0, 0);
    shape.surfaces.push_back(as_nurbs(again));
    const Part part = connected_part(shape);
    EXPECT_EQ(part.edges().size(), 0u);
    const Patch& patch = part.patches()[16];
    const Patch& first = part.patches()[5];
    ASSERT_EQ(patch.repeats, 5) << way;
    EXPECT_EQ(first.repeats, -1);
    const auto mapped = [&](dvec2 uv) {
      if (patch.swapped) std::swap(uv.x, uv.y);
      return dvec2(patch.reversed_u ? 1 - uv.x : uv.x, patch.reversed_v ? 1 - uv.y : uv.y);
    };
    for (const Side side : all_sides) {
      for (const double t : {0.0, 0.2, 0.9}) {
        const dvec2 uv = on_side(side, t);
        const dvec2 there = mapped(uv);
        const dvec3 x = point(patch.bezier, uv.x, uv.y);
        EXPECT_LT(glm::distance(x, point(first.bezier, there.x, there.y)), 1e-13);
        const Border& b = patch.borders[static_cast<std::size_t>(side)];
        ASSERT_GE(b.neighbor, 0);
        const dvec2 beyond = on_side(b.neighbor_side, b.reversed ? 1 - t : t);
        const BezierPatch& neighbor = part.patches()[static_cast<std::size_t>(b.neighbor)].bezier;
        EXPECT_LT(glm::distance(x, point(neighbor, beyond.x, beyond.y)), 1e-13);
        if (b.piece < 0) continue;
        const BezierCurve& piece = part.pieces()[static_cast<std::size_t>(b.piece)].bezier;
        EXPECT_LT(glm::distance(x, point(piece, b.piece_reversed ? 1 - t : t)), 1e-13);
      }
    }
  }
}

TEST(RepeatedPatches, NearOnesAreNot) {
  const Shape ball = shapes::sphere();
  EXPECT_EQ(connected_part(ball + shapes::shifted(ball, {1e-10, 0, 0})).patches()[8].repeats, -1);
  EXPECT_EQ(connected_part(ball + shapes::shifted(ball, {1e-14, 0, 0})).patches()[8].repeats, 0);
}

// ---- Sources

/// On seams the curved face is told, whichever patch the contact is on.
TEST(Seams, SourcesOfContacts) {
  Model model;
  model.add_part(connected_part(capsule()), smooth_join_angle);
  const Scene scene(std::move(model));
  const Part& part = scene.model().parts()[0];
  // Patches 0 .. 3 are the ball's below, 4 .. 7 the cylinder's, whose v0 lies on it.
  const SourceContact on = scene.source({0, SourceKind::face, 4, 0.25, 0});
  EXPECT_EQ(on.source, 0);
  EXPECT_EQ(on.kind, SourceKind::face);
  const Border& border = part.patches()[4].borders[2];
  const Patch& ball = part.patches()[static_cast<std::size_t>(border.neighbor)];
  const dvec2 uv = on_side(border.neighbor_side, border.reversed ? 0.75 : 0.25);
  EXPECT_EQ(on.u, ball.u.at(uv.x));
  EXPECT_EQ(on.v, ball.v.at(uv.y));
  const double t = border.piece_reversed ? 0.75 : 0.25;
  const SourceContact piece = scene.source({0, SourceKind::edge, border.piece, t, 0});
  EXPECT_EQ(piece.source, on.source);
  EXPECT_EQ(piece.u, on.u);
  EXPECT_EQ(piece.v, on.v);
}

TEST(Seams, SourcesOfTheirVertices) {
  Model model;
  model.add_part(connected_part(shapes::filleted_box(3, 2, 1, 0.25)), smooth_join_angle);
  const Scene scene(std::move(model));
  const Part& part = scene.model().parts()[0];
  for (int v = 0; v < 24; ++v) {
    const SourceContact on = scene.source({0, SourceKind::vertex, v, 0, 0});
    EXPECT_EQ(on.kind, SourceKind::face);
    ASSERT_GE(on.source, 18);  // a ball
    const Patch& ball = part.patches()[static_cast<std::size_t>(on.source)];
    EXPECT_LT(
        glm::distance(point(ball.bezier, on.u, on.v), part.vertices()[static_cast<std::size_t>(v)]),
        1e-15);
  }
  for (int patch = 0; patch < 26; ++patch) {
    EXPECT_GE(scene.source({0, SourceKind::face, patch, 0, 1}).source, 18);
  }
}

// ---- Sides that end inside of others

/// A quarter of a cylinder's wall between two heights.
BezierPatch wall(double from, double to) {
  const double w = std::sqrt(0.5);
  BezierPatch patch{2, 1, {}};
  for (const dvec4& p : {dvec4(1, 0, 0, 1), dvec4(w, w, 0, w), dvec4(0, 1, 0, 1)}) {
    for (const double z : {from, to}) patch.points.emplace_back(p.x, p.y, z * p.w, p.w);
  }
  return patch;
}

int smooth_borders(const Part& part) {
  int count = 0;
  for (const Patch& patch : part.patches()) {
    for (const Border& b : patch.borders) count += b.kind == BorderKind::smooth ? 1 : 0;
  }
  return count;
}

/// One wall on two, that are divided elsewhere than a third one: all are divided in both places.
TEST(Junctions, DivideThePatchesBesideThem) {
  const Interval all{0, 1};
  Shape shape;
  shape.surfaces = {as_nurbs(wall(0, 1)), as_nurbs(restricted(wall(1, 2), {0, 0.3}, all)),
                    as_nurbs(restricted(wall(1, 2), {0.3, 1}, all)),
                    as_nurbs(restricted(wall(2, 3), {0, 0.6}, all)),
                    as_nurbs(restricted(wall(2, 3), {0.6, 1}, all))};
  const Part part = connected_part(shape);
  EXPECT_EQ(part.faces().size(), 5U);
  EXPECT_EQ(part.patches().size(), 9U);
  EXPECT_EQ(smooth_borders(part), 2 * (6 + 6));
  for (const Face& face : part.faces()) EXPECT_GE(face.patch_count, 1);
}

/// Sides that touch others but do not run along them divide nothing.
TEST(Junctions, NotWhereSidesTouch) {
  const double c = std::sqrt(0.5);
  const BezierPatch other{1, 1, {{c, c, 1, 1}, {2, 2, 1, 1}, {2, 0, 3, 1}, {3, 1, 3, 1}}};
  Shape shape;
  shape.surfaces = {as_nurbs(wall(0, 1)), as_nurbs(other)};
  EXPECT_EQ(connected_part(shape).patches().size(), 2U);
}

}  // namespace
}  // namespace taut
