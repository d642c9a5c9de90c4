#include "taut/hull/decide/nearly_straight.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "judge/sweeps.h"
#include "models.h"
#include "taut/bounds/contact_geometry.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::ContactGeometry;
using taut::MapElement;
using taut::MapPieces;
using taut::Scene;
using taut::SourceKind;

constexpr double rho = 1e-6;

Shape of_curve(const std::vector<dvec3>& points) { return {{}, {spline(points)}, {}}; }

/// Two pieces from one end to the other of a segment of length one, which bend off it.
Shape bent(double off) {
  return of_curve({{0, 0, 0}, {0.2, off, 0}, {0.4, -off, off}, {0.7, 0, off}, {1, 0, 0}});
}

/// Elements of edges that are covered, and those that are not.
std::pair<int, int> counts(const Shape& shape) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const MapPieces pieces(geometry, scene.frame().length_to_frame(rho));
  std::pair<int, int> result;
  for (const MapElement& e : pieces.elements()) {
    if (e.contact.kind == SourceKind::edge) ++(e.likeness.covered ? result.first : result.second);
  }
  return result;
}

TEST(NearlyStraight, PiecesNearOneSegmentAreCovered) {
  EXPECT_EQ(counts(bent(0.25 * rho)), std::pair(2, 0));
}

TEST(NearlyStraight, PiecesFartherOffAreNot) { EXPECT_EQ(counts(bent(4 * rho)), std::pair(0, 2)); }

/// Edges in a row: the ends of the inner one lie between those of the outer ones, which stand for
/// them.
TEST(NearlyStraight, BetweenVerticesThatAreCovered) {
  const auto edge = [](double from, double off) {
    return of_curve({{from, 0, 0}, {from + 0.3, off, 0}, {from + 0.6, 0, off}, {from + 1, 0, 0}});
  };
  EXPECT_EQ(counts(edge(0, 0.6 * rho) + edge(1.5, 0.4 * rho) + edge(3, 0.5 * rho)),
            std::pair(3, 0));
  EXPECT_EQ(counts(edge(0, 0.6 * rho) + edge(1.5, 4 * rho) + edge(3, 0.5 * rho)), std::pair(2, 1));
}

/// Beyond its end an edge is not near the segment, straight as it is.
TEST(NearlyStraight, AnEdgeThatTurnsBackIsNot) {
  EXPECT_EQ(counts(of_curve({{0, 0, 0}, {1, 0, 0}, {2, 0.1 * rho, 0}, {0.5, 0, 0}})),
            std::pair(0, 1));
}

}  // namespace
