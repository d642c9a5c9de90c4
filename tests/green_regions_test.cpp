#include "taut/hull/measure/green_regions.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "boundaries.h"
#include "models.h"
#include "taut/core/integers.h"
#include "taut/hull/measure/quadrature.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A biquadratic patch of which these sides are one point each.
BezierPatch patch_with_points(const std::vector<Side>& sides) {
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      patch.points.push_back(homogeneous({i, j, 0.1 * i * i + 0.2 * j * j}));
    }
  }
  for (const Side side : sides) {
    const dvec2 corner = on_side(side, at_upper_end(side) ? 1 : 0);
    const dvec4 point = patch.at(corner.x > 0 ? 2 : 0, corner.y > 0 ? 2 : 0);
    for (int k = 0; k < 3; ++k) {
      const int fixed = at_upper_end(side) ? 2 : 0;
      (along_v(side) ? patch.at(fixed, k) : patch.at(k, fixed)) = point;
    }
  }
  return patch;
}

GreenRegion region_of_patch(const std::vector<Side>& points, std::vector<TrimStretch> loop) {
  const Scene scene = make_scene(of_patch(patch_with_points(points)));
  const ContactGeometry geometry(scene);
  HullBoundary boundary;
  boundary.faces.emplace_back().regions.push_back({0, 0, 1, {std::move(loop)}});
  const GreenRegions regions(geometry, boundary);
  EXPECT_EQ(regions.all().size(), 1U);
  EXPECT_EQ(regions.all()[0].region, &boundary.faces[0].regions[0]);
  return regions.all()[0];
}

/// Inner integrals run along the sides that are points, from the one across if that is one too.
TEST(GreenRegions, AvoidSidesThatArePoints) {
  struct Case {
    std::vector<Side> points;
    int inner;
    double base;
  };
  const std::vector<Case> cases = {{{}, 0, 0},
                                   {{Side::v0}, 0, 0},
                                   {{Side::v1}, 0, 0},
                                   {{Side::u0}, 1, 0},
                                   {{Side::u1}, 1, 0},
                                   {{Side::u0, Side::v0}, 0, 0},
                                   {{Side::u1, Side::v1}, 0, 1}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const GreenRegion region = region_of_patch(cases[k].points, whole_outline());
    EXPECT_EQ(region.inner, cases[k].inner) << k;
    EXPECT_EQ(region.base, cases[k].base) << k;
  }
}

/// They vanish along the only side across them that bounds the region.
TEST(GreenRegions, BeginAtASideOfTheRegion) {
  const auto base = [](Side side) { return region_of_patch({}, {on_border(side, 0, 1)}).base; };
  EXPECT_EQ(base(Side::u1), 1);
  EXPECT_EQ(base(Side::u0), 0);
  EXPECT_EQ(base(Side::v1), 0);
}

/// The area of a sphere's part in a region, by Green's theorem: its element's integrals along the
/// one parameter, from a base on, around the outline in the other one. The arc's stretches come
/// from the traces; they keep v, for the sphere is turned about its poles.
struct GreenArea {
  const KnownBoundary& known;
  const ContactGeometry& geometry;
  const GreenRegions& all;

  double operator()(int region, int inner, double base) const {
    double area = 0;
    GreenRegion own = all.all()[to_size(region)];
    own.inner = inner;
    own.base = base;
    for (const TrimStretch& s : own.region->loops[0]) {
      if (s.arc < 0) area += along(own, on_side(s.side, s.from), on_side(s.side, s.to));
    }
    const std::vector<ArcPiece>& pieces = known.boundary.arcs[0].pieces;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      for (const ArcTrace& trace : all.traces(0, p)) {
        if (trace.region != region) continue;
        const auto place = [&](const Ruling& r) {
          const Contact& c = r.contact[to_size(trace.contact)];
          EXPECT_EQ(c.element, own.region->patch);
          return parameters(c);
        };
        area += trace.direction *
                along(own, place(pieces[p].rulings.front()), place(pieces[p].rulings.back()));
      }
    }
    return area;
  }

  /// What a stretch of the outline in (u, v), with the region to the left, adds.
  double along(const GreenRegion& own, const dvec2& from, const dvec2& to) const {
    const GaussRule<12>& rule = GaussRule<12>::get();
    const int outer = 1 - own.inner;
    double sum = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      const dvec2 at = from + rule.node[i] * (to - from);
      const double length = at[own.inner] - own.base;
      for (std::size_t j = 0; j < 12; ++j) {
        dvec2 inside = at;
        inside[own.inner] = own.base + rule.node[j] * length;
        const ContactJet jet = geometry.jet(own.contact(inside.x, inside.y));
        sum += rule.weight[i] * rule.weight[j] * length * (to - from)[outer] *
               glm::length(glm::cross(jet.dx[0], jet.dx[1]));
      }
    }
    const double scale = known.scene.frame().scale;
    return (own.inner == 0 ? 1 : -1) * sum / (scale * scale);
  }
};

/// Spheres of radius 1 and 1/2: on the hull below, or above, the sixth of their radius.
TEST(GreenRegions, OutlinesOfTwoSpheresEncloseTheirZones) {
  const KnownBoundary known = two_spheres_boundary(skew_rotation(), {1, 2, 3});
  const ContactGeometry geometry(known.scene);
  const GreenRegions regions(geometry, known.boundary);
  ASSERT_EQ(regions.all().size(), 12U);
  const GreenArea area{known, geometry, regions};
  int number = 0;
  for (const HullFace& face : known.boundary.faces) {
    for (const PatchRegion& region : face.regions) {
      EXPECT_EQ(regions.all()[to_size(number)].region, &region);
      const bool upper_sphere = region.patch >= 8;
      const bool southern = !upper_sphere && region.patch % 2 == 1;
      const double quarter_zone = 0.5 * pi * (upper_sphere ? 0.25 : 1);  // of height one radius
      const double height = southern ? 1 : upper_sphere ? 5.0 / 6 : 1.0 / 6;
      const GreenRegion& own = regions.all()[to_size(number)];
      EXPECT_NEAR(area(number, own.inner, own.base), height * quarter_zone, 1e-9) << region.patch;
      // Any choice is right, but traces along u add nothing where inner integrals run along it.
      EXPECT_NEAR(area(number, 1, 0.3), height * quarter_zone, 1e-9) << region.patch;
      ++number;
    }
  }
}

}  // namespace
}  // namespace taut
