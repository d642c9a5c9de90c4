#include "taut/hull/measure/arc_joints.h"

#include <gtest/gtest.h>

#include <numbers>

namespace taut {
namespace {

constexpr double pi = std::numbers::pi;

Ruling ruling(const dvec3& n, const dvec3& a, const dvec3& b, SourceKind kind) {
  Ruling r{n, {}, {a, b}};
  for (Contact& c : r.contact) c = {0, kind, 0, 0, 0};
  return r;
}

ArcPiece piece(const dvec3& from, const dvec3& to, const dvec3& a, const dvec3& b,
               SourceKind kind = SourceKind::vertex) {
  return {{ruling(from, a, b, kind), ruling(to, a, b, kind)}};
}

const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

double curvature_of(const SeparatingArc& arc, bool in_scroll = false) {
  Sums sums;
  add_creases(arc, std::vector<bool>(arc.pieces.size(), in_scroll), sums);
  return double(sums.value[curvature]);
}

void expect_joints(const HullBoundary& boundary, double value, double error,
                   bool in_scroll = true) {
  const ScrollPieces all(1, std::vector<bool>(boundary.arcs[0].pieces.size(), in_scroll));
  Sums sums;
  add_joints(boundary, all, sums);
  EXPECT_NEAR(double(sums.value[curvature]), value, 1e-15);
  EXPECT_NEAR(sums.error[curvature], error, 1e-15);
}

TEST(ArcJoints, ACreaseIsHalfOfLengthTimesAngle) {
  const SeparatingArc arc{{piece(x, y, dvec3(0.0), 3.0 * z)}};
  EXPECT_NEAR(curvature_of(arc), 0.5 * 3 * pi / 2, 1e-15);
  EXPECT_EQ(curvature_of(arc, true), 0);
}

/// Which of the vertices support is rounding; between pieces n may be left out.
TEST(ArcJoints, VerticesInLineAreOneCrease) {
  const dvec3 n = unit(x + y), m = unit(2.0 * x + y);
  const SeparatingArc arc{{piece(x, m, dvec3(0.0), 3.0 * z), piece(m, n, dvec3(0.0), 2.0 * z),
                           piece(unit(x + 2.0 * y), y, z, 3.0 * z)}};
  EXPECT_NEAR(curvature_of(arc), 0.5 * 3 * pi / 2, 1e-15);
  HullBoundary boundary;
  boundary.arcs = {arc};
  expect_joints(boundary, 0, 0, false);
}

TEST(ArcJoints, PiecesOfScrollsAreThoseOfTheirFaces) {
  HullBoundary boundary;
  boundary.arcs = {{std::vector<ArcPiece>(3)}, {std::vector<ArcPiece>(1)}};
  HullFace scroll;
  scroll.kind = FaceKind::scroll;
  scroll.scroll = {0, 2, 2};
  boundary.faces = {HullFace{}, scroll};
  EXPECT_EQ(pieces_of_scrolls(boundary), (ScrollPieces{{true, false, true}, {false}}));
}

/// Along a ruling at which n turns, and of which a contact makes a step.
TEST(ArcJoints, AreCreases) {
  const dvec3 n = unit(x + y);
  const auto joined = [&](const dvec3& after, const dvec3& end) {
    SeparatingArc arc{{piece(x, n, dvec3(0.0), z, SourceKind::edge),
                       piece(after, y, dvec3(0.0), end, SourceKind::edge)}};
    HullBoundary boundary;
    boundary.arcs = {arc};
    return boundary;
  };
  expect_joints(joined(n, z), 0, 0);
  expect_joints(joined(y, z), 0.5 * pi / 4, 0);
  // What n turns by across the ruling is no crease along it.
  const double across = std::acos(std::sqrt(2.0 / 3));
  expect_joints(joined(unit(x + y + z), z), 0, 0.5 * across);
  HullBoundary stepped = joined(n, 1.25 * z);
  expect_joints(stepped, 0, 0.5 * pi * 0.25);
  stepped.gap = 0.25;
  expect_joints(stepped, 0, 0);

  HullBoundary closed = joined(n, z);
  closed.arcs[0].closed = true;
  expect_joints(closed, -0.5 * pi / 2, 0);

  HullBoundary ends = joined(n, z);
  ends.faces.resize(2);
  ends.faces[0].n = unit(x - y);
  ends.faces[1].n = n;
  ends.arcs[0].facet = {0, 1};
  expect_joints(ends, 0.5 * pi / 4 - 0.5 * pi / 4, 0);
  ends.faces[1].n = y;
  expect_joints(ends, 0.5 * pi / 4, 0);
}

}  // namespace
}  // namespace taut
