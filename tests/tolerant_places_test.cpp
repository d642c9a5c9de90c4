#include "taut/hull/solve/tolerant_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "models.h"
#include "taut/hull/exact_boundary.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Two spheres, the cone about them, and a ruling in the middle of it.
class TolerantPlacesOfACone : public testing::TestWithParam<bool> {
 protected:
  TolerantPlacesOfACone()
      : scene_(
            make_scene(mapped(two_spheres(1, 0.5, 3), GetParam() ? skew_rotation() : dmat3(1.0)))),
        geometry_(scene_),
        boundary_(exact_boundary(scene_, {.relative = 1e-2, .threads = 1, .progress = {}},
                                 statistics_)) {}

  ArcPiece& piece() { return boundary_.arcs.front().pieces.front(); }
  double found() {
    SupportQuery query(scene_);
    find_tolerant_places(ContactSystem(geometry_), query, boundary_, boundary_.gap);
    return piece().tolerant;
  }

  HullStatistics statistics_;
  Scene scene_;
  ContactGeometry geometry_;
  HullBoundary boundary_;
};

/// Beside where its plane touches a contact is lower by the square of the way, which rounding hides
/// long before.
TEST_P(TolerantPlacesOfACone, ContactsBesideTheirPlacesAreTolerant) {
  for (const double ways : {0.1, 20.0}) {
    const ArcPiece exact = piece();
    Ruling& r = piece().rulings[piece().rulings.size() / 2];
    const ContactJet j = geometry_.jet(r.contact[0]);
    r.contact[0].u += ways * boundary_.gap / glm::length(j.dx[0]);
    r.point[0] = geometry_.point(r.contact[0]);
    const double bound = found();
    EXPECT_EQ(bound > 0, ways > 1);
    EXPECT_LT(bound, 2 * geometry_.tie());
    piece() = exact;
  }
}

TEST_P(TolerantPlacesOfACone, RulingsThatTurnBackAreTolerant) {
  EXPECT_EQ(found(), 0);
  ASSERT_GE(piece().rulings.size(), 4U);
  std::swap(piece().rulings[1], piece().rulings[2]);
  const double bound = found();
  EXPECT_GT(bound, 0);
  EXPECT_LT(bound, 2 * geometry_.tie());
}

/// A facet's corner that is not where the arcs beside it end is within the bounds of both.
TEST(TolerantPlaces, FacetsWithCornersBesideTheirArcsEnds) {
  const Scene scene =
      make_scene(sphere(1) + shifted(sphere(0.5), {3, 0, 0}) + shifted(sphere(0.7), {1, 2.5, 0}));
  const ContactGeometry geometry(scene);
  HullStatistics statistics;
  const HullOptions options{.relative = 1e-2, .threads = 1, .progress = {}};
  HullBoundary boundary = exact_boundary(scene, options, statistics);
  HullFace& facet = *std::find_if(boundary.faces.begin(), boundary.faces.end(),
                                  [](const auto& f) { return f.kind == FaceKind::facet; });
  const double off = 0.5 * boundary.gap;
  facet.points.front() += off * unit(facet.points[1] - facet.points[0]);
  SupportQuery query(scene);
  find_tolerant_places(ContactSystem(geometry), query, boundary, boundary.gap);
  EXPECT_NEAR(facet.tolerant, off, 0.3 * off);
  const auto is_told = [&](const SeparatingArc& arc) {
    const double most = std::max(arc.pieces.front().tolerant, arc.pieces.back().tolerant);
    return std::abs(most - off) < 0.3 * off;
  };
  EXPECT_EQ(std::count_if(boundary.arcs.begin(), boundary.arcs.end(), is_told), 2);
}

/// z = -(x^2 + y^2) + a x^2 y^2 is a saddle beside its corner (1, 1) alone if a is just above 1/3:
/// as far as that is too shallow to be told, it is within the bound all along the border.
TEST(TolerantPlaces, OfAPatchThatIsASaddleInACorner) {
  for (const double a : {0.3336, 0.334}) {
    SCOPED_TRACE(a);
    BezierPatch sheet{2, 2, {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double x2 = i == 2 ? 1 : 0, y2 = j == 2 ? 1 : 0;
        sheet.points.emplace_back(0.5 * i, 0.5 * j, -(x2 + y2) + a * x2 * y2, 1);
      }
    }
    const Scene scene = make_scene({{as_nurbs(sheet)}, {}, {}});
    const ContactGeometry geometry(scene);
    HullStatistics statistics;
    const HullOptions options{.relative = 1e-2, .threads = 1, .progress = {}};
    const HullBoundary boundary = exact_boundary(scene, options, statistics);
    ASSERT_EQ(boundary.count(FaceKind::patch), 1);
    const HullFace& patch = *std::find_if(boundary.faces.begin(), boundary.faces.end(),
                                          [](const auto& f) { return f.kind == FaceKind::patch; });
    SupportQuery query(scene);
    double deepest = 0;
    for (int k = 1; k < 1000; ++k) {
      const Contact c{0, SourceKind::face, 0, 1, 1 - 1e-5 * k};
      const ContactJet j = geometry.jet(c);
      const dvec3 n = unit(glm::cross(j.dx[0], j.dx[1]));
      deepest = std::max(deepest, query(n, c).h - glm::dot(j.x, n));
    }
    EXPECT_GT(deepest, geometry.tie());
    EXPECT_LE(deepest, patch.tolerant + geometry.tie());
  }
}

INSTANTIATE_TEST_SUITE_P(Clean, TolerantPlacesOfACone, testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Turned, TolerantPlacesOfACone, testing::Values(true));

}  // namespace
}  // namespace taut
