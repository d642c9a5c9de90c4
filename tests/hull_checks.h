#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "models.h"
#include "reference.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/result/measures.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut_test {

/// The support function of a convex mesh by climbing over its edges; of (x - origin) . n.
class MeshSupport {
 public:
  MeshSupport(const taut::PolygonMesh& mesh, const dvec3& origin) : neighbors_(mesh.points.size()) {
    for (const dvec3& p : mesh.points) points_.push_back(p - origin);
    if (mesh.polygons.empty() && mesh.points.size() == 2) neighbors_ = {{1}, {0}};  // a segment
    for (const auto& polygon : mesh.polygons) {
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        neighbors_[std::size_t(polygon[k])].push_back(polygon[(k + 1) % polygon.size()]);
      }
    }
  }
  double operator()(const dvec3& n) {
    for (bool climbing = true; climbing;) {
      climbing = false;
      for (const int other : neighbors_[std::size_t(start_)]) {
        if (glm::dot(points_[std::size_t(other)], n) > glm::dot(points_[std::size_t(start_)], n)) {
          start_ = other;
          climbing = true;
          break;
        }
      }
    }
    return glm::dot(points_[std::size_t(start_)], n);
  }

 private:
  std::vector<dvec3> points_;
  std::vector<std::vector<int>> neighbors_;
  int start_ = 0;
};

struct GapRange {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  dvec3 worst = dvec3(0.0);
};

/// h_model - h_mesh over the mesh's facet normals and random directions, in model units.
inline GapRange gaps(const taut::Scene& scene, const taut::PolygonMesh& mesh, int directions) {
  std::vector<dvec3> tried;
  for (const auto& polygon : mesh.polygons) {
    // Differences in long double: normals of small facets far from the origin stay normals.
    const auto at = [&](std::size_t k) { return rvec3(mesh.points[std::size_t(polygon[k])]); };
    rvec3 normal{};
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
    }
    if (glm::length(normal) > 0) tried.emplace_back(glm::normalize(normal));
  }
  Random random(99);
  for (int k = 0; k < 6; ++k) {
    dvec3 axis(0.0);
    axis[k / 2] = k % 2 == 0 ? 1 : -1;
    tried.push_back(axis);
  }
  for (int k = 0; k < directions; ++k) tried.push_back(random_direction(random));
  taut::SupportQuery query(scene);
  MeshSupport support(mesh, scene.frame().center);
  taut::Contact near;
  GapRange range;
  for (const dvec3& n : tried) {
    const taut::Support s = query(n, near);
    near = s.contact;
    const double gap = scene.frame().length_to_model(s.h) - support(n);
    range.lowest = std::min(range.lowest, gap);
    if (gap > range.highest) {
      range.highest = gap;
      range.worst = n;
    }
  }
  return range;
}

/// The place that a mesh vertex names, evaluated on the model by de Casteljau.
inline rvec3 source_point(const Model& model, int id, double u, double v) {
  const taut::Source source = model.source(id);
  const taut::Instance& instance = model.instances()[std::size_t(source.instance)];
  const taut::Part& part = model.parts()[std::size_t(instance.part)];
  const auto index = std::size_t(source.index);
  rvec3 x(std::numeric_limits<real>::quiet_NaN());
  const auto local = [](const taut::Interval& i, double t) {
    return (real(t) - i.lower) / (real(i.upper) - i.lower);
  };
  const auto inside = [](const taut::Interval& i, double t) {
    return t >= i.lower && t <= i.upper;
  };
  if (source.kind == taut::SourceKind::vertex) {
    x = rvec3(part.vertices()[index]);
  } else if (source.kind == taut::SourceKind::edge) {
    const taut::Edge& edge = part.edges()[index];
    for (int k = 0; k < edge.piece_count; ++k) {
      const taut::EdgePiece& piece = part.pieces()[std::size_t(edge.first_piece + k)];
      if (inside(piece.t, u)) x = reference_point(piece.bezier, local(piece.t, u));
    }
  } else {
    const taut::Face& face = part.faces()[index];
    for (int k = 0; k < face.patch_count; ++k) {
      const taut::Patch& patch = part.patches()[std::size_t(face.first_patch + k)];
      if (inside(patch.u, u) && inside(patch.v, v)) {
        x = reference_point(patch.bezier, local(patch.u, u), local(patch.v, v));
      }
    }
  }
  return glm::mat<3, 3, real>(instance.pose.rotation) * x + rvec3(instance.pose.translation);
}

/// Of a strictly convex polytope.
inline void expect_strict_polytope(const MeshFacts& facts) {
  EXPECT_TRUE(facts.closed_manifold);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_TRUE(facts.planar);
  EXPECT_TRUE(facts.edges_convex);
  EXPECT_TRUE(facts.strictly);
  EXPECT_TRUE(facts.no_zero_area);
  EXPECT_TRUE(facts.all_points_used);
}

/// Closed forms of a hull; negative where unknown.
struct Known {
  double volume = -1;
  double area = -1;
  /// Farthest apart that borders lie which the model takes for one; sources are off by it.
  double joined = 0;
};

/// All that a solid hull with a certificate promises. `tolerance` is a share of the diagonal.
inline void expect_certified(const taut::Scene& scene, const taut::Hull& hull, double tolerance,
                             const Known& known, int directions = 1000) {
  EXPECT_EQ(hull.kind, taut::HullKind::solid);
  EXPECT_GT(hull.distance_bound, 0);
  EXPECT_LE(hull.distance_bound, tolerance * scene.diagonal());
  EXPECT_GT(hull.statistics.support_queries, 0);
  const taut::PolygonMesh mesh = taut::polygons(hull.mesh);
  const MeshFacts facts = mesh_facts(mesh);
  expect_strict_polytope(facts);
  if (!facts.is_convex_polytope()) return;

  double size = 0;
  for (const dvec3& p : mesh.points) {
    for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(p[i]));
  }
  const double rounding = 1e-15 * size + 1e-14 * scene.diagonal();
  const GapRange range = gaps(scene, mesh, directions);
  EXPECT_LE(range.highest, hull.distance_bound)
      << range.worst.x << ", " << range.worst.y << ", " << range.worst.z;
  // A query may miss the truth by support_slack of the scene's size.
  EXPECT_GE(range.lowest, -rounding - 1e-12 * scene.diagonal());
  // Rounding included: what the mesh reaches outside counts as well.
  EXPECT_GE(range.lowest, -hull.distance_bound);

  real off = 0;
  for (const auto v : hull.mesh.vertices()) {
    const auto& data = hull.mesh.data(v);
    EXPECT_GE(data.source, 0);
    if (data.source < 0) break;
    const rvec3 x = source_point(scene.model(), data.source, data.u, data.v);
    off = std::max(off, glm::length(x - rvec3(taut::position(hull.mesh, v))));
    EXPECT_FALSE(std::isnan(off));
    // A float: it rounds up to the smallest one, or to infinity, where it has to.
    constexpr double tiny = std::numeric_limits<float>::denorm_min();
    constexpr double huge = std::numeric_limits<float>::max();
    if (hull.distance_bound < huge) {
      EXPECT_LE(data.quality, std::max(1.001 * hull.distance_bound, tiny));
    }
  }
  EXPECT_LE(off, 4 * rounding + known.joined);

  const taut::Measures measured = taut::measure(mesh);
  const double d = hull.distance_bound;
  // Steiner: V(P + d B) = V + A d + M d^2 + 4 pi / 3 d^3, where M <= 2 pi diameter.
  const double slack = 1e-13 * std::pow(scene.diagonal(), 3) + rounding * measured.area;
  if (known.volume >= 0) {
    EXPECT_LE(measured.volume, known.volume + slack);
    EXPECT_GE(measured.volume, known.volume - measured.area * d - 6.3 * scene.diagonal() * d * d -
                                   4.2 * d * d * d - slack);
  }
  if (known.area >= 0) {
    EXPECT_LE(measured.area, known.area * (1 + 1e-12) + rounding * scene.diagonal());
    // A(P + d B) = A + 2 M d + 4 pi d^2.
    EXPECT_GE(measured.area, known.area - 12.6 * scene.diagonal() * d - 12.6 * d * d);
  }
}

/// The same of the sampled hull, which it returns.
inline taut::Hull expect_sampled(const taut::Scene& scene, double tolerance, const Known& known,
                                 const std::string& name, int directions = 1000) {
  SCOPED_TRACE(name + " at " + std::to_string(tolerance));
  taut::Hull hull;
  try {
    hull = taut::sampled_hull(
        scene, {.tolerance = tolerance * scene.diagonal(), .threads = 1, .progress = {}});
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
    return hull;
  }
  expect_certified(scene, hull, tolerance, known, directions);
  return hull;
}

}  // namespace taut_test
