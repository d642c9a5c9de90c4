// Hulls under limits of time and memory.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "error_checks.h"
#include "hull_checks.h"
#include "models.h"
#include "taut/core/limits.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut_test::hull_limits {
namespace {

using namespace taut;  // NOLINT: what is tested

constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// Takes memory beyond the limit of some options when a step of theirs begins, or goes on, for the
/// k-th time.
class Ballast {
 public:
  Ballast(std::string step, int times, HullOptions& options)
      : step_(std::move(step)), left_(times) {
    constexpr std::size_t room = 96;
    options.max_memory = resident_bytes() + room * mebibyte;
    options.threads = 1;
    options.progress.report = [this](std::string_view at, double /*share*/) {
      if (at == step_ && --left_ == 0) taken_.assign(2 * room * mebibyte, 'x');
    };
  }
  bool is_taken() const { return !taken_.empty(); }

 private:
  std::string step_;
  int left_;
  std::vector<char> taken_;
};

void expect_true_bound(const Scene& scene, const Hull& hull) {
  EXPECT_LE(hull.distance_bound, scene.diagonal());
  const GapRange found = gaps(scene, polygons(hull.mesh), 300);
  EXPECT_LE(found.highest, hull.distance_bound);
  EXPECT_GE(found.lowest, -1e-12 * scene.diagonal());
}

/// Every curve has two faces, and all is a sphere.
void expect_closed(const HullBoundary& boundary) {
  EXPECT_TRUE(boundary.unresolved.empty());
  for (const HullCurve& curve : boundary.curves) {
    for (const int face : curve.faces) EXPECT_TRUE(0 <= face && face < int(boundary.faces.size()));
  }
}

/// What has been found when the limit is met.
std::optional<Hull> found_before(const Scene& scene, const HullOptions& options) {
  try {
    precise_hull(scene, options);
    ADD_FAILURE() << "no limit was met";
  } catch (const HullLimitExceeded& met) {
    EXPECT_NE(std::string(met.what()).find("of memory was met"), std::string::npos) << met.what();
    return *met.best;
  } catch (const LimitMet& met) {
    EXPECT_NE(std::string(met.what()).find("of memory was met"), std::string::npos) << met.what();
  }
  return std::nullopt;
}

TEST(HullLimits, ArePositive) {
  const std::vector<Model> models = {Model(), make_model(shapes::sphere()),
                                     make_model(shapes::disc(1, 0)),
                                     make_model({{}, {}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}})};
  for (const Model& model : models) {
    for (const double wrong : {0.0, -1.0, infinity, std::nan("")}) {
      expect_invalid([&] { convex_hull(model, {.max_seconds = wrong, .progress = {}}); }, "time");
    }
    expect_invalid([&] { convex_hull(model, {.max_memory = 0, .progress = {}}); }, "memory");
  }
}

TEST(HullLimits, ThatAreMetAtOnceLeaveNothing) {
  for (const Shape& shape : {shapes::sphere(), shapes::disc(1, 0), Shape{{}, {}, {{0, 0, 0}}}}) {
    const Model model = make_model(shape);
    HullOptions options;
    options.max_seconds = 1e-9;
    EXPECT_THROW(convex_hull(model, options), LimitMet);
    options.max_seconds.reset();
    options.max_memory = 1;
    EXPECT_THROW(convex_hull(model, options), LimitMet);
  }
}

TEST(HullLimits, ThatAreNotMetChangeNothing) {
  const Scene scene = make_scene(teapot());
  HullOptions options;
  options.relative = 1e-2;
  const Hull hull = precise_hull(scene, options);
  options.max_seconds = 1e6;
  options.max_memory = std::size_t{1} << 50;
  const Hull limited = precise_hull(scene, options);
  EXPECT_EQ(limited.distance_bound, hull.distance_bound);
  EXPECT_EQ(limited.mesh.n_vertices(), hull.mesh.n_vertices());
  EXPECT_EQ(limited.boundary->faces.size(), hull.boundary->faces.size());
}

TEST(HullLimits, MetInAnyStepLeaveTheMeshAsBoundary) {
  const Scene scene = make_scene(teapot());
  for (const char* step : {"cull", "trace", "stitch"}) {
    SCOPED_TRACE(step);
    HullOptions options;
    options.relative = 1e-2;
    const Ballast ballast(step, 1, options);
    const std::optional<Hull> hull = found_before(scene, options);
    EXPECT_TRUE(ballast.is_taken());
    ASSERT_TRUE(hull && hull->boundary);
    EXPECT_LE(hull->distance_bound, 1e-2 * scene.diagonal());
    expect_true_bound(scene, *hull);
    expect_closed(*hull->boundary);
    EXPECT_EQ(hull->boundary->faces.size(), hull->mesh.n_faces());
  }
}

/// The least bound that was certified holds for what has become of the mesh since.
TEST(HullLimits, MetWhileTheMeshIsRefinedLeaveItAsItIs) {
  const Scene scene = make_scene(teapot());
  double last = infinity;
  for (const int times : {2, 4, 6, 8}) {
    HullOptions options;
    options.relative = 1e-5;
    const Ballast ballast("sample", times, options);
    const std::optional<Hull> hull = found_before(scene, options);
    EXPECT_TRUE(ballast.is_taken());
    ASSERT_TRUE(hull && hull->boundary);
    EXPECT_GT(hull->distance_bound, 1e-5 * scene.diagonal());
    EXPECT_LE(hull->distance_bound, last);
    last = hull->distance_bound;
    expect_true_bound(scene, *hull);
    expect_closed(*hull->boundary);
  }
  EXPECT_LT(last, 0.1 * scene.diagonal());
  // Before the first one there is nothing.
  HullOptions options;
  const Ballast ballast("sample", 1, options);
  EXPECT_FALSE(found_before(scene, options));
}

/// The mesh that comes first is coarse, for want of its share of the room.
TEST(HullLimits, MetWhileTheExactHullIsMeshedLeaveItExact) {
  const Scene scene = make_scene(teapot());
  HullOptions options;
  options.relative = 1e-4;
  options.threads = 1;
  options.max_memory = resident_bytes() + 128 * mebibyte;
  std::vector<char> taken;
  int rounds = 0;
  bool stitched = false;
  options.progress.report = [&](std::string_view step, double share) {
    if (step == "sample" && ++rounds == 2) taken.assign(64 * mebibyte, 'x');
    if (step == "cull") std::vector<char>().swap(taken);
    stitched = stitched || step == "stitch";
    const bool sampling = stitched && step == "sample";
    if (sampling && 0.7 < share && share < 1 && taken.empty()) taken.assign(256 * mebibyte, 'x');
  };
  const std::optional<Hull> hull = found_before(scene, options);
  EXPECT_FALSE(taken.empty());
  ASSERT_TRUE(hull && hull->boundary);
  expect_true_bound(scene, *hull);
  expect_closed(*hull->boundary);
  EXPECT_GT(hull->boundary->count(FaceKind::patch), 0);
}

TEST(HullLimits, OfSampledAndFlatHulls) {
  for (const Shape& shape : {teapot(), shapes::disc(1, 0)}) {
    const Scene scene = make_scene(shape);
    HullOptions options;
    options.relative = 1e-7;
    const Ballast ballast("sample", 3, options);
    try {
      sampled_hull(scene, options);
      FAIL();
    } catch (const HullLimitExceeded& met) {
      EXPECT_TRUE(ballast.is_taken());
      EXPECT_GT(met.best->distance_bound, 1e-7 * scene.diagonal());
      expect_true_bound(scene, *met.best);
    }
  }
}

/// Limits of the progress count as well, and only the caller lifts them.
TEST(HullLimits, OfTheProgressAreTheCallers) {
  const Scene scene = make_scene(shapes::sphere());
  HullOptions options;
  const Ballast ballast("sample", 3, options);
  options.progress.stop = Stop().within(std::nullopt, options.max_memory);
  options.max_memory.reset();
  EXPECT_THROW(precise_hull(scene, options), HullLimitExceeded);
  EXPECT_TRUE(ballast.is_taken());
  EXPECT_THROW(precise_hull(scene, options), LimitMet);
  options.progress.stop.lift_limits();
  EXPECT_NO_THROW(precise_hull(scene, options));
}

}  // namespace
}  // namespace taut_test::hull_limits
