#include "taut/hull/stitch/whole_patches.h"

#include <gtest/gtest.h>

#include <set>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// What is added where no curves bound anything.
std::vector<TrimRegion> whole(const Shape& shape, std::vector<Unresolved>& unresolved) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  std::vector<TrimRegion> regions;
  add_whole_patches(geometry, query, {}, regions, unresolved);
  return regions;
}

std::set<int> patches_of(const Shape& shape) {
  std::vector<Unresolved> unresolved;
  std::set<int> all;
  for (const TrimRegion& r : whole(shape, unresolved)) {
    EXPECT_TRUE(all.insert(r.patch).second);
    EXPECT_EQ(r.loops.size(), 1U);
    EXPECT_EQ(r.loops.front().size(), 4U);
  }
  EXPECT_TRUE(unresolved.empty());
  return all;
}

TEST(WholePatches, OfASmoothBodyAreAll) {
  EXPECT_EQ(patches_of(sphere(2)), (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

/// Where the ball inside touches, both support; what lies within the other is none of the hull.
TEST(WholePatches, AreNotThoseInside) {
  EXPECT_EQ(patches_of(sphere(0.5) + shifted(sphere(1), {0, 0, -0.5})),
            (std::set<int>{8, 9, 10, 11, 12, 13, 14, 15}));
}

TEST(WholePatches, OfTwoThatCoincideAreOfOne) {
  const std::set<int> found = patches_of(sphere(1) + mapped(sphere(1), skew_rotation()));
  EXPECT_EQ(found.size(), 8U);
  EXPECT_EQ(*found.begin() < 8, *found.rbegin() < 8);
}

/// A square of degree 2 in the plane z = 0, but for its middle, and a point below.
Shape square(double sag) {
  NurbsSurface surface{2, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}, {}};
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) surface.points.emplace_back(i, j, i == 0 && j == 0 ? -sag : 0, 1);
  }
  return {{surface}, {}, {{0, 0, -1}}};
}

/// What is in the plane of a facet, to within the depth, is part of that.
TEST(WholePatches, AreNotThoseInFacets) {
  for (const double sag : {0.0, 1e-8, 1e-3}) {
    const Scene scene = make_scene(square(sag));
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    FacetNode top;
    top.n = dvec3(0, 0, 1);
    for (const dvec3& n : {dvec3(1, 1, 1), dvec3(-1, 1, 1), dvec3(-1, -1, 1), dvec3(1, -1, 1)}) {
      top.contacts.push_back(geometry.canonical(query(unit(n)).contact));
      top.points.push_back(geometry.point(top.contacts.back()));
    }
    SeparatingGraph graph;
    graph.nodes.push_back(top);
    std::vector<TrimRegion> regions;
    std::vector<Unresolved> unresolved;
    const double depth = scene.frame().length_to_frame(2e-8);
    graph.depth = depth;
    add_whole_patches(geometry, query, graph, regions, unresolved);
    EXPECT_TRUE(regions.empty()) << sag;
    EXPECT_TRUE(unresolved.empty()) << sag;
  }
}

}  // namespace
}  // namespace taut
