#include "taut/hull/decide/map_piece.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <set>
#include <vector>

#include "models.h"
#include "taut/core/parallel.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::Direction;
using taut::MapPiece;
using taut::StoredNet;

/// A patch of degrees 2 and 3, with weights or without.
MapPiece::Root patch(bool rational) {
  MapPiece::Root root;
  root.rational = rational;
  root.u = root.v = {0, 1};
  root.net.shape = {2, 3};
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 3; ++j) {
      const double w = rational ? 1 + 0.5 * i + 0.25 * j : 1;
      root.net.points.emplace_back(w * i, w * j, w * (i * i - 0.3 * i * j * j), w);
    }
  }
  return root;
}

/// An edge with derivatives along a surface that ends there.
MapPiece::Root edge() {
  MapPiece::Root root;
  root.u = {0, 1};
  root.net = {{2, 0}, {{0, 0, 0, 1}, {1, 2, 0, 1}, {2, 0, 1, 1}}};
  root.inward = {{{1, 0}, {{0, 0, 1, 0}, {0, 1, 2, 0}}}};
  return root;
}

double middle(const taut::Interval& t) { return 0.5 * (t.lower + t.upper); }

TEST(MapPiece, HalvesAreOfTheSameSurface) {
  for (const bool rational : {false, true}) {
    const MapPiece::Root root = patch(rational);
    const BezierPatch surface{2, 3, root.net.points};
    const MapPiece whole(root);
    const MapPiece* piece = &whole;
    std::size_t half = 1;
    for (const Direction across : {Direction::u, Direction::v, Direction::v, Direction::u}) {
      piece = piece->halves(across)[half];
      half = 1 - half;
      const BezierPatch own{2, 3, {piece->exact.points, piece->exact.points + 12}};
      const dvec3 x = taut::point(surface, middle(piece->u), middle(piece->v));
      EXPECT_LT(glm::distance(taut::point(own, 0.5, 0.5), x), 1e-14);
      EXPECT_EQ(glm::clamp(x, piece->box.lower, piece->box.upper), x);
      // The corners are the same; opposite ones weigh the same.
      for (const std::size_t k : {0u, 3u, 8u, 11u}) {
        const dvec4& p = piece->net.points[k];
        EXPECT_LT(glm::distance(taut::euclidean(p), taut::euclidean(own.points[k])), 1e-14);
        EXPECT_NEAR(p.w, piece->net.points[11 - k].w, 1e-14);
      }
    }
  }
}

TEST(MapPiece, HalvesOfEdgesHaveTheirDerivatives) {
  const MapPiece whole(edge());
  const auto halves = whole.halves(Direction::u);
  const StoredNet& lower = halves[0]->inward.front();
  const StoredNet& upper = halves[1]->inward.front();
  EXPECT_EQ(lower.points[0], dvec4(0, 0, 1, 0));
  EXPECT_EQ(lower.points[1], dvec4(0, 0.5, 1.5, 0));
  EXPECT_EQ(upper.points[0], lower.points[1]);
  EXPECT_EQ(upper.points[1], dvec4(0, 1, 2, 0));
  EXPECT_EQ(halves[0]->net.points[2], dvec4(1, 1, 0.25, 1));
  EXPECT_EQ(halves[1]->net.points[0], halves[0]->net.points[2]);
}

/// The pieces of a tree, level by level.
std::vector<const MapPiece*> pieces_of(const MapPiece& root, int levels) {
  std::vector<const MapPiece*> all = {&root};
  std::size_t begin = 0;
  for (int level = 0; level < levels; ++level) {
    const std::size_t end = all.size();
    for (; begin < end; ++begin) {
      for (const MapPiece* half : all[begin]->halves(level % 2 ? Direction::u : Direction::v)) {
        all.push_back(half);
      }
    }
  }
  return all;
}

TEST(MapPiece, OneTreeForAllThreads) {
  for (int round = 0; round < 20; ++round) {
    const MapPiece whole(patch(true));
    std::array<std::vector<const MapPiece*>, 16> seen;
    taut::parallel_for(seen.size(), 1, 0, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) seen[k] = pieces_of(whole, 8);
    });
    for (const auto& all : seen) EXPECT_EQ(all, seen.front());
    EXPECT_EQ(std::set(seen.front().begin(), seen.front().end()).size(), seen.front().size());
  }
}

}  // namespace
