#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cages.h"
#include "error_checks.h"
#include "models.h"
#include "refined_cage.h"
#include "taut/bounds/model_support.h"
#include "taut/bounds/scene.h"
#include "taut/core/error.h"
#include "taut/core/progress.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/add_cage.h"
#include "taut/subdivision/cage_level.h"
#include "taut/subdivision/conforming.h"
#include "taut/subdivision/dart_limit.h"
#include "taut/subdivision/edge_middles.h"
#include "taut/subdivision/extraction.h"
#include "taut/subdivision/limit_patches.h"
#include "taut/subdivision/point_hull_distance.h"
#include "taut/subdivision/refiner.h"
#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/touch_test.h"
#include "taut/subdivision/triangle_points.h"
#include "taut/surface/point_grid.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: cages

/// Points known by place.
class PointSet {
 public:
  PointSet(const std::vector<LimitPoint>& points, const Box& box, double tolerance)
      : points_(points), grid_(box, tolerance) {
    for (std::size_t i = 0; i < points.size(); ++i) grid_.insert(points[i].x, int(i));
  }
  const LimitPoint* find(const dvec3& x) const {
    const LimitPoint* found = nullptr;
    grid_.visit_near(x, [&](int i) { found = &points_[std::size_t(i)]; });
    return found;
  }

 private:
  const std::vector<LimitPoint>& points_;
  PointGrid grid_;
};

/// The caps about the middle of a polygon of so many sides that they are not made all at once.
TEST(CageLevel, CapsOfARegularPolygonAreOneTurned) {
  constexpr int sides = 500;
  const auto turn = [&](int k) {
    const double t = 2 * std::numbers::pi * k / sides;
    return dmat3(std::cos(t), std::sin(t), 0, -std::sin(t), std::cos(t), 0, 0, 0, 1);
  };
  ControlCage cage;
  std::vector<int>& face = cage.faces.emplace_back();
  for (int k = 0; k < sides; ++k) {
    face.push_back(k);
    cage.points.push_back(turn(k) * dvec3(1, 0, 0));
  }
  EdgeMiddles middles(sides);
  const CageLevel polygon(cage);
  const std::vector<std::size_t> all = {0};
  const CageLevel level = polygon.refined(all, middles);
  const std::vector<CellPatch> patches = level.patches({});
  ASSERT_EQ(patches.size(), std::size_t(sides));
  for (int k = 0; k < sides; ++k) {
    const CellPatch& patch = patches[std::size_t(k)];
    ASSERT_EQ(patch.kind, CellPatch::Kind::cap);
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      EXPECT_LT(glm::distance(patch.points[i], turn(k) * patches[0].points[i]), 1e-13) << k;
    }
  }
  std::stop_source stop;
  stop.request_stop();
  Progress stopped;
  stopped.stop = stop.get_token();
  EXPECT_THROW(level.patches(stopped), Cancelled);
}

/// Patches of few levels against limit masks at their corners, and where they are four times finer.
TEST(LimitPatches, AreExactWhereTheySaySo) {
  for (const auto& [name, cage] : all_cages()) {
    if (name.find("sharpness 8") != name.npos || name.find("4.0") != name.npos) continue;
    if (cage.points.size() > 60) continue;
    LimitOptions options;
    options.accuracy = 0.05;
    const LimitSurface surface = limit_patches(cage, options);
    ASSERT_LE(surface.levels, 4) << name;
    // The quarters of a patch of the last level.
    const std::vector<LimitPoint> points = limit_points(cage, std::max(2, surface.levels) + 2);
    Box box;
    for (const dvec3& p : cage.points) box.include(p);
    const double tolerance = 1e-7 * size_of(cage);
    const PointSet set(points, box, tolerance);
    int exact = 0;
    for (const SurfacePatch& patch : surface.patches) {
      if (!patch.exact) continue;
      ++exact;
      const bool whole = patch.bezier.degree_u == 3 && patch.bezier.degree_v == 3;
      for (const double u : {0.0, 0.5, 1.0}) {
        for (const double v : {0.0, 0.5, 1.0}) {
          if (!whole && (u == 0.5 || v == 0.5)) continue;
          if (!whole && cage.scheme == CageScheme::loop && (u == 1 && v == 1)) continue;
          const dvec3 x = point(patch.bezier, u, v);
          const LimitPoint* const limit = set.find(x);
          ASSERT_NE(limit, nullptr) << name << " at " << u << " " << v;
          EXPECT_LE(glm::distance(limit->x, x), 4e-14 * size_of(cage)) << name;
          if (limit->normal == dvec3(0.0) || u != 0.5 || v != 0.5) continue;
          EXPECT_LE(glm::length(glm::cross(limit->normal, unit_normal(patch.bezier, u, v))), 1e-11)
              << name;
        }
      }
    }
    EXPECT_GT(exact, 0) << name;
  }
}

/// Support values at the limit normals of limit points that are support points: by masks, and by
/// the patches.
void expect_support_values(const std::string& name, const ControlCage& cage, double accuracy) {
  const Scene scene(cage_model(cage, accuracy));
  const double bound = scene.model().deviation_bound();
  const double rounding = 1e-12 * size_of(cage);
  SupportQuery query(scene);
  // Masks are those of limits once semi-sharp creases are smooth.
  double sharpest = 4;
  for (const CageCrease& crease : cage.creases) {
    if (crease.sharpness < infinite_sharpness) sharpest = std::max(sharpest, crease.sharpness);
  }
  const std::vector<LimitPoint> points = limit_points(cage, int(std::ceil(sharpest)));
  int checked = 0;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 100);
  for (std::size_t i = 0; i < points.size(); i += step) {
    if (points[i].normal == dvec3(0.0)) continue;
    for (const double sign : {-1.0, 1.0}) {
      const dvec3 n = sign * points[i].normal;
      double most = -std::numeric_limits<double>::infinity();
      for (const LimitPoint& p : points) most = std::max(most, glm::dot(p.x, n));
      const ModelSupport s = support(query, scene, n);
      // Never below a point of the surface.
      ASSERT_GE(s.h_bound, most - bound - rounding) << name;
      // Elsewhere on the surface it may reach farther, between limit points.
      if (glm::distance(s.point, points[i].x) > 1e-4 * size_of(cage)) continue;
      ++checked;
      ASSERT_LE(s.h, glm::dot(points[i].x, n) + bound + rounding) << name << " limit point " << i;
    }
  }
  EXPECT_GT(checked, 0) << name;
}

TEST(LimitPatches, SupportValuesAreThoseOfLimitMasks) {
  for (const auto& [name, cage] : smooth_cages()) {
    if (name.find("50") == name.npos) expect_support_values(name, cage, 1e-9);
  }
}

TEST(LimitPatches, SupportValuesOfTaggedCages) {
  for (const auto& [name, cage] : tagged_cages()) expect_support_values(name, cage, 1e-6);
}

TEST(LimitPatches, SupportValuesAtValence50) {
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    expect_support_values("valence 50", dome_cage(scheme, 50), 1e-5);
  }
}

/// Up to a dozen faces around a vertex the bound comes below the accuracy.
TEST(LimitPatches, KeepTheirAccuracy) {
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    for (const int n : {3, 5, 6, 7, 8}) {
      const ControlCage cage = dome_cage(scheme, n);
      for (const double accuracy : {1e-3, 1e-6, 1e-8}) {
        LimitOptions options;
        options.accuracy = accuracy;
        EXPECT_LE(limit_patches(cage, options).deviation_bound, accuracy * size_of(cage))
            << name_of(scheme) << " " << n;
      }
    }
  }
}

/// Where three triangles meet, the curvature of Loop's surfaces has no bound: caps are much farther
/// from their corners' plane than from the surface.
TEST(LimitPatches, KeepTheirAccuracyAtSharpTips) {
  for (const int k : {1, 2, 3}) {
    const ControlCage rim = semi_sharp_rim_cage(k);
    ControlCage upright = triangulated(box_cage({k}));
    make_sharp(upright, [](const dvec3& p) { return p.x == 1 && p.y == 1; });
    for (const ControlCage& cage : {rim, upright}) {
      EXPECT_LE(limit_patches(cage, {}).deviation_bound, LimitOptions().accuracy * size_of(cage))
          << k << " " << cage.creases.size();
    }
  }
}

/// The largest angle between the normals on both sides of smooth joins, and the number of joins
/// between two caps of this degree. All joins, or those of exact patches and such caps alone:
/// others stand where nothing touches the hull, and may have kinks.
std::pair<double, int> largest_kink(const Part& part, int degree, bool all) {
  double kink = 0;
  int count = 0;
  const auto may_kink = [&](const Patch& patch) {
    return !all && patch.stand_in && patch.bezier.degree_u != degree;
  };
  for (const Patch& patch : part.patches()) {
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      if (border.kind != BorderKind::smooth) continue;
      const Patch& other = part.patches()[std::size_t(border.neighbor)];
      if (may_kink(patch) || may_kink(other)) continue;
      const bool are_caps = patch.bezier.degree_u == degree && other.bezier.degree_u == degree;
      count += are_caps && patch.stand_in && other.stand_in ? 1 : 0;
      for (int k = 0; k <= 8; ++k) {
        const dvec2 at = on_side(side, k / 8.0);
        const dvec2 there = on_side(border.neighbor_side, border.reversed ? 1 - k / 8.0 : k / 8.0);
        const dvec3 n = unit_normal(patch.bezier, at.x, at.y);
        kink =
            std::max(kink, glm::length(glm::cross(n, unit_normal(other.bezier, there.x, there.y))));
      }
    }
  }
  return {kink, count};
}

/// All faces of these domes touch the hull, and so do all caps.
TEST(LimitPatches, CapsMeetSmoothly) {
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    const bool loop = scheme == CageScheme::loop;
    for (const int n : {3, 4, 5, 6, 7, 8, 12}) {
      if (n == (loop ? 6 : 4)) continue;
      for (const double accuracy : {1e-3, 1e-6}) {
        const Model model = cage_model(dome_cage(scheme, n), accuracy);
        const auto [kink, count] = largest_kink(model.parts()[0], loop ? 6 : 5, true);
        EXPECT_GE(count, loop ? 10 * n : 2 * n) << n;
        // Tangents have the rounding of coordinates over the patches' size, whose square is the
        // deviation.
        EXPECT_LE(kink, 1e-12 / std::sqrt(accuracy))
            << name_of(scheme) << " " << n << " " << accuracy;
      }
    }
  }
}

/// With a sharp edge from its top to the rim.
ControlCage dome_with_darts(CageScheme scheme, int valence) {
  ControlCage cage = dome_cage(scheme, valence);
  cage.creases = {{{0, 2}, infinite_sharpness}};
  return cage;
}

TEST(LimitPatches, CapsMeetSmoothlyAtDarts) {
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    const bool loop = scheme == CageScheme::loop;
    for (const int n : {3, 4, 5, 6, 7, 12}) {
      for (const double accuracy : {1e-3, 1e-6}) {
        const ControlCage cage = dome_with_darts(scheme, n);
        const Model model = cage_model(cage, accuracy);
        const auto [kink, count] = largest_kink(model.parts()[0], loop ? 6 : 5, false);
        EXPECT_GE(count, n) << n;
        EXPECT_LE(kink, 1e-12 / std::sqrt(accuracy))
            << name_of(scheme) << " " << n << " " << accuracy;
        LimitOptions options;
        options.accuracy = accuracy;
        EXPECT_LE(limit_patches(cage, options).deviation_bound, accuracy * size_of(cage));
      }
    }
  }
}

bool is_dart(const RefinedCage& cage, int vertex) {
  const auto edges = cage.level().GetVertexEdges(vertex);
  const auto sharp = std::count_if(edges.begin(), edges.end(),
                                   [&](int e) { return cage.level().IsEdgeInfSharp(e); });
  return sharp == 1 && !cage.level().IsVertexInfSharp(vertex);
}

/// The points about a dart as dart_limit() takes them.
std::vector<dvec3> ring_about(const RefinedCage& cage, int dart) {
  const auto level = cage.level();
  const auto edges = level.GetVertexEdges(dart);
  const auto faces = level.GetVertexFaces(dart);
  const int first =
      int(std::find_if(edges.begin(), edges.end(), [&](int e) { return level.IsEdgeInfSharp(e); }) -
          edges.begin());
  std::vector<int> ring = {dart};
  for (int k = 0; k < edges.size(); ++k) {
    const auto ends = level.GetEdgeVertices(edges[(first + k) % edges.size()]);
    ring.push_back(ends[0] == dart ? ends[1] : ends[0]);
  }
  for (int k = 0; k < faces.size(); ++k) {
    const auto corners = level.GetFaceVertices(faces[(first + k) % faces.size()]);
    if (corners.size() == 3) break;
    const auto at = std::find(corners.begin(), corners.end(), dart) - corners.begin();
    ring.push_back(corners[int((at + 2) % 4)]);
  }
  std::vector<dvec3> points;
  for (const int v : ring) points.push_back(cage.points()[std::size_t(v)]);
  return points;
}

/// The dart among the corners of the faces that is nearest to a point.
int nearest_dart(const RefinedCage& cage, const dvec3& x) {
  int found = -1;
  const auto distance = [&](int v) { return glm::distance(cage.points()[std::size_t(v)], x); };
  for (const int face : cage.faces()) {
    for (const int v : cage.level().GetFaceVertices(face)) {
      if (is_dart(cage, v) && (found < 0 || distance(v) < distance(found))) found = v;
    }
  }
  return found;
}

/// Rings of all levels have the limit to which refinement leads.
TEST(DartLimit, IsWhereRefinementLeads) {
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    for (const int n : {3, 4, 5, 6, 7, 8, 12}) {
      const ControlCage cage = dome_with_darts(scheme, n);
      for (const int end : {0, 2}) {
        RefinedCage level(cage, 2);
        int dart = nearest_dart(level, cage.points[std::size_t(end)]);
        ASSERT_GE(dart, 0);
        const std::optional<VertexLimit> limit = dart_limit(scheme, ring_about(level, dart));
        ASSERT_TRUE(limit.has_value());
        const double slack = 1e-14 * size_of(cage);
        for (int k = 3; k <= 40; ++k) {
          const auto faces = level.level().GetVertexFaces(dart);
          level = level.refined({faces.begin(), faces.end()});
          dart = nearest_dart(level, limit->x);
          ASSERT_GE(dart, 0);
          if (k > 10) continue;
          const std::optional<VertexLimit> finer = dart_limit(scheme, ring_about(level, dart));
          ASSERT_TRUE(finer.has_value());
          EXPECT_LT(glm::distance(finer->x, limit->x), slack);
          // The ring has the rounding of coordinates over its size.
          EXPECT_LT(glm::length(glm::cross(finer->normal, limit->normal)), 1e-14 * std::pow(3, k));
        }
        // The way left halves about from level to level; it goes with a power of 0.62 at the most.
        EXPECT_LT(glm::distance(level.points()[std::size_t(dart)], limit->x), 1e-7 * size_of(cage));
      }
    }
  }
}

TEST(DartLimit, HasNoNormalWhereTheRingIsInOneLine) {
  std::vector<dvec3> ring;
  for (int k = 0; k < 9; ++k) ring.emplace_back(k, 2 * k, 3 * k);
  EXPECT_FALSE(dart_limit(CageScheme::catmark, ring));
  EXPECT_FALSE(dart_limit(CageScheme::loop, ring));
}

TEST(LimitPatches, RefineOnlyWhatCanTouch) {
  // A torus whose inside has an extraordinary vertex: two quads there become a hexagon.
  ControlCage cage = torus_cage(12, 8);
  const int inner = 4;
  std::vector<int> a = cage.faces[std::size_t(inner)];
  const std::vector<int>& b = cage.faces[std::size_t(8 + inner)];
  cage.faces[std::size_t(inner)] = {a[0], a[1], b[1], b[2], a[2], a[3]};
  cage.faces.erase(cage.faces.begin() + 8 + inner);
  const LimitSurface surface = limit_patches(cage);
  EXPECT_EQ(surface.irregular_faces, 11);
  EXPECT_LE(surface.levels, 2);
  EXPECT_EQ(surface.deviation_bound, 0);
}

/// How far a point is from the closed uniform cubic spline of four control points.
double distance_from_spline(const std::array<dvec3, 4>& control, const dvec3& x) {
  const auto at = [&](double t) {
    const int first = int(std::floor(t));
    const double s = t - first;
    const std::array<double, 4> weight = {(1 - s) * (1 - s) * (1 - s),
                                          4 - 6 * s * s + 3 * s * s * s,
                                          1 + 3 * s + 3 * s * s - 3 * s * s * s, s * s * s};
    dvec3 p(0.0);
    for (int k = 0; k < 4; ++k) {
      p += weight[std::size_t(k)] / 6 * control[std::size_t((first + k + 4) % 4)];
    }
    return p;
  };
  const auto distance = [&](double t) { return glm::distance(at(t), x); };
  double nearest = 0;
  for (double t = 0; t < 4; t += 1.0 / 64) nearest = distance(t) < distance(nearest) ? t : nearest;
  double a = nearest - 1.0 / 32;
  double b = nearest + 1.0 / 32;
  for (int k = 0; k < 80; ++k) {
    const double third = (b - a) / 3;
    (distance(a + third) < distance(b - third) ? b : a) =
        distance(a + third) < distance(b - third) ? b - third : a + third;
  }
  return distance(0.5 * (a + b));
}

/// The caps of the top, alone between two pieces of its rim, have these for sides; what the rim's
/// own curvature is does not count for what they miss: nothing, where the top is flat.
TEST(LimitPatches, KeepToCreases) {
  for (const bool flat : {true, false}) {
    for (const bool triangles : {false, true}) {
      const ControlCage quads = rimmed_cage(flat);
      const ControlCage cage = triangles ? triangulated(quads) : quads;
      std::array<dvec3, 4> control;
      for (std::size_t k = 0; k < 4; ++k) {
        control[k] = quads.points[std::size_t(quads.creases[k].vertices[0])];
      }
      const LimitSurface surface = limit_patches(cage);
      int sides = 0;
      for (const SurfacePatch& patch : surface.patches) {
        for (const Side side : all_sides) {
          if (patch.smooth[std::size_t(side)]) continue;
          for (int k = 0; k <= 4; ++k) {
            const dvec2 uv = on_side(side, k / 4.0);
            EXPECT_LE(distance_from_spline(control, point(patch.bezier, uv.x, uv.y)), 1e-15);
          }
          ++sides;
        }
      }
      EXPECT_GE(sides, 16);
      EXPECT_LE(surface.deviation_bound, 1e-9 * size_of(cage));
      // Without levels of the caps at the rim.
      if (!triangles) {
        EXPECT_LE(sides, 32);
      }
    }
  }
}

/// A side of a patch, and the vertices from which and to which it runs.
struct SideUse {
  const SurfacePatch* patch;
  Side side;
  std::array<int, 2> vertices;
};

std::vector<SideUse> sides_of(const LimitSurface& surface) {
  constexpr std::array<std::array<std::size_t, 2>, 4> corners = {{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
  std::vector<SideUse> result;
  for (const SurfacePatch& patch : surface.patches) {
    for (const Side side : all_sides) {
      const auto [a, b] = corners[std::size_t(side)];
      result.push_back({&patch, side, {patch.vertices[a], patch.vertices[b]}});
    }
  }
  return result;
}

/// The largest distance of two sides that run between the same vertices.
double gap(const SideUse& a, const SideUse& b) {
  double largest = 0;
  const auto at = [](const SideUse& use, double t) {
    const dvec2 uv = on_side(use.side, t);
    return point(use.patch->bezier, uv.x, uv.y);
  };
  for (int k = 0; k <= 8; ++k) {
    const double t = k / 8.0;
    largest =
        std::max(largest, glm::distance(at(a, t), at(b, a.vertices == b.vertices ? t : 1 - t)));
  }
  return largest;
}

bool has_repeated_vertex(std::vector<int> face) {
  std::sort(face.begin(), face.end());
  return std::adjacent_find(face.begin(), face.end()) != face.end();
}

/// Of closed cages each side meets exactly one other, whole; one of the same patch only where a
/// face of the cage has an edge twice.
TEST(LimitPatches, WholeSidesMeet) {
  for (const auto& [name, cage] : closed_cages()) {
    for (const double accuracy : {0.1, 1e-3, 1e-5}) {
      if (accuracy < 1e-3 && name.find("50") != name.npos) continue;  // takes long
      LimitOptions options;
      options.accuracy = accuracy;
      const LimitSurface surface = limit_patches(cage, options);
      std::map<std::pair<int, int>, std::vector<SideUse>> uses;
      for (const SideUse& use : sides_of(surface)) {
        ASSERT_NE(use.vertices[0], use.vertices[1]) << name;
        uses[std::minmax({use.vertices[0], use.vertices[1]})].push_back(use);
      }
      double largest = 0;
      for (const auto& [vertices, sides] : uses) {
        ASSERT_EQ(sides.size(), 2U) << name << " to " << accuracy;
        if (!has_repeated_vertex(cage.faces[std::size_t(sides[0].patch->cage_face)])) {
          EXPECT_NE(sides[0].patch, sides[1].patch) << name;
        }
        EXPECT_FALSE(sides[0].patch == sides[1].patch && sides[0].side == sides[1].side) << name;
        largest = std::max(largest, gap(sides[0], sides[1]));
      }
      EXPECT_LE(largest, 4e-16 * size_of(cage)) << name << " to " << accuracy;
    }
  }
}

int open_sides(const Model& model) {
  int count = 0;
  for (const Patch& patch : model.parts()[0].patches()) {
    for (const Border& border : patch.borders) count += border.neighbor < 0 ? 1 : 0;
  }
  return count;
}

TEST(AddCage, SmoothCagesHaveNoEdges) {
  for (const auto& [name, cage] : smooth_cages()) {
    const Model model = cage_model(cage, 1e-5);
    const Part& part = model.parts()[0];
    EXPECT_EQ(part.faces().size(), cage.faces.size()) << name;
    EXPECT_EQ(part.edges().size(), 0U) << name;
    EXPECT_EQ(part.point_count(), 0) << name;
    EXPECT_EQ(open_sides(model), 0) << name;
  }
}

TEST(AddCage, ClosedCagesAreClosed) {
  for (const auto& [name, cage] : closed_cages()) {
    for (const double accuracy : {0.1, 1e-3}) {
      EXPECT_EQ(open_sides(cage_model(cage, accuracy)), 0) << name << " to " << accuracy;
    }
  }
}

/// A place of a face's parameters is one of one patch only, borders included.
TEST(AddCage, PatchesOfAFaceHaveNoPlaceInCommon) {
  const Model model = cage_model(dome_cage(CageScheme::catmark, 5), 1e-3);
  const Part& part = model.parts()[0];
  std::size_t most = 0;
  for (const Face& face : part.faces()) {
    std::vector<Interval> u;
    for (int k = 0; k < face.patch_count; ++k) {
      u.push_back(part.patches()[std::size_t(face.first_patch + k)].u);
    }
    std::sort(u.begin(), u.end(), [](auto& a, auto& b) { return a.lower < b.lower; });
    for (std::size_t k = 1; k < u.size(); ++k) EXPECT_LT(u[k - 1].upper, u[k].lower);
    most = std::max(most, u.size());
  }
  EXPECT_GT(most, 10U) << "something was compared";
}

/// Boundaries are regular where these have some: each edge has one patch.
void expect_open_at_boundaries(const char* file, Scheme scheme, double accuracy) {
  const std::optional<Model> model = model_from_elsewhere(file, scheme, accuracy);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with " << file;
  EXPECT_EQ(open_sides(*model), boundary_edges(cage_of(*model))) << file;
}

TEST(AddCage, CarIsOpenAtItsBoundary) {
  expect_open_at_boundaries("A15_osd_car_creases_boundary.obj", Scheme::catmark, 1e-3);
}
TEST(AddCage, SheetsAreOpenAtTheirBoundary) {
  expect_open_at_boundaries("A16_osd_edgecorner_boundary.obj", Scheme::catmark, 1e-9);
}
TEST(AddCage, SemiSharpIcosahedraAreClosed) {
  for (const double accuracy : {1e-2, 1e-9}) {
    expect_open_at_boundaries("A18_osd_loop_icos_semisharp.obj", Scheme::loop, accuracy);
  }
}
/// Patches are computed: however few digits the points of their cage have, small ones are not taken
/// for points.
TEST(AddCage, BordersOfACageWithRoundedPointsMeet) {
  const auto model = model_from_elsewhere("A18_osd_loop_icos_semisharp.obj", Scheme::loop, 1e-9);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with it";
  EXPECT_EQ(model->parts().front().coordinate_grid().kind, CoordinateGrid::Kind::decimals);
  EXPECT_LT(model->parts().front().join_gap(), 1e-14);
}
TEST(AddCage, TorusFromAFileIsClosed) {
  expect_open_at_boundaries("A19_torus_quad_smooth.off", Scheme::catmark, 1e-9);
}
TEST(AddCage, TriangulatedCubeIsClosed) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
    expect_open_at_boundaries("A20_cube_binary.ply", scheme, 1e-9);
  }
}

/// Parted as its sheets are, no open side has an end of another within.
TEST(AddCage, OpenSidesOfANonManifoldCageMeetWhole) {
  const std::optional<Model> model =
      model_from_elsewhere("A17_osd_nonmanifold_edges.obj", Scheme::catmark, 1e-9);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with it";
  const Part& part = model->parts()[0];
  std::vector<BezierCurve> open;
  for (const Patch& patch : part.patches()) {
    for (const Side side : all_sides) {
      const Border& at = patch.borders[std::size_t(side)];
      if (patch.repeats >= 0 || at.kind != BorderKind::edge || at.neighbor >= 0) continue;
      if (part.edges()[std::size_t(at.edge)].faces.size() == 1) {
        open.push_back(border(patch.bezier, side));
      }
    }
  }
  EXPECT_GE(open.size(), std::size_t(boundary_edges(cage_of(*model))));
  const double tolerance = 1e-6 * size_of(cage_of(*model));
  for (const BezierCurve& curve : open) {
    for (const BezierCurve& other : open) {
      const dvec3 end = point(other, 0);
      if (glm::distance(end, point(curve, 0)) < tolerance) continue;
      if (glm::distance(end, point(curve, 1)) < tolerance) continue;
      for (int k = 1; k < 64; ++k) {
        ASSERT_GT(glm::distance(end, point(curve, k / 64.0)), tolerance);
      }
    }
  }
}

TEST(AddCage, SharpEdgesAreEdges) {
  ControlCage box = cube_cage();
  for (const auto& f : box.faces) {
    for (std::size_t k = 0; k < 4; ++k) box.creases.push_back({{f[k], f[(k + 1) % 4]}, 10});
  }
  const Model model = cage_model(box);
  EXPECT_EQ(model.edge_count(), 12);
  EXPECT_EQ(model.vertex_count(), 8);
  EXPECT_EQ(model.patch_count(), 6);
  // The rim of a dome's top: a closed curve between twelve pairs of faces.
  ControlCage dome = dome_cage(CageScheme::catmark, 6);
  dome.creases = rim(dome, infinite_sharpness);
  EXPECT_GE(cage_model(dome, 1e-4).edge_count(), 12);
  const Model sheet = cage_model(sheet_cage(3, 4));
  EXPECT_EQ(sheet.vertex_count(), 4);
  EXPECT_EQ(sheet.edge_count(), 14);
}

TEST(AddCage, RefusesWhatIsNoCage) {
  Part part;
  ControlCage cage = cube_cage();
  cage.faces[2][1] = 8;
  EXPECT_THROW(add_cage(part, cage, "c"), InvalidInput);
  cage = cube_cage();
  cage.scheme = CageScheme::loop;
  EXPECT_THROW(add_cage(part, cage, "c"), InvalidInput);
  cage = cube_cage();
  cage.creases = {{{1, 1}, 2.0}};
  EXPECT_THROW(add_cage(part, cage, "c"), InvalidInput);
  cage.creases = {{{0, 1}, std::nan("")}};
  EXPECT_THROW(add_cage(part, cage, "c"), InvalidInput);
  EXPECT_TRUE(part.faces().empty());
}

/// What is asked for is either reached or said not to be.
TEST(AddCage, WarnsWhereTheAccuracyIsNotReached) {
  for (const double accuracy : {1e-6, 1e-13}) {
    const ControlCage cage = dome_cage(CageScheme::catmark, 5);
    std::vector<std::string> codes;
    CageOptions options;
    options.accuracy = accuracy;
    options.progress.warn = [&](std::string_view code, std::string_view) {
      codes.emplace_back(code);
    };
    Part part;
    add_cage(part, cage, "c", options);
    const LimitSurface surface = limit_patches(cage, {.accuracy = accuracy, .progress = {}});
    EXPECT_NEAR(surface.accuracy / size_of(cage), accuracy, 1e-12 * accuracy);
    const bool missed = surface.deviation_bound > surface.accuracy;
    EXPECT_EQ(missed, accuracy == 1e-13);
    EXPECT_EQ(codes == std::vector<std::string>{"cage-accuracy"}, missed);
    EXPECT_EQ(codes.empty(), !missed);
  }
}

/// Three sheets along one edge, and a face with a vertex twice.
TEST(AddCage, WarnsOfNonManifoldCages) {
  ControlCage cage;
  cage.points = {{0, 0, 0},  {0, 0, 1},  {1, 0, 0},   {1, 0, 1},
                 {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}};
  cage.faces = {{0, 2, 3, 1}, {0, 4, 5, 1}, {0, 6, 7, 1}};
  std::vector<std::string> codes;
  CageOptions options;
  options.progress.warn = [&](std::string_view code, std::string_view) {
    codes.emplace_back(code);
  };
  Part part;
  add_cage(part, cage, "c", options);
  EXPECT_EQ(codes, std::vector<std::string>{"non-manifold-cage"});
  part.connect(1e-3);
  EXPECT_EQ(part.patches().size(), 3U);
  EXPECT_TRUE(std::any_of(part.edges().begin(), part.edges().end(),
                          [](const Edge& e) { return e.faces.size() == 3; }));
}

TEST(Tapered, IsTheSamePatch) {
  Random random(3);
  for (const int m : {1, 2, 3}) {
    for (const int n : {1, 3, 4}) {
      const BezierPatch patch = random_patch(random, m, n, 1);
      const BezierPatch part = tapered(patch, 0.75, 0.25);
      EXPECT_EQ(part.degree_v, m + n);
      for (const double s : {0.0, 0.3, 1.0}) {
        for (const double t : {0.0, 0.6, 1.0}) {
          const double u = s * (0.75 * (1 - t) + 0.25 * t);
          EXPECT_LE(glm::distance(point(part, s, t), point(patch, u, t)), 1e-14);
        }
      }
    }
  }
}

/// A triangular patch by de Casteljau's algorithm.
dvec3 triangle_at(std::vector<dvec3> net, std::size_t degree, const dvec3& at) {
  for (; degree > 0; --degree) {
    std::vector<dvec3> inner;
    for (std::size_t j = 0; j < degree; ++j) {
      for (std::size_t i = 0; i + j < degree; ++i) {
        inner.push_back(at.x * net[triangle_point(degree, i, j)] +
                        at.y * net[triangle_point(degree, i + 1, j)] +
                        at.z * net[triangle_point(degree, i, j + 1)]);
      }
    }
    net = inner;
  }
  return net.front();
}

TEST(SubTriangle, IsTheSamePatch) {
  Random random(9);
  const std::array<dvec3, 3> corners = {dvec3(0.5, 0.5, 0), dvec3(0, 0.2, 0.8), dvec3(1, 0, 0)};
  for (const std::size_t degree : {1, 4, 6}) {
    std::vector<dvec3> net((degree + 1) * (degree + 2) / 2);
    for (dvec3& p : net) p = random_point(random);
    const std::vector<dvec3> part = sub_triangle(net, corners);
    const std::vector<dvec3> elevated = elevated_triangle(net);
    for (const dvec3& at : {dvec3(1, 0, 0), dvec3(0.2, 0.3, 0.5), dvec3(0, 0.6, 0.4)}) {
      const dvec3 there = at.x * corners[0] + at.y * corners[1] + at.z * corners[2];
      EXPECT_LE(glm::distance(triangle_at(part, degree, at), triangle_at(net, degree, there)),
                1e-14);
      EXPECT_LE(glm::distance(triangle_at(elevated, degree + 1, at), triangle_at(net, degree, at)),
                1e-14);
      EXPECT_LE(glm::distance(value_of_triangle(net, at), triangle_at(net, degree, at)), 1e-14);
    }
  }
}

// Two quads that share two edges, the vertex between them inner.
TEST(AddCage, RefusesADartOfTwoFaces) {
  ControlCage cage;
  cage.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}, {1, 1, -0.2}};
  cage.faces = {{0, 1, 2, 3}, {0, 3, 4, 1}};
  const auto add = [&](double sharpness, double other) {
    cage.creases = {{{0, 1}, sharpness}, {{0, 3}, other}};
    Part part;
    add_cage(part, cage, "c");
  };
  EXPECT_EQ(message_of<InvalidInput>([&] { add(infinite_sharpness, 2.5); }),
            "vertex 0 of the cage has two faces that share two edges, of which one is infinitely "
            "sharp: OpenSubdiv has no limit surface there");
  EXPECT_THROW(add(0, infinite_sharpness), InvalidInput);
  EXPECT_NO_THROW(add(0, 0));
  EXPECT_NO_THROW(add(2.5, 0));
  EXPECT_NO_THROW(add(infinite_sharpness, infinite_sharpness));
}

/// A vertex is in each of its faces where OpenSubdiv takes it to be, in each place once. It took
/// the first of them for all, and read on past the faces, where a face has a vertex more than once,
/// not in succession, and others between.
TEST(Extraction, KeepsThePlacesOfVertices) {
  Description faces;
  faces.sizes = {4, 5};
  faces.vertices = {0, 1, 2, 2, 1, 0, 2, 1, 3};
  faces.point_count = 4;
  OpenSubdiv::Sdc::Options options;
  options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  const auto whole = make_refiner(faces, CageScheme::catmark, options);
  const auto refiner =
      make_refiner(Extraction(whole->GetLevel(0), {0, 1}, 2), CageScheme::catmark, options);
  const OpenSubdiv::Far::TopologyLevel level = refiner->GetLevel(0);
  std::set<std::pair<int, int>> met;  // faces and places
  for (int v = 0; v < level.GetNumVertices(); ++v) {
    const auto around = level.GetVertexFaces(v);
    const auto places = level.GetVertexFaceLocalIndices(v);
    for (int k = 0; k < around.size(); ++k) {
      EXPECT_EQ(level.GetFaceVertices(around[k])[places[k]], v);
      EXPECT_TRUE(met.emplace(around[k], int(places[k])).second) << "vertex " << v;
    }
  }
  EXPECT_EQ(met.size(), faces.vertices.size());
}

TEST(PointHullDistance, OfSimplePolytopes) {
  PointHullDistance cube(cube_cage().points);
  EXPECT_LE(cube.bound({0.1, 0.2, -0.3}), 1e-14);
  EXPECT_NEAR(cube.bound({0.1, 0.2, 3}), 2, 1e-13);
  EXPECT_NEAR(cube.bound({2, 2, 0.5}), std::sqrt(2.0), 1e-13);
  EXPECT_NEAR(cube.bound({2, 2, 2}), std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(PointHullDistance({{1, 2, 2}}).bound({1, 2, 3}), 1, 1e-13);
  Random random(5);
  std::vector<dvec3> points;
  for (int i = 0; i < 40; ++i) points.push_back(random_direction(random));
  for (int i = 0; i < 200; ++i) {
    const dvec3 p = 1.5 * random_point(random);
    const double bound = PointHullDistance(points).bound(p);
    // Any supporting plane gives a lower bound.
    double lower = 0;
    for (int k = 0; k < 2000; ++k) {
      const dvec3 n = random_direction(random);
      double h = -2;
      for (const dvec3& q : points) h = std::max(h, glm::dot(q, n));
      lower = std::max(lower, glm::dot(p, n) - h);
    }
    EXPECT_GE(bound, lower - 1e-14);
    EXPECT_LE(bound, lower * 1.05 + 5e-2);
    for (const double enough : {0.01, 0.1, 1.0}) {
      const double perhaps = PointHullDistance(points).bound(p, enough);
      EXPECT_GE(perhaps, lower - 1e-14);
      EXPECT_LE(perhaps, std::max(bound, enough));
    }
  }
}

/// Far below the root of rounding, on slender triangles, large and small, that are not
/// axis-parallel.
TEST(PointHullDistance, OfNearPoints) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, -(i % 6));
    const dvec3 a = size * random_point(random);
    const dvec3 b = a + size * random_direction(random);
    const dvec3 off = 1e-6 * size * unit(glm::cross(b - a, random_direction(random)));
    const std::vector<dvec3> triangle = {a, b, 0.3 * a + 0.7 * b + off};
    const dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double height = 1e-11 * size;
    const dvec3 p = (triangle[0] + triangle[1] + triangle[2]) / 3.0 + height * unit(across);
    EXPECT_NEAR(PointHullDistance(triangle).bound(p), height, 1e-13 * size);
  }
}

/// The last distance's points are a start, and no more: the next one is the same as without.
TEST(PointHullDistance, OfPointsInTurn) {
  Random random(17);
  std::vector<dvec3> points;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 d = random_direction(random);
    points.push_back(d * dvec3(1, 2, 1e-4) + dvec3(3, 0, 0));
  }
  PointHullDistance hull(points);
  dvec3 p(0.0);
  for (int i = 0; i < 500; ++i) {
    // In small steps, far off at times, and a known point at times.
    p = i % 50 == 0   ? dvec3(3, 0, 0) + 10.0 * random_direction(random)
        : i % 50 < 25 ? p + 1e-3 * random_direction(random)
                      : dvec3(3, 0, 0) + random_direction(random) * dvec3(1, 2, 2e-4);
    if (i % 49 == 0) p = points[std::size_t(i)];
    EXPECT_NEAR(hull.bound(p), PointHullDistance(points).bound(p), 1e-11) << i;
  }
}

TEST(PointTree, SearchesAsAScanDoes) {
  Random random(3);
  for (const int count : {1, 8, 9, 100, 3000}) {
    std::vector<dvec3> points;
    for (int i = 0; i < count; ++i) points.push_back(random_point(random) * dvec3(1, 1e-3, 10));
    points.push_back(points.front());
    const PointTree tree(points);
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = 2.0 * random_point(random);
      double nearest = std::numeric_limits<double>::infinity();
      double lowest = nearest;
      for (const dvec3& q : points) {
        nearest = std::min(nearest, glm::distance(p, q));
        lowest = std::min(lowest, glm::dot(p, q));
      }
      EXPECT_NEAR(glm::distance(p, tree.nearest(p)), nearest, 1e-14);
      EXPECT_NEAR(glm::dot(p, tree.lowest(p)), lowest, 1e-14);
    }
  }
}

TEST(TouchTest, IsSure) {
  Random random(7);
  TouchTest test;
  EXPECT_TRUE(test.may_touch(std::vector<dvec3>{{0, 0, 0}}));
  std::vector<dvec3> points;
  for (int i = 0; i < 20000; ++i) points.push_back(random_direction(random));
  test.add(points);
  for (int i = 0; i < 200; ++i) {
    const dvec3 n = random_direction(random);
    EXPECT_TRUE(test.may_touch(std::vector<dvec3>{1.001 * n}));
    EXPECT_TRUE(test.may_touch(std::vector<dvec3>{points[std::size_t(i)]}));
    EXPECT_FALSE(test.may_touch(std::vector<dvec3>{0.98 * n, 0.97 * n}));
    EXPECT_TRUE(test.may_touch(std::vector<dvec3>{0.5 * n, 1.01 * n}));
  }
}

}  // namespace
}  // namespace taut
