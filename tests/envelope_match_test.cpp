// Envelope images of 1024 x 1024 pixels against support queries and the exact boundary.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "envelope_checks.h"
#include "hull_checks.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/hull/precise_hull.h"
#include "taut/io/read_model.h"

namespace {

using namespace taut;       // NOLINT: a test
using namespace taut_test;  // NOLINT

constexpr int size = 1024;
constexpr long directions = 100000;

Model data_model(const std::string& name) {
  Model model;
  read_model(std::string(TAUT_DATA "/") + name, model);
  return model;
}

/// Sources, holes, structure and hull.
void expect_match(Model model) {
  const Scene scene(std::move(model));
  const EnvelopeImages images(scene, {.size = size, .threads = 0, .progress = {}});
  EXPECT_EQ(images.statistics().empty_pixels, 0);
  EXPECT_EQ(images.statistics().filled_pixels, 0);

  const SourceCounts sources = count_sources(images, directions, 1);
  EXPECT_EQ(sources.right + sources.near + sources.wrong, directions);
  EXPECT_LT(sources.near, directions / 100);
  // More than 99.9%, of a tenth less than all, which may have been near a change of source.
  EXPECT_LT(1000 * sources.wrong, directions * 9 / 10);

  const EnvelopeMap map = trace_envelope(images);
  const Hull hull = precise_hull(scene, {.relative = 1e-5, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  const MatchCounts counts = match(images, map, hull);
  EXPECT_EQ(counts.curve_points_off, 0) << "of " << counts.curve_points;
  EXPECT_EQ(counts.wide_rulings_missed, 0) << "of " << counts.wide_rulings;
  EXPECT_LE(counts.narrow_rulings, counts.wide_rulings / 4);
  EXPECT_EQ(counts.triple_points_off, 0) << "of " << counts.triple_points;
  EXPECT_EQ(counts.wide_facets_missed, 0) << "of " << counts.wide_facets;
  EXPECT_EQ(counts.regions_of_several, 0) << "of " << counts.wide_regions;
  // Patches of which the mesh has no vertex that tells.
  EXPECT_LE(counts.regions_of_none, hull.boundary->count(FaceKind::patch) - counts.patches);
  EXPECT_LE(counts.regions_of_none, 1 + counts.wide_regions / 20);
  EXPECT_EQ(counts.patches_split, 0) << "of " << counts.patches;
  // What is not wide is the rest.
  EXPECT_LE(counts.wide_regions, hull.boundary->count(FaceKind::patch));
  EXPECT_GE(counts.wide_regions, hull.boundary->count(FaceKind::patch) * 9 / 10);
  EXPECT_GE(counts.wide_facets, hull.boundary->count(FaceKind::facet) * 3 / 4);

  const Hull of_images = envelope_hull(images, map, {.relative = 1e-4, .progress = {}});
  expect_certified(scene, of_images, 1e-4, {});
}

TEST(EnvelopeMatch, Teapot) { expect_match(data_model("teapot.bpt")); }
TEST(EnvelopeMatch, Oloid) { expect_match(data_model("oloid.taut.json")); }
TEST(EnvelopeMatch, Torus) { expect_match(data_model("torus.taut.json")); }
TEST(EnvelopeMatch, ThreeSpheres) { expect_match(data_model("three_spheres.taut.json")); }
TEST(EnvelopeMatch, SixteenTeapots) { expect_match(posed_teapots(1, 16)); }

// A control cage of a car: 79000 patches.
TEST(EnvelopeMatch, CarCage) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS names no folder with models";
  const std::filesystem::path file =
      std::filesystem::path(folder) / "A15_osd_car_creases_boundary.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  Model model;
  ReadOptions options;
  read_model(file, model, options);
  const Scene scene(std::move(model));
  const EnvelopeImages images(scene, {.size = size, .threads = 0, .progress = {}});
  EXPECT_EQ(images.statistics().empty_pixels, 0);
  EXPECT_EQ(images.statistics().filled_pixels, 0);

  const SourceCounts sources = count_sources(images, directions, 1);
  EXPECT_LT(sources.near, directions / 50);
  EXPECT_LT(1000 * sources.wrong, directions * 9 / 10);

  const EnvelopeMap map = trace_envelope(images);
  const Hull hull = precise_hull(scene, {.relative = 1e-5, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  const MatchCounts counts = match(images, map, hull);
  EXPECT_EQ(counts.curve_points_off, 0) << "of " << counts.curve_points;
  EXPECT_EQ(counts.wide_rulings_missed, 0) << "of " << counts.wide_rulings;
  EXPECT_GT(counts.wide_rulings, 10000);
  EXPECT_EQ(counts.triple_points_off, 0) << "of " << counts.triple_points;
  EXPECT_EQ(counts.wide_facets_missed, 0) << "of " << counts.wide_facets;
  EXPECT_GT(counts.wide_facets, 30);
  EXPECT_EQ(counts.patches_split, 0) << "of " << counts.patches;
  // Along its creases patches of one face of the cage are parted by less than a pixel.
  EXPECT_LE(counts.regions_of_several, counts.wide_regions / 20);
  EXPECT_LE(counts.regions_of_none, hull.boundary->count(FaceKind::patch) - counts.patches);
  EXPECT_GE(counts.wide_regions, hull.boundary->count(FaceKind::patch) * 4 / 5);

  const Hull of_images = envelope_hull(images, map, {.relative = 1e-4, .progress = {}});
  // Where patches of a face meet, its parameters name points of either, so that they say nothing.
  expect_certified(scene, of_images, 1e-4, {.volume = -1, .area = -1, .joined = scene.diagonal()});
}

}  // namespace
