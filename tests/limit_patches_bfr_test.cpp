#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bfr_surface.h"
#include "cages.h"
#include "refined_cage.h"
#include "taut/subdivision/limit_patches.h"

// Limit positions and normals against OpenSubdiv's Bfr, whose evaluation is of its own making but
// for the masks of subdivision.

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: cages

/// Where a point is nearest to a patch.
struct Foot {
  double distance = std::numeric_limits<double>::infinity();
  dvec3 normal = dvec3(0.0);
  /// |Su x Sv| by the greater square of these: what rounding does to the normal goes by its
  /// inverse.
  double regularity = 0;
  double extent = 0;  ///< the patch's
};

/// A step's end, no nearer to 0 and 1 than a hundredth of what it begins.
double within(double t, double step) { return std::clamp(t + step, 0.01 * t, 1 - 0.01 * (1 - t)); }

/// By the method of Levenberg and Marquardt from one of 9 x 9 parameters, within the patch. Its
/// sides may be points, and all of it a curve. It may be folded, corner to corner: steps that begin
/// in a fold stay there, so that there is no parameter in the corners or in a symmetric place. Of
/// slivers, as at the tip of a fin, it takes hundreds of short steps.
Foot foot_on(const BezierPatch& patch, const dvec3& x) {
  constexpr int grid = 9;
  double u = 0;
  double v = 0;
  double best = std::numeric_limits<double>::infinity();
  const auto try_at = [&](double s, double t) {
    const double d = glm::distance(point(patch, s, t), x);
    if (d >= best) return false;
    best = d;
    u = s;
    v = t;
    return true;
  };
  for (int i = 0; i < grid; ++i) {
    for (int j = 0; j < grid; ++j) try_at((i + 0.3) / grid, (j + 0.6) / grid);
  }
  double damping = 1e-3;
  for (int k = 0; k < 1000 && damping < 1e12; ++k) {
    const PatchJet1 jet = jet1(patch, u, v);
    const dvec3 off = x - jet.S;
    const double trace = glm::dot(jet.Su, jet.Su) + glm::dot(jet.Sv, jet.Sv);
    const double uu = glm::dot(jet.Su, jet.Su) + damping * trace;
    const double uv = glm::dot(jet.Su, jet.Sv);
    const double vv = glm::dot(jet.Sv, jet.Sv) + damping * trace;
    const double determinant = uu * vv - uv * uv;
    if (determinant <= 0) {
      damping = 30 * std::max(damping, std::numeric_limits<double>::epsilon());
      continue;
    }
    const double a = glm::dot(jet.Su, off);
    const double b = glm::dot(jet.Sv, off);
    const double du = (vv * a - uv * b) / determinant;
    const double dv = (uu * b - uv * a) / determinant;
    const bool nearer = try_at(within(u, du), within(v, dv));
    damping *= nearer ? 0.01 : 30;
  }
  const PatchJet1 jet = jet1(patch, u, v);
  const double most = std::max(glm::dot(jet.Su, jet.Su), glm::dot(jet.Sv, jet.Sv));
  return {best, unit_normal(patch, u, v), glm::length(glm::cross(jet.Su, jet.Sv)) / most, 0};
}

/// Patches with the boxes of their control points.
class FacePatches {
 public:
  explicit FacePatches(const ControlCage& cage, const LimitSurface& surface)
      : patches_(cage.faces.size()) {
    for (const SurfacePatch& patch : surface.patches) {
      Box box;
      for (const dvec4& p : patch.bezier.points) box.include(dvec3(p));
      patches_[std::size_t(patch.cage_face)].push_back({&patch, box});
    }
  }

  /// On the face's exact patches within `reach`, the nearest.
  Foot foot(int face, const dvec3& x, double reach) const {
    Foot nearest;
    for (const auto& [patch, box] : patches_[std::size_t(face)]) {
      if (!patch->exact || distance(box, x) > reach) continue;
      const Foot foot = foot_on(patch->bezier, x);
      if (foot.distance >= nearest.distance) continue;
      nearest = foot;
      nearest.extent = diagonal(box);
    }
    return nearest;
  }

  /// The box of a patch that stands for the surface is as near as its own size.
  bool is_near_stand_in(int face, const dvec3& x) const {
    const auto& all = patches_[std::size_t(face)];
    return std::any_of(all.begin(), all.end(), [&](const BoxedPatch& p) {
      return !p.patch->exact && distance(p.box, x) <= diagonal(p.box);
    });
  }

 private:
  struct BoxedPatch {
    const SurfacePatch* patch;
    Box box;
  };
  std::vector<std::vector<BoxedPatch>> patches_;
};

/// Of Bfr's normals within its Gregory patches.
constexpr double gregory_normal_error = 0.05;

/// Points of Bfr's that were on exact patches.
class Comparison {
 public:
  Comparison(const ControlCage& cage, const LimitSurface& surface, std::string name)
      : patches_(cage, surface), size_(size_of(cage)), name_(std::move(name)) {
    const auto refiner = refiner_of(cage);
    for (const std::vector<int>& face : cage.faces) {
      manifold_.push_back(std::none_of(face.begin(), face.end(), [&](int v) {
        return refiner->GetLevel(0).IsVertexNonManifold(v);
      }));
    }
  }

  void expect(int face, const BfrPoint& p);
  int exactly() const { return exactly_; }
  int roughly() const { return roughly_; }

 private:
  FacePatches patches_;
  double size_;
  std::string name_;
  std::vector<bool> manifold_;  // by face: all its vertices are
  int exactly_ = 0;
  int roughly_ = 0;  // where Bfr ends in Gregory patches
};

void Comparison::expect(int face, const BfrPoint& p) {
  const double rounding = 1e-15 * size_;
  const bool exact = p.error <= rounding;
  const double allowed = exact ? rounding : p.error;
  const Foot foot = patches_.foot(face, p.x, 2 * allowed);
  if (foot.distance > allowed && patches_.is_near_stand_in(face, p.x)) return;
  ++(exact ? exactly_ : roughly_);
  EXPECT_LE(foot.distance, allowed) << name_ << ", face " << face;
  // At the sharp corners that non-manifold vertices are, Bfr's Gregory patches have no sound
  // normals.
  if (p.normal == dvec3(0.0) || (!exact && !manifold_[std::size_t(face)])) return;
  const double normal_error =
      exact ? (1e-12 + 8 * rounding / foot.extent) / foot.regularity : gregory_normal_error;
  EXPECT_LE(glm::length(glm::cross(foot.normal, p.normal)), normal_error)
      << name_ << ", face " << face;
}

/// At `count` random places anywhere in faces, and as many near their corners.
void expect_patches(const ControlCage& cage, double accuracy, int count, const std::string& name) {
  Random random(29);
  LimitOptions options;
  options.accuracy = accuracy;
  const LimitSurface surface = limit_patches(cage, options);
  Comparison comparison(cage, surface, name);
  const BfrSurface bfr(cage);
  int places = 0;
  for (int k = 0; k < count; ++k) {
    const int face = pick(random, 0, int(cage.faces.size()) - 1);
    if (!bfr.has_surface(face)) continue;
    const double near = log_uniform(random, 1e-4, 0.5);
    comparison.expect(face, bfr.point(face, random));
    comparison.expect(face, bfr.point_near_corner(face, near, random));
    places += 2;
  }
  EXPECT_GT(5 * (comparison.exactly() + comparison.roughly()), 3 * places) << name;
  EXPECT_GT(2 * comparison.exactly(), places) << name;
}

TEST(LimitPatches, AreWhatBfrEvaluates) {
  for (const auto& [name, cage] : all_cages()) expect_patches(cage, 1e-6, 200, name);
}

TEST(LimitPatches, OfATwoSidedFinAreWhatBfrEvaluates) {
  expect_patches(two_sided_fin_cage(), 1e-6, 3000, "loop with a fin");
}

void expect_patches(const char* file, Scheme scheme, int count) {
  constexpr double coarse = 0.1;  // of the cage alone there is need
  const std::optional<Model> model = model_from_elsewhere(file, scheme, coarse);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with " << file;
  expect_patches(cage_of(*model), default_cage_accuracy, count, file);
}

TEST(LimitPatches, OfACarAreWhatBfrEvaluates) {
  expect_patches("A15_osd_car_creases_boundary.obj", Scheme::catmark, 3000);
}
TEST(LimitPatches, OfSheetsAreWhatBfrEvaluates) {
  expect_patches("A16_osd_edgecorner_boundary.obj", Scheme::catmark, 300);
}
TEST(LimitPatches, OfANonManifoldCageAreWhatBfrEvaluates) {
  expect_patches("A17_osd_nonmanifold_edges.obj", Scheme::catmark, 1000);
}
TEST(LimitPatches, OfSemiSharpIcosahedraAreWhatBfrEvaluates) {
  expect_patches("A18_osd_loop_icos_semisharp.obj", Scheme::loop, 1000);
}
TEST(LimitPatches, OfATorusAreWhatBfrEvaluates) {
  expect_patches("A19_torus_quad_smooth.off", Scheme::catmark, 300);
}
TEST(LimitPatches, OfATriangulatedCubeAreWhatBfrEvaluates) {
  expect_patches("A20_cube_binary.ply", Scheme::catmark, 300);
  expect_patches("A20_cube_binary.ply", Scheme::loop, 300);
}

}  // namespace
}  // namespace taut
