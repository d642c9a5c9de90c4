#include "taut/containment/placed_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "taut/containment/closed_surface.h"
#include "taut/core/disjoint_sets.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Segments along a side, at most; a finer grid than that is a matter for exact tests.
constexpr double most_segments = 256;

struct Placement {
  const RigidMotion& pose;
  const SceneFrame& frame;

  dvec3 operator()(const dvec3& x) const {
    return (pose.rotation * x + (pose.translation - frame.center)) * frame.scale;
  }
};

PlacedPatch placed(const BezierPatch& bezier, const Placement& place, int body) {
  PlacedPatch patch{bezier, {}, body};
  for (dvec4& p : patch.bezier.points) {
    const dvec3 x = place(euclidean(p));
    patch.box.include(x);
    p = homogeneous(x, p.w);
  }
  return patch;
}

/// Bounds of the second derivatives of the surface itself over the unit square, from those of the
/// homogeneous net about the middle: |x_uu| <= (|X_uu| + R |w_uu| + 2 |w_u| |x_u|) / w. For
/// polynomial patches weights are constant, and the bound is that of the net.
struct Bending {
  double uu, uv, vv;
};

/// Largest of first and second differences of a net.
struct Differences {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

template <class Value>
Differences differences(const BezierPatch& patch, Value value) {
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  Differences d;
  const auto at = [&](int i, int j) { return value(patch.at(i, j)); };
  const auto size = [](const auto& x) {
    if constexpr (std::is_same_v<std::decay_t<decltype(x)>, double>) {
      return std::abs(x);
    } else {
      return glm::length(x);
    }
  };
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j <= q; ++j) {
      if (i + 1 <= p) d.u = std::max(d.u, p * size(at(i + 1, j) - at(i, j)));
      if (j + 1 <= q) d.v = std::max(d.v, q * size(at(i, j + 1) - at(i, j)));
      if (i + 2 <= p) {
        d.uu = std::max(d.uu, p * (p - 1) * size(at(i + 2, j) - 2.0 * at(i + 1, j) + at(i, j)));
      }
      if (j + 2 <= q) {
        d.vv = std::max(d.vv, q * (q - 1) * size(at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j)));
      }
      if (i + 1 <= p && j + 1 <= q) {
        d.uv =
            std::max(d.uv, p * q * size(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
      }
    }
  }
  return d;
}

Bending bending(const PlacedPatch& patch) {
  const dvec3 middle = patch.box.center();
  double radius = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const dvec4& p : patch.bezier.points) {
    radius = std::max(radius, glm::distance(euclidean(p), middle));
    least = std::min(least, p.w);
  }
  // About the middle, w x_uu = X_uu - x w_uu - 2 w_u x_u and w x_u = X_u - x w_u.
  const Differences X =
      differences(patch.bezier, [&](const dvec4& p) { return dvec3(p) - p.w * middle; });
  const Differences w = differences(patch.bezier, [](const dvec4& p) { return p.w; });
  const double x_u = (X.u + radius * w.u) / least;
  const double x_v = (X.v + radius * w.v) / least;
  return {(X.uu + radius * w.uu + 2 * w.u * x_u) / least,
          (X.uv + radius * w.uv + w.u * x_v + w.v * x_u) / least,
          (X.vv + radius * w.vv + 2 * w.v * x_v) / least};
}

/// Linear interpolation over a right triangle with sides a and b is off by at most
/// (a^2 |uu| + 2 a b |uv| + b^2 |vv|) / 8 (Filip, Magedson, Markot 1986).
double deviation(const Bending& bend, double segments_u, double segments_v) {
  const double a = 1 / segments_u;
  const double b = 1 / segments_v;
  return (a * a * bend.uu + 2 * a * b * bend.uv + b * b * bend.vv) / 8;
}

/// The grids of a part's patches, so that joined sides are split alike.
class Grids {
 public:
  /// A patch's segments along u have number 2 k, those along v 2 k + 1.
  explicit Grids(const Part& part) : sets_(2 * part.patches().size()) {
    for (std::size_t k = 0; k < part.patches().size(); ++k) {
      for (const Side side : all_sides) {
        const Border& border = part.patches()[k].borders[std::size_t(side)];
        if (border.neighbor < 0) continue;
        const int own = int(2 * k) + (along_v(side) ? 1 : 0);
        sets_.unite(own, 2 * border.neighbor + (along_v(border.neighbor_side) ? 1 : 0));
      }
    }
    needed_.assign(2 * part.patches().size(), 1);
  }

  void ask(int segments, double count) {
    double& most = needed_[std::size_t(sets_.find(segments))];
    most = std::max(most, std::min(std::ceil(count), most_segments));
  }
  int count(int segments) { return int(needed_[std::size_t(sets_.find(segments))]); }

 private:
  DisjointSets sets_;
  std::vector<double> needed_;
};

}  // namespace

PlacedSurface placed_surface(const Scene& scene) {
  PlacedSurface surface;
  const Model& model = scene.model();
  const SceneFrame& frame = scene.frame();
  double reach = 0;
  for (const Instance& instance : model.instances()) {
    const Part& part = model.parts()[std::size_t(instance.part)];
    const Placement place{instance.pose, frame};
    for (const Patch& patch : part.patches()) {
      if (patch.repeats < 0) {
        surface.patches.push_back(placed(patch.bezier, place, surface.bodies));
      }
    }
    for (const std::vector<int>& polygon : part.polygons()) {
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const auto corner = [&](std::size_t i) {
          return place(part.vertices()[std::size_t(polygon[i])]);
        };
        surface.triangles.push_back({{corner(0), corner(k), corner(k + 1)}, surface.bodies});
      }
    }
    surface.crack = std::max(surface.crack, frame.length_to_frame(largest_crack(part)));
    const Box& box = part.control_box();
    const dvec3 largest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    reach = std::max(reach, largest.x + largest.y + largest.z +
                                glm::length(instance.pose.translation - frame.center));
    ++surface.bodies;
  }
  surface.rounding = rounding_unit * (32 + 8 * frame.length_to_frame(reach));
  std::vector<Box> boxes;
  for (const PlacedPatch& patch : surface.patches) boxes.push_back(patch.box);
  surface.patch_tree = BoxTree(boxes);
  boxes.clear();
  for (const PlacedTriangle& triangle : surface.triangles) {
    boxes.emplace_back();
    for (const dvec3& corner : triangle.corner) boxes.back().include(corner);
  }
  surface.triangle_tree = BoxTree(boxes);
  return surface;
}

double halving_rounding(const BezierPatch& patch, double size_u, double size_v) {
  const double averages = -patch.degree_u * std::log2(size_u) - patch.degree_v * std::log2(size_v);
  return 2 * rounding_unit * averages;
}

Tessellation tessellation(const Scene& scene, const PlacedSurface& surface, double tolerance,
                          std::size_t most_triangles) {
  Tessellation mesh;
  const Model& model = scene.model();
  // A coarser tolerance until the triangles are few enough.
  for (;; tolerance *= 4) {
    mesh = {};
    std::size_t placed = 0;
    std::size_t count = surface.triangles.size();
    std::vector<std::array<int, 2>> grid;
    for (const Instance& instance : model.instances()) {
      const Part& part = model.parts()[std::size_t(instance.part)];
      Grids grids(part);
      const std::size_t first = placed;
      for (std::size_t k = 0; k < part.patches().size(); ++k) {
        if (part.patches()[k].repeats >= 0) continue;
        const Bending bend = bending(surface.patches[placed++]);
        const double third = 8 * tolerance / 4;
        const double mixed = std::sqrt(bend.uv / third);
        grids.ask(int(2 * k), std::max(std::sqrt(bend.uu / third), mixed));
        grids.ask(int(2 * k + 1), std::max(std::sqrt(bend.vv / third), mixed));
      }
      placed = first;
      for (std::size_t k = 0; k < part.patches().size(); ++k) {
        if (part.patches()[k].repeats >= 0) continue;
        grid.push_back({grids.count(int(2 * k)), grids.count(int(2 * k + 1))});
        count += 2 * std::size_t(grid.back()[0]) * std::size_t(grid.back()[1]);
        ++placed;
      }
    }
    const bool coarsest =
        std::all_of(grid.begin(), grid.end(), [](const auto& g) { return g[0] == 1 && g[1] == 1; });
    if (count > most_triangles && !coarsest) continue;
    for (std::size_t k = 0; k < surface.patches.size(); ++k) {
      const PlacedPatch& patch = surface.patches[k];
      const auto [m, n] = grid[k];
      mesh.deviation = std::max(mesh.deviation, deviation(bending(patch), m, n));
      const int first = int(mesh.points.size());
      for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
          mesh.points.push_back(point(patch.bezier, double(i) / m, double(j) / n));
        }
      }
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
          const int a = first + i * (n + 1) + j;
          const int b = a + n + 1;
          mesh.triangles.push_back({a, b, b + 1});
          mesh.triangles.push_back({a, b + 1, a + 1});
          mesh.body.insert(mesh.body.end(), 2, patch.body);
        }
      }
    }
    for (const PlacedTriangle& t : surface.triangles) {
      const int first = int(mesh.points.size());
      mesh.points.insert(mesh.points.end(), t.corner.begin(), t.corner.end());
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.body.push_back(t.body);
    }
    return mesh;
  }
}

}  // namespace taut
