#include "taut/subdivision/conforming.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <queue>
#include <unordered_map>
#include <utility>

#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/triangle_points.h"
#include "taut/surface/point_grid.h"
#include "taut/surface/side_joins.h"

namespace taut {
namespace {

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }
int to_int(std::size_t n) { return static_cast<int>(n); }

/// A side of a polygon: its ends and its middle.
struct PolygonSide {
  dvec3 from, to, middle;
};

/// Polygons with a number of sides each, that meet along sides or parts of them.
class SideGraph {
 public:
  /// Polygon i has the sides k i .. k i + k - 1.
  SideGraph(const std::vector<PolygonSide>& sides, int sides_per_polygon) : k_(sides_per_polygon) {
    Box box;
    for (const PolygonSide& side : sides) box.include(side.from);
    const double tolerance = join_tolerance(box);
    PointGrid grid(box, tolerance);
    int count = 0;
    const auto node = [&](const dvec3& p) {
      int found = -1;
      grid.visit_near(p, [&](int n) { found = found < 0 ? n : std::min(found, n); });
      if (found < 0) grid.insert(p, found = count++);
      return found;
    };
    edge_of_.reserve(sides.size());
    for (const PolygonSide& side : sides) {
      const int a = node(side.from);
      const int b = node(side.to);
      const auto [entry, is_new] = numbers_.try_emplace(key(a, b), to_int(edges_.size()));
      if (is_new) edges_.push_back({a, b, {}});
      edges_[to_size(entry->second)].sides.push_back(to_int(edge_of_.size()));
      edge_of_.push_back(entry->second);
    }
    split_.assign(edges_.size(), false);
    fixed_.assign(edges_.size(), false);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      int middle = -1;
      grid.visit_near(sides[to_size(edges_[e].sides.front())].middle, [&](int n) { middle = n; });
      if (middle < 0) continue;
      const auto first = numbers_.find(key(edges_[e].a, middle));
      const auto second = numbers_.find(key(middle, edges_[e].b));
      if (first == numbers_.end() || second == numbers_.end()) continue;
      split_[e] = true;
      for (const std::size_t fixed : {e, to_size(first->second), to_size(second->second)}) {
        fixed_[fixed] = true;
      }
    }
  }

  /// Calls visit(side, other side) for those that meet whole, in twos.
  template <class Visit>
  void visit_pairs(const Visit& visit) const {
    for (const EdgeNode& edge : edges_) {
      if (edge.sides.size() == 2) visit(edge.sides[0], edge.sides[1]);
    }
  }

  bool is_split(int side) const { return split_[to_size(edge_of_[to_size(side)])]; }

  /// Splits further sides so that all polygons have an even number of such.
  void make_even() {
    const int polygons = to_int(edge_of_.size()) / k_;
    for (int p = 0; p < polygons; ++p) {
      if (is_odd(p)) pass_on(p);
    }
  }

 private:
  struct EdgeNode {
    int a, b;
    std::vector<int> sides;
  };

  static std::uint64_t key(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

  bool is_odd(int polygon) const {
    int count = 0;
    for (int i = 0; i < k_; ++i) count += is_split(k_ * polygon + i) ? 1 : 0;
    return count % 2 != 0;
  }

  /// Changes all edges on a shortest way to another odd polygon, or out over a boundary.
  void pass_on(int first) {
    std::unordered_map<int, int> came_through;  // polygon -> edge
    std::queue<int> next;
    next.push(first);
    came_through.emplace(first, -1);
    while (!next.empty()) {
      const int p = next.front();
      next.pop();
      for (int i = 0; i < k_; ++i) {
        const int e = edge_of_[to_size(k_ * p + i)];
        const EdgeNode& edge = edges_[to_size(e)];
        if (fixed_[to_size(e)] || edge.sides.size() > 2) continue;
        if (edge.sides.size() == 1) {
          split_[to_size(e)] = !split_[to_size(e)];
          return change_back_to(first, p, came_through);
        }
        const int other = (edge.sides[0] / k_ == p ? edge.sides[1] : edge.sides[0]) / k_;
        if (!came_through.emplace(other, e).second) continue;
        if (is_odd(other)) return change_back_to(first, other, came_through);
        next.push(other);
      }
    }
  }

  void change_back_to(int first, int polygon, const std::unordered_map<int, int>& came_through) {
    while (polygon != first) {
      const int e = came_through.at(polygon);
      split_[to_size(e)] = !split_[to_size(e)];
      const EdgeNode& edge = edges_[to_size(e)];
      polygon = (edge.sides[0] / k_ == polygon ? edge.sides[1] : edge.sides[0]) / k_;
    }
  }

  int k_;
  std::unordered_map<std::uint64_t, int> numbers_;
  std::vector<EdgeNode> edges_;
  std::vector<int> edge_of_;  // per side
  std::vector<bool> split_;   // per edge
  std::vector<bool> fixed_;   // that are split by neighbours, and their halves
};

std::size_t index(Side side) { return static_cast<std::size_t>(side); }

SurfacePatch rectangle(const SurfacePatch& whole, Interval u, Interval v) {
  SurfacePatch part = whole;
  part.bezier = restricted(whole.bezier, u, v);
  if (u.lower > 0) part.smooth[index(Side::u0)] = true;
  if (u.upper < 1) part.smooth[index(Side::u1)] = true;
  if (v.lower > 0) part.smooth[index(Side::v0)] = true;
  if (v.upper < 1) part.smooth[index(Side::v1)] = true;
  return part;
}

SurfacePatch flipped_u(SurfacePatch patch) {
  patch.bezier = reversed_u(patch.bezier);
  std::swap(patch.smooth[index(Side::u0)], patch.smooth[index(Side::u1)]);
  return patch;
}

SurfacePatch flipped_v(SurfacePatch patch) {
  patch.bezier = reversed_v(patch.bezier);
  std::swap(patch.smooth[index(Side::v0)], patch.smooth[index(Side::v1)]);
  return patch;
}

/// Of a patch whose sides u = 0 and v = 1 are split: the rectangle between their middles, and the
/// two trapezoids between it and the other sides.
void split_corner(const SurfacePatch& whole, std::vector<SurfacePatch>& result) {
  constexpr Interval lower = {0, 0.5};
  constexpr Interval upper = {0.5, 1};
  result.push_back(rectangle(whole, lower, upper));
  const auto smooth = [&](Side side) { return whole.smooth[index(side)]; };
  SurfacePatch below = whole;
  below.bezier = tapered(restricted(whole.bezier, {0, 1}, lower), 1, 0.5);
  below.smooth = {smooth(Side::u0), true, smooth(Side::v0), true};
  result.push_back(std::move(below));
  SurfacePatch beside = whole;
  const BezierPatch turned = transposed(reversed_v(restricted(whole.bezier, upper, {0, 1})));
  beside.bezier = reversed_v(transposed(tapered(turned, 0.5, 1)));
  beside.smooth = {true, smooth(Side::u1), true, smooth(Side::v1)};
  result.push_back(std::move(beside));
}

void split_quad(const SurfacePatch& whole, const std::array<bool, 4>& split,
                std::vector<SurfacePatch>& result) {
  constexpr std::array<Interval, 2> halves = {Interval{0, 0.5}, Interval{0.5, 1}};
  const bool u0 = split[index(Side::u0)];
  const bool u1 = split[index(Side::u1)];
  const bool v0 = split[index(Side::v0)];
  const bool v1 = split[index(Side::v1)];
  const int count = int(u0) + int(u1) + int(v0) + int(v1);
  if (count % 2 != 0 || count == 0) {
    result.push_back(whole);
  } else if (count == 4) {
    for (const Interval& u : halves) {
      for (const Interval& v : halves) result.push_back(rectangle(whole, u, v));
    }
  } else if (u0 && u1) {
    for (const Interval& v : halves) result.push_back(rectangle(whole, {0, 1}, v));
  } else if (v0 && v1) {
    for (const Interval& u : halves) result.push_back(rectangle(whole, u, {0, 1}));
  } else {
    SurfacePatch turned = u1 ? flipped_u(whole) : whole;
    if (v0) turned = flipped_v(std::move(turned));
    const std::size_t first = result.size();
    split_corner(turned, result);
    // Sides of parts are parts of the same sides again.
    for (std::size_t i = first; i < result.size(); ++i) {
      if (v0) result[i] = flipped_v(std::move(result[i]));
      if (u1) result[i] = flipped_u(std::move(result[i]));
    }
  }
}

/// Of a quartic triangle: corners by barycentric coordinates.
struct SubTriangle {
  std::array<dvec3, 3> corners;
  std::array<bool, 3> smooth = {};
};

std::vector<SubTriangle> bisected(const std::array<bool, 3>& smooth,
                                  const std::array<bool, 3>& split) {
  const std::array<dvec3, 3> c = {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
  std::array<dvec3, 3> m;
  for (std::size_t k = 0; k < 3; ++k) m[k] = 0.5 * (c[k] + c[(k + 1) % 3]);
  const int count = int(split[0]) + int(split[1]) + int(split[2]);
  if (count == 0) return {{c, smooth}};
  if (count == 3) {
    return {{{c[0], m[0], m[2]}, {smooth[0], true, smooth[2]}},
            {{m[0], c[1], m[1]}, {smooth[0], smooth[1], true}},
            {{m[2], m[1], c[2]}, {true, smooth[1], smooth[2]}},
            {{m[0], m[1], m[2]}, {true, true, true}}};
  }
  // The first of the split sides, or of the two that follow each other.
  std::size_t k = 0;
  while (!split[k] || (count == 2 && !split[(k + 1) % 3])) ++k;
  const std::size_t l = (k + 1) % 3;
  const std::size_t n = (k + 2) % 3;
  if (count == 1) {
    return {{{c[k], m[k], c[n]}, {smooth[k], true, smooth[n]}},
            {{m[k], c[l], c[n]}, {smooth[k], smooth[l], true}}};
  }
  return {{{m[k], c[l], m[l]}, {smooth[k], smooth[l], true}},
          {{c[k], m[k], m[l]}, {smooth[k], true, true}},
          {{c[k], m[l], c[n]}, {true, smooth[l], smooth[n]}}};
}

void add_quads(const SurfaceTriangle& triangle, const SubTriangle& part,
               std::vector<SurfacePatch>& result) {
  const auto& c = part.corners;
  const dvec3 centre = (c[0] + c[1] + c[2]) / 3.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t before = (k + 2) % 3;
    const dvec3 to_next = 0.5 * (c[k] + c[(k + 1) % 3]);
    const dvec3 to_last = 0.5 * (c[k] + c[before]);
    SurfacePatch quad;
    quad.bezier = quad_of_triangle(triangle.points, {c[k], to_last, to_next, centre});
    quad.cage_face = triangle.cage_face;
    quad.exact = triangle.exact;
    quad.smooth = {part.smooth[before], true, part.smooth[k], true};
    result.push_back(std::move(quad));
  }
}

/// Gives a bicubic patch that is not exact the side of another, numbered 4 * patch + side.
void take_side(std::vector<SurfacePatch>& patches, int side, int from) {
  SurfacePatch& patch = patches[to_size(side / 4)];
  if (patch.exact) return;
  const BezierCurve other = border(patches[to_size(from / 4)].bezier, all_sides[to_size(from % 4)]);
  const Side own = all_sides[to_size(side % 4)];
  if (patch.bezier.degree_u != 3) return;  // its sides are those of its neighbours
  const bool along = along_v(own);
  const int fixed = at_upper_end(own) ? 3 : 0;
  const dvec3 start = dvec3(along ? patch.bezier.at(fixed, 0) : patch.bezier.at(0, fixed));
  const bool is_reversed = glm::distance(start, dvec3(other.points.back())) <
                           glm::distance(start, dvec3(other.points.front()));
  for (int i = 0; i < 4; ++i) {
    dvec4& p = along ? patch.bezier.at(fixed, i) : patch.bezier.at(i, fixed);
    p = other.points[to_size(is_reversed ? 3 - i : i)];
  }
}

/// The points of a triangle's sides.
std::array<std::vector<std::size_t>, 3> side_points(const SurfaceTriangle& triangle) {
  const std::size_t n = triangle_degree_of(triangle.points.size());
  std::array<std::vector<std::size_t>, 3> sides;
  for (std::size_t k = 0; k <= n; ++k) {
    sides[0].push_back(triangle_point(n, k, 0));
    sides[1].push_back(triangle_point(n, n - k, k));
    sides[2].push_back(triangle_point(n, 0, n - k));
  }
  return sides;
}

/// Gives a triangle that is not exact the side of another, numbered 3 * triangle + side.
void take_side(std::vector<SurfaceTriangle>& triangles, int side, int from) {
  SurfaceTriangle& triangle = triangles[to_size(side / 3)];
  if (triangle.exact) return;
  const std::vector<dvec3>& other = triangles[to_size(from / 3)].points;
  if (other.size() != triangle.points.size()) return;  // its sides are those of its neighbours
  const auto all_points = side_points(triangle);
  const auto& own_points = all_points[to_size(side % 3)];
  const auto& points = all_points[to_size(from % 3)];
  const dvec3 start = triangle.points[own_points.front()];
  const bool reversed =
      glm::distance(start, other[points.back()]) < glm::distance(start, other[points.front()]);
  const std::size_t n = points.size() - 1;
  for (std::size_t i = 0; i <= n; ++i) {
    triangle.points[own_points[i]] = other[points[reversed ? n - i : i]];
  }
}

}  // namespace

std::vector<SurfacePatch> conforming(std::vector<SurfacePatch> patches) {
  std::vector<PolygonSide> sides;
  sides.reserve(4 * patches.size());
  for (const SurfacePatch& patch : patches) {
    for (const Side side : all_sides) {
      const auto at = [&](double t) {
        const dvec2 uv = on_side(side, t);
        return point(patch.bezier, uv.x, uv.y);
      };
      sides.push_back({at(0), at(1), at(0.5)});
    }
  }
  SideGraph graph(sides, 4);
  graph.visit_pairs([&](int a, int b) {
    const bool other_way = !patches[to_size(a / 4)].exact && patches[to_size(b / 4)].exact;
    take_side(patches, other_way ? a : b, other_way ? b : a);
  });
  graph.make_even();
  std::vector<SurfacePatch> result;
  result.reserve(patches.size());
  for (int p = 0; p < to_int(patches.size()); ++p) {
    std::array<bool, 4> split = {};
    for (int i = 0; i < 4; ++i) split[to_size(i)] = graph.is_split(4 * p + i);
    split_quad(patches[to_size(p)], split, result);
  }
  return result;
}

std::vector<SurfacePatch> conforming(std::vector<SurfaceTriangle> triangles) {
  std::vector<PolygonSide> sides;
  sides.reserve(3 * triangles.size());
  for (const SurfaceTriangle& t : triangles) {
    for (const auto& s : side_points(t)) {
      BezierCurve side;
      for (const std::size_t i : s) side.points.push_back(homogeneous(t.points[i]));
      sides.push_back({t.points[s.front()], t.points[s.back()], point(side, 0.5)});
    }
  }
  const SideGraph graph(sides, 3);
  graph.visit_pairs([&](int a, int b) {
    const bool other_way = !triangles[to_size(a / 3)].exact && triangles[to_size(b / 3)].exact;
    take_side(triangles, other_way ? a : b, other_way ? b : a);
  });
  std::vector<SurfacePatch> result;
  result.reserve(3 * triangles.size());
  for (int t = 0; t < to_int(triangles.size()); ++t) {
    const SurfaceTriangle& triangle = triangles[to_size(t)];
    const std::array<bool, 3> split = {graph.is_split(3 * t), graph.is_split(3 * t + 1),
                                       graph.is_split(3 * t + 2)};
    for (const SubTriangle& part : bisected(triangle.smooth, split)) {
      add_quads(triangle, part, result);
    }
  }
  return result;
}

}  // namespace taut
