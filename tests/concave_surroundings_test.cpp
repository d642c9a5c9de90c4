#include "taut/envelope/cull/concave_surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "models.h"
#include "taut/core/error.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A cell of a patch with what is to be known of its normals.
struct AskedCell {
  int instance, patch;
  PatchCell cell;
  NormalPyramid pyramid;
  double outward;             ///< the sign of the outward normals
  std::vector<dvec3> points;  ///< some of it, in model coordinates
  bool on(ConcaveSurroundings& surroundings) const {
    return surroundings.surely_on(instance, patch, cell, pyramid, outward);
  }
};

/// All cells of a level whose normals are bounded. `out` tells the outward direction at a point.
template <class Outward>
std::vector<AskedCell> asked_cells(const Scene& scene, int level, const Outward& out) {
  std::vector<AskedCell> result;
  ConcaveSurfaces surfaces(scene);
  for (int instance = 0; instance < to_int(scene.model().instances().size()); ++instance) {
    const Instance& placed = scene.model().instances()[to_size(instance)];
    for (int patch = 0; patch < to_int(surfaces.patches(placed.part).size()); ++patch) {
      const ConcavePatch& surface = surfaces.patch(placed.part, patch);
      for (std::uint32_t k = 0; k < (1U << (2 * level)); ++k) {
        const PatchCell cell{level, k >> level, k % (1U << level)};
        const auto pyramid = surface.curvature_nets().normals(cell.u(), cell.v());
        if (!pyramid) continue;
        std::vector<dvec3> points;
        for (const double s : {0.5, 0.0, 1.0}) {
          for (const double t : {0.5, 0.0, 1.0}) {
            points.push_back(
                scene.point({instance, SourceKind::face, patch, cell.u().at(s), cell.v().at(t)}));
          }
        }
        const dvec3 n = unit_normal(surface.bezier(), cell.u().at(0.5), cell.v().at(0.5));
        const bool outward = glm::dot(placed.pose.rotation * n, out(points[0])) > 0;
        result.push_back({instance, patch, cell, *pyramid, outward ? 1.0 : -1.0, points});
      }
    }
  }
  return result;
}

/// All of a sphere is on its hull, poles included, and nothing of one inside of it.
TEST(ConcaveSurroundings, OfSpheresWithinEachOther) {
  const dvec3 center(0.1, -0.2, 0.3);
  const Scene scene = make_scene(sphere() + shifted(sphere(0.4), center));
  ConcaveSurroundings surroundings(scene);
  const auto out = [&](const dvec3& x) { return glm::length(x) > 0.999 ? x : x - center; };
  int outer = 0;
  for (AskedCell& asked : asked_cells(scene, 2, out)) {
    const bool expected = asked.patch < 8;
    EXPECT_EQ(asked.on(surroundings), expected) << asked.patch << ' ' << asked.cell.i;
    asked.outward = -asked.outward;
    EXPECT_FALSE(asked.on(surroundings));
    outer += expected ? 1 : 0;
  }
  EXPECT_EQ(outer, 8 * 16);
}

/// Of two equal spheres, instances of one, a point is on the hull where its normal does not lean
/// towards the centre of the other one.
TEST(ConcaveSurroundings, OfInstancesIsWhatFacesNoOther) {
  Random random(1);
  const std::vector<dvec3> centers = {{0, 0, 0}, {3, 0.4, -0.1}};
  Model model = make_model(sphere());
  model.clear_instances();
  for (const dvec3& c : centers) model.add_instance(0, {random_rotation(random), c});
  const Scene scene(std::move(model), {.threads = 1, .progress = {}});
  ConcaveSurroundings surroundings(scene);
  const auto own = [&](const dvec3& x) {
    return *std::min_element(centers.begin(), centers.end(), [&](const dvec3& a, const dvec3& b) {
      return glm::distance(a, x) < glm::distance(b, x);
    });
  };
  int on = 0;
  int off = 0;
  for (const AskedCell& asked : asked_cells(scene, 2, [&](const dvec3& x) { return x - own(x); })) {
    const dvec3 center = centers[std::size_t(asked.instance)];
    double towards = -1;
    for (const dvec3& other : centers) {
      if (other == center) continue;
      for (const dvec3& x : asked.points) {
        towards = std::max(towards, glm::dot(x - center, unit(other - center)));
      }
    }
    const bool found = asked.on(surroundings);
    if (towards > 0) {
      EXPECT_FALSE(found) << towards;
    }
    if (towards < -0.2) {
      EXPECT_TRUE(found) << towards;
    }
    on += towards < -0.2 ? 1 : 0;
    off += towards > 0 ? 1 : 0;
  }
  EXPECT_GT(on, 30);
  EXPECT_GT(off, 100);
}

/// Nothing of a torus within its circles on top and below, and what is well outside of them.
TEST(ConcaveSurroundings, OfATorusIsItsOuterSide) {
  const Scene scene = make_scene(torus(2, 0.5));
  ConcaveSurroundings surroundings(scene);
  const auto out = [](const dvec3& x) { return x - 2.0 * unit(dvec3(x.x, x.y, 0)); };
  int outer = 0;
  for (const AskedCell& asked : asked_cells(scene, 3, out)) {
    double nearest = 3;
    for (const dvec3& x : asked.points) nearest = std::min(nearest, std::hypot(x.x, x.y));
    const bool found = asked.on(surroundings);
    if (nearest < 1.999) {
      EXPECT_FALSE(found);
    }
    if (nearest > 2.39) {
      EXPECT_TRUE(found) << nearest;
      ++outer;
    }
  }
  EXPECT_GT(outer, 150);
}

/// Begun anew, answers are those of a new object, in whatever order cells were asked before.
TEST(ConcaveSurroundings, BegunAnewForgetWhatWasBefore) {
  const Scene scene = make_scene(blob(2));
  const std::vector<AskedCell> cells = asked_cells(scene, 2, [](const dvec3& x) { return x; });
  ConcaveSurroundings used(scene);
  int before = 0;
  int after = 0;
  for (std::size_t k = 0; k < cells.size(); k += 5) before += cells[k].on(used) ? 1 : 0;
  used.begin_anew();
  ConcaveSurroundings fresh(scene);
  for (std::size_t k = cells.size(); k > 2; k -= 2) {
    const bool on = cells[k - 1].on(fresh);
    EXPECT_EQ(cells[k - 1].on(used), on) << k;
    after += on ? 1 : 0;
  }
  EXPECT_GT(before, 10);
  EXPECT_GT(after, 20);
}

TEST(ConcaveSurroundings, StopWhenTold) {
  const Scene scene = make_scene(sphere());
  const AskedCell asked = asked_cells(scene, 1, [](const dvec3& x) { return x; }).front();
  std::stop_source stop;
  ConcaveSurroundings surroundings(scene, stop.get_token());
  EXPECT_TRUE(asked.on(surroundings));
  surroundings.begin_anew();
  stop.request_stop();
  EXPECT_THROW(asked.on(surroundings), Cancelled);
}

}  // namespace
}  // namespace taut
