// Envelope images of 1024 x 1024 pixels against support queries and the exact boundary.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "envelope_checks.h"
#include "hull_checks.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/envelope/trace_envelope.h"
#include "taut/hull/precise_hull.h"
#include "taut/io/model/read_model.h"

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

/// Sources and holes; at most a share of the directions is near a change of source.
void expect_sources(const EnvelopeImages& images, double near) {
  EXPECT_EQ(images.statistics().empty_pixels, 0);
  EXPECT_EQ(images.statistics().filled_pixels, 0);
  const SourceCounts sources = count_sources(images, directions, 1);
  EXPECT_EQ(sources.right + sources.near + sources.wrong, directions);
  EXPECT_LT(double(sources.near), near * directions);
  // More than 99.9%, of a tenth less than all, which may have been near a change of source.
  EXPECT_LT(1000 * sources.wrong, directions * 9 / 10);
}

/// The structure of the exact hull, which is whole.
void expect_structure(const MatchCounts& counts, const Hull& hull) {
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_EQ(counts.curve_points_off, 0) << "of " << counts.curve_points;
  EXPECT_EQ(counts.wide_rulings_missed, 0) << "of " << counts.wide_rulings;
  EXPECT_LE(counts.narrow_rulings, counts.wide_rulings / 4);
  EXPECT_EQ(counts.triple_points_off, 0) << "of " << counts.triple_points;
  EXPECT_EQ(counts.wide_facets_missed, 0) << "of " << counts.wide_facets;
  // Patches of which the mesh has no vertex that tells.
  EXPECT_LE(counts.regions_of_none, hull.boundary->count(FaceKind::patch) - counts.patches);
  EXPECT_LE(counts.regions_of_none, 1 + counts.wide_regions / 20);
  EXPECT_EQ(counts.patches_split, 0) << "of " << counts.patches;
  EXPECT_LE(counts.wide_regions, hull.boundary->count(FaceKind::patch));
}

/// Sources, holes, structure and hull.
void expect_match(Model model) {
  const Scene scene(std::move(model));
  const EnvelopeImages images(scene, {.size = size, .threads = 0, .progress = {}});
  expect_sources(images, 0.01);

  const EnvelopeMap map = trace_envelope(images);
  const Hull hull = precise_hull(scene, {.relative = 1e-5, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  const MatchCounts counts = match(images, map, hull);
  expect_structure(counts, hull);
  EXPECT_EQ(counts.regions_of_several, 0) << "of " << counts.wide_regions;
  // What is not wide is the rest.
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
  expect_sources(images, 0.02);

  const EnvelopeMap map = trace_envelope(images);
  const Hull hull = precise_hull(scene, {.relative = 1e-5, .progress = {}});
  ASSERT_TRUE(hull.boundary);
  const MatchCounts counts = match(images, map, hull);
  expect_structure(counts, hull);
  EXPECT_GT(counts.wide_rulings, 10000);
  EXPECT_GT(counts.wide_facets, 30);
  // Patches of one face of the cage may be parted by less than a pixel.
  EXPECT_LE(counts.regions_of_several, counts.wide_regions / 20);
  EXPECT_GE(counts.wide_regions, hull.boundary->count(FaceKind::patch) * 4 / 5);

  const Hull of_images = envelope_hull(images, map, {.relative = 1e-4, .progress = {}});
  // Where patches of a face meet, its parameters name points of either, so that they say nothing.
  expect_certified(scene, of_images, 1e-4, {.volume = -1, .area = -1, .joined = scene.diagonal()});
}

}  // namespace
