// Each phase hears a stop within 0.2 s, whenever in it that is asked for.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "cages.h"
#include "models.h"
#include "taut/bounds/scene.h"
#include "taut/core/error.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/decide/pieces.h"
#include "taut/hull/decide/top_parts.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/mesh/contact_faces.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/write_document.h"
#include "taut/subdivision/add_cage.h"
#include "taut/verify/verify.h"
#include "taut/verify/verify_hull.h"

namespace taut_test {
namespace {

using namespace taut;
using std::chrono::milliseconds;

/// In seconds of the thread, whatever else the machine does.
constexpr double longest_deafness = 0.2;

double seconds_of(clockid_t clock) {
  timespec now = {};
  clock_gettime(clock, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Asks an operation of this thread to stop, a while after a step of it has begun.
class Stopper {
 public:
  Stopper(std::string_view step, milliseconds delay) : step_(step), delay_(delay) {
    pthread_getcpuclockid(pthread_self(), &clock_);
    if (step.empty()) start();
  }

  Progress progress() {
    Progress progress;
    progress.stop = source_.get_token();
    progress.report = [this](std::string_view step, double /*share*/) {
      if (step == step_ && !timer_.joinable()) start();
    };
    return progress;
  }
  /// How long ago this thread was asked, if it was.
  std::optional<double> since() const {
    if (!source_.stop_requested()) return std::nullopt;
    return seconds_of(clock_) - asked_;
  }

 private:
  void ask() {
    asked_ = seconds_of(clock_);
    source_.request_stop();
  }
  void start() {
    if (delay_ == milliseconds(0)) return ask();
    timer_ = std::jthread([this](const std::stop_token& over) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any().wait_for(lock, over, delay_, [] { return false; });
      if (!over.stop_requested()) ask();
    });
  }

  std::string step_;
  milliseconds delay_;
  clockid_t clock_ = {};
  std::stop_source source_;
  std::atomic<double> asked_ = 0;
  std::jthread timer_;
};

using Operation = std::function<void(const Progress&)>;

/// `step`: the one of the operation in which it is stopped; the whole operation if empty.
void expect_heard(std::string_view step, const Operation& operation) {
  int heard = 0;
  for (const int delay : {0, 3, 10, 30, 100}) {
    Stopper stopper(step, milliseconds(delay));
    try {
      operation(stopper.progress());
    } catch (const Cancelled&) {
      ++heard;
    }
    const std::optional<double> since = stopper.since();
    EXPECT_LE(since.value_or(0), longest_deafness)
        << "'" << step << "', asked to stop after " << delay << " ms";
    if (!since) break;  // it had ended
  }
  EXPECT_GT(heard, 0) << step;
}

/// The teapot as many times, each a part of its own.
Model teapots(int count) {
  Model model;
  for (int k = 0; k < count; ++k) {
    Part part;
    for (const NurbsSurface& surface : shifted(teapot(), dvec3(10.0 * k, 0, 0)).surfaces) {
      part.add_surface(surface, "face");
    }
    model.add_part(std::move(part), smooth_join_angle);
  }
  return model;
}

TEST(Interrupt, Refinement) {
  const ControlCage cage = dome_cage(CageScheme::catmark, 60);  // takes a second
  expect_heard("", [&](const Progress& progress) {
    Part part;
    add_cage(part, cage, "cage", {.accuracy = default_cage_accuracy, .progress = progress});
  });
}

TEST(Interrupt, Connection) {
  Part whole;
  add_cage(whole, dome_cage(CageScheme::catmark, 12), "cage");
  expect_heard("", [&](const Progress& progress) {
    Part part = whole;
    part.connect(smooth_join_angle, progress);
  });
}

TEST(Interrupt, Reading) {
  const std::string text = to_document(teapots(40), DocumentEncoding::json);
  expect_heard("", [&](const Progress& progress) {
    Model model;
    ReadOptions options;
    options.progress = progress;
    read_model(text, "teapots.taut.json", ".taut.json", model, options);
  });
}

TEST(Interrupt, Build) {
  const Model model = teapots(40);
  expect_heard("", [&](const Progress& progress) { Scene(model, {1, progress}); });
}

void find_hull(const Scene& scene, const Progress& progress) {
  HullOptions options;
  options.relative = 1e-5;
  options.threads = 1;
  options.progress = progress;
  convex_hull(scene, options);
}

class InterruptHull : public testing::TestWithParam<const char*> {};

TEST_P(InterruptHull, OfABlob) {
  const Scene scene = make_scene(blob(3));
  expect_heard(GetParam(), [&](const Progress& progress) { find_hull(scene, progress); });
}

TEST_P(InterruptHull, OfACage) {
  Model model;
  Part part;
  add_cage(part, cube_cage(), "cage", {.accuracy = 1e-6, .progress = {}});
  model.add_part(std::move(part), smooth_join_angle);
  const Scene scene(model, {1, {}});
  expect_heard(GetParam(), [&](const Progress& progress) { find_hull(scene, progress); });
}

INSTANTIATE_TEST_SUITE_P(Steps, InterruptHull,
                         testing::Values("cull", "trace", "stitch", "sample", "mesh"),
                         [](const auto& step) { return std::string(step.param); });

/// What takes long on large models and evaluates nothing.
TEST(Interrupt, AskedForBefore) {
  const Scene scene = make_scene(teapot());
  const Hull hull = convex_hull(scene, {.relative = 1e-2, .progress = {}});
  const PolygonMesh mesh = polygons(hull.mesh);
  std::stop_source source;
  const ContactGeometry geometry(scene, source.get_token());
  const SupportQuery query(scene, source.get_token());
  EXPECT_NO_THROW(geometry.check_stop());
  EXPECT_NO_THROW(query.check_stop());
  source.request_stop();
  EXPECT_THROW(geometry.check_stop(), Cancelled);
  EXPECT_THROW(query.check_stop(), Cancelled);
  EXPECT_THROW(ContactGeometry(scene, source.get_token()), Cancelled);
  EXPECT_THROW(MapPieces(geometry, 1e-8), Cancelled);
  EXPECT_THROW(TopParts{geometry}, Cancelled);
  EXPECT_THROW(ContactFaces(geometry, *hull.boundary), Cancelled);
  Progress progress;
  progress.stop = source.get_token();
  EXPECT_THROW(Scene(scene.model(), {1, progress}), Cancelled);
  EXPECT_THROW(make_hull_mesh(mesh.points, mesh.polygons, progress), Cancelled);
}

/// The teapot's hull, whose boundary is complete.
struct Teapot {
  Scene scene = make_scene(teapot());
  Hull hull = convex_hull(scene);
};

TEST(Interrupt, Measuring) {
  const Teapot teapot;
  expect_heard("", [&](const Progress& progress) {
    measure(teapot.scene, ContactGeometry(teapot.scene, progress.stop), *teapot.hull.boundary);
  });
}

TEST(Interrupt, VerifyingADocument) {
  const Teapot teapot;
  const HullDocument document = hull_document(teapot.scene, *teapot.hull.boundary);
  expect_heard("", [&](const Progress& progress) {
    VerifyOptions options;
    options.threads = 1;
    options.progress = progress;
    verify(document, teapot.scene, options);
  });
}

TEST(Interrupt, VerifyingAMesh) {
  const Teapot teapot;
  const PolygonMesh mesh = polygons(teapot.hull.mesh);
  expect_heard("", [&](const Progress& progress) {
    VerifyOptions options;
    options.threads = 1;
    options.progress = progress;
    verify(mesh, teapot.scene, options);
  });
}

}  // namespace
}  // namespace taut_test
