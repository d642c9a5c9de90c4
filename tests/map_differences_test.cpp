#include "taut/hull/compare/map_differences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "direction_maps.h"
#include "freeform.h"
#include "models.h"
#include "taut/hull/exact_boundary.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

const Shape& shape_of(const std::string& name) {
  static const std::vector<Truth> all = truths();
  return std::find_if(all.begin(), all.end(), [&](const Truth& t) { return t.name == name; })
      ->shape;
}

/// A scene with its map and its boundary, into which errors are planted.
struct Compared {
  explicit Compared(const Shape& shape, double share = 1e-7)
      : scene(make_scene(shape)), geometry(scene), query(scene) {
    options.threads = 1;
    options.resolution = share;
    HullStatistics statistics;
    map = directions_of(geometry, options, statistics);
    boundary =
        exact_boundary(scene, GaussMap(scene, {.threads = 1, .progress = {}}), options, statistics);
    EXPECT_TRUE(boundary.unresolved.empty());
    EXPECT_EQ(statistics.map_undecided, 0);
  }
  std::vector<Unresolved> spots() { return map_differences(geometry, query, map, boundary).spots; }

  Scene scene;
  ContactGeometry geometry;
  SupportQuery query;
  HullOptions options;
  DirectionMap map;
  HullBoundary boundary;
};

TEST(MapDifferences, NoneFromTruths) {
  for (const Truth& truth : truths()) {
    if (truth.name == "twisted cubic") continue;  // takes long
    SCOPED_TRACE(truth.name);
    EXPECT_TRUE(Compared(truth.shape).spots().empty());
    EXPECT_TRUE(Compared(mapped(truth.shape, skew_rotation(), {3, -1, 2})).spots().empty());
  }
}

TEST(MapDifferences, TellAMissingDent) {
  const double down = 0.02;
  const Shape dented = mapped(dented_sheet(down), skew_rotation());
  const dvec3 up = skew_rotation() * dvec3(0, 0, 1);
  const Scene scene = make_scene(dented);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  // How far the middle lies below the plane over the dent.
  const dvec3 middle = geometry.point(geometry.canonical({0, SourceKind::face, 7 * 14 + 7, 0, 0}));
  const double depth = glm::dot(query(up).point - middle, up);
  ASSERT_GT(depth, 1e-4);
  const double share = depth / 4 / scene.frame().length_to_frame(scene.diagonal());
  Compared own(dented, share);
  EXPECT_TRUE(own.spots().empty());
  EXPECT_EQ(Compared(mapped(dented_sheet(0), skew_rotation()), share).spots().size(), 0U);
  own.boundary = Compared(mapped(dented_sheet(0), skew_rotation()), share).boundary;
  const std::vector<Unresolved> spots = own.spots();
  ASSERT_FALSE(spots.empty());
  for (const Unresolved& spot : spots) EXPECT_GT(glm::dot(spot.n, up), 0.99);
}

/// The first scroll of a hull is no more than one ruling.
TEST(MapDifferences, TellAMissingScroll) {
  for (const char* name : {"spheres 1 and 0.5, 3 apart", "three spheres", "cylinder", "oloid"}) {
    SCOPED_TRACE(name);
    Compared own(shape_of(name));
    ASSERT_FALSE(own.boundary.arcs.empty());
    const Ruling first = own.boundary.arcs.front().pieces.front().rulings.front();
    for (ArcPiece& piece : own.boundary.arcs.front().pieces) {
      std::fill(piece.rulings.begin(), piece.rulings.end(), first);
    }
    EXPECT_FALSE(own.spots().empty());
  }
}

/// One of the discs that are spanned by the rims of a wall.
TEST(MapDifferences, TellAMissingFacet) {
  Compared own(cylinder(1, 2));
  const auto facet =
      std::find_if(own.boundary.faces.begin(), own.boundary.faces.end(),
                   [](const HullFace& face) { return face.kind == FaceKind::facet; });
  ASSERT_NE(facet, own.boundary.faces.end());
  facet->n = -facet->n;
  EXPECT_EQ(own.spots().size(), 1U);
}

/// The region of a patch is said to be that of another, which lies inside of the hull.
TEST(MapDifferences, TellARegionOfAnotherSource) {
  Compared own(two_spheres(1, 0.5, 3) + shifted(sphere(0.25), {1, 0, 0}));
  const int count = own.scene.model().patch_count() / 3;
  for (HullFace& face : own.boundary.faces) {
    for (PatchRegion& region : face.regions) {
      if (region.patch < count) region.patch += 2 * count;
    }
  }
  EXPECT_FALSE(own.spots().empty());
}

TEST(MapDifferences, TellARulingInNoPlane) {
  Compared own(two_spheres(1, 0.5, 3));
  Ruling& ruling = own.boundary.arcs.front().pieces.front().rulings[1];
  ruling.point[0] += 1e-6 * ruling.n;
  const std::vector<Unresolved> spots = own.spots();
  ASSERT_EQ(spots.size(), 1U);
  EXPECT_EQ(spots.front().n, ruling.n);
}

}  // namespace
}  // namespace taut
