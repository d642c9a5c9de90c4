#include "taut/hull/solve/arc_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "freeform.h"
#include "solved_scene.h"
#include "taut/core/integers.h"

namespace taut_test {
namespace {

using namespace taut;

/// z = -(u - 1/2)^2 - (v - 1/2)^2 times the height, over the unit square moved along y, with these
/// inner knots in u: control points are blossoms.
NurbsSurface bump(double height, double y, const std::vector<double>& inner) {
  NurbsSurface s{2, 2, {0, 0, 0}, {0, 0, 0, 1, 1, 1}, {}};
  s.knots_u.insert(s.knots_u.end(), inner.begin(), inner.end());
  s.knots_u.insert(s.knots_u.end(), 3, 1.0);
  const auto square = [](double a, double b) { return (a - 0.5) * (b - 0.5); };
  for (std::size_t i = 0; i + 3 < s.knots_u.size(); ++i) {
    for (std::size_t j = 0; j + 3 < s.knots_v.size(); ++j) {
      const double a = s.knots_u[i + 1], b = s.knots_u[i + 2];
      const double c = s.knots_v[j + 1], d = s.knots_v[j + 2];
      s.points.emplace_back(0.5 * (a + b), y + 0.5 * (c + d),
                            -height * (square(a, b) + square(c, d)), 1);
    }
  }
  return s;
}

/// Each border has a ruling of its own, with its own direction: none is leapt over.
TEST(ArcSolver, ManyNarrowPatchesArePassedOneByOne) {
  constexpr int narrow = 150;
  std::vector<double> inner;
  for (int k = 0; k <= narrow; ++k) inner.push_back(0.3 + 1e-3 * k / narrow);
  Shape shape;
  shape.surfaces = {bump(1, 0, inner), bump(0.9, 3, inner)};
  const SolvedScene solved(shape);
  ASSERT_TRUE(solved.unresolved.empty());
  int passed = 0;
  for (const SeparatingArc& arc : solved.graph.arcs) {
    const Ruling* before = nullptr;
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& r : piece.rulings) {
        for (const std::size_t i : {0u, 1u}) {
          if (before == nullptr || r.contact[i].kind != SourceKind::face) continue;
          const double step = glm::distance(before->point[i], r.point[i]);
          if (before->contact[i].kind != SourceKind::face || step < 1e-9) continue;
          EXPECT_GE(glm::distance(before->n, r.n), 0.1 * step);
        }
        before = &r;
      }
      const std::array<Contact, 2>& at = piece.rulings.front().contact;
      passed += int(at[0].kind == SourceKind::face && at[1].kind == SourceKind::face);
    }
  }
  EXPECT_GE(passed, 2 * narrow);
}

/// Over a plane, where nothing tells the way, contacts go on along one line: neither passes the
/// other.
TEST(ArcSolver, ContactsDoNotPassEachOther) {
  const std::vector<double> inner = {0.2, 0.4, 0.6, 0.8};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(Shape{{bump(0, 0, inner)}, {}, {}}, turn));
    const ContactGeometry geometry(scene);
    const ContactSystem system(geometry);
    SupportQuery query(scene);
    DirectionMap map;
    map.resolution = 1e-8;
    const RulingSearch search(system, query, map);
    // In the middles of two patches that follow each other.
    const auto ruling_from = [&](int patch) {
      Ruling r;
      r.n = turn * dvec3(0, 0, 1);
      for (const std::size_t i : {0u, 1u}) {
        r.contact[i] = {0, SourceKind::face, patch + int(i), 0.5, 0.5};
        r.point[i] = geometry.point(r.contact[i]);
      }
      return r;
    };
    for (const auto& [from, to] : {std::pair(0, 3), std::pair(3, 0)}) {
      ArcSolver solver(search, ruling_from(from));
      solver.go_on(ruling_from(to));
      const std::vector<ArcPiece> pieces = solver.take();
      EXPECT_GE(pieces.size(), 7U);
      const dvec3 along = ruling_from(0).point[1] - ruling_from(0).point[0];
      for (const ArcPiece& piece : pieces) {
        for (const Ruling& r : piece.rulings) {
          EXPECT_GE(glm::dot(r.point[1] - r.point[0], along), -1e-15);
        }
      }
    }
  }
}

}  // namespace
}  // namespace taut_test
