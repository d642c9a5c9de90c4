#include "taut/subdivision/conforming.h"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <unordered_map>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/triangle_points.h"

namespace taut {
namespace {

/// Rounds of division: more than there are levels of refinement.
constexpr int round_limit = 128;

/// A side of a polygon: the vertices from which and to which it runs.
using VertexSide = std::array<int, 2>;

/// Sides of polygons that meet along whole sides, or parts of others.
class SideGraph {
 public:
  /// Polygon i has the sides k i .. k i + k - 1. Those of which both vertices are -1 take no part.
  SideGraph(const std::vector<VertexSide>& sides, int sides_per_polygon, EdgeMiddles& middles)
      : k_(sides_per_polygon), middles_(middles) {
    edge_of_.reserve(sides.size());
    for (int side = 0; side < to_int(sides.size()); ++side) {
      const auto [a, b] = sides[to_size(side)];
      edge_of_.push_back(-1);
      if (a < 0) continue;
      const auto [entry, is_new] =
          numbers_.try_emplace(EdgeMiddles::key(a, b), to_int(edges_.size()));
      if (is_new) edges_.push_back({a, b, {}});
      edges_[to_size(entry->second)].sides.push_back(side);
      edge_of_.back() = entry->second;
    }
    fixed_.assign(edges_.size(), false);
    split_.reserve(edges_.size());
    for (const EdgeNode& edge : edges_) {
      split_.push_back(middles_.find(edge.a, edge.b) >= 0);
      if (split_.back()) fix(edge.a, edge.b);
    }
  }

  /// Calls visit(sides) for those of each edge that meet whole.
  template <class Visit>
  void visit_joined(const Visit& visit) const {
    for (const EdgeNode& edge : edges_) visit(edge.sides);
  }

  bool is_split(int side) const {
    const int e = edge_of_[to_size(side)];
    return e >= 0 && split_[to_size(e)];
  }

  /// Splits further sides, where it can, so that all polygons have an even number of such.
  void make_even() {
    const int polygons = to_int(edge_of_.size()) / k_;
    for (int p = 0; p < polygons; ++p) {
      if (is_odd(p)) pass_on(p);
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (split_[e]) middles_.add(edges_[e].a, edges_[e].b);
    }
  }

 private:
  struct EdgeNode {
    int a, b;
    std::vector<int> sides;
  };

  /// An edge that is split, and what others have along it.
  void fix(int a, int b) {
    const auto edge = numbers_.find(EdgeMiddles::key(a, b));
    if (edge != numbers_.end()) fixed_[to_size(edge->second)] = true;
    const int middle = middles_.find(a, b);
    if (middle < 0) return;
    fix(a, middle);
    fix(middle, b);
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
        if (e < 0) continue;
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
  EdgeMiddles& middles_;
  std::unordered_map<std::uint64_t, int> numbers_;
  std::vector<EdgeNode> edges_;
  std::vector<int> edge_of_;  // per side, or -1
  std::vector<bool> split_;   // per edge
  std::vector<bool> fixed_;   // that are split by neighbours, and what these have there
};

std::size_t index(Side side) { return static_cast<std::size_t>(side); }

/// The vertices of a patch at the parameters 0, 1/2 and 1, by u and v; -1 where it has none.
using VertexGrid = std::array<std::array<int, 3>, 3>;

SurfacePatch rectangle(const SurfacePatch& whole, const VertexGrid& grid, Interval u, Interval v) {
  SurfacePatch part = whole;
  part.bezier = restricted(whole.bezier, u, v);
  if (u.lower > 0) part.smooth[index(Side::u0)] = true;
  if (u.upper < 1) part.smooth[index(Side::u1)] = true;
  if (v.lower > 0) part.smooth[index(Side::v0)] = true;
  if (v.upper < 1) part.smooth[index(Side::v1)] = true;
  const auto at = [&](double s, double t) {
    return grid[static_cast<std::size_t>(2 * s)][static_cast<std::size_t>(2 * t)];
  };
  part.vertices = {at(u.lower, v.lower), at(u.lower, v.upper), at(u.upper, v.lower),
                   at(u.upper, v.upper)};
  return part;
}

SurfacePatch flipped_u(SurfacePatch patch) {
  patch.bezier = reversed_u(patch.bezier);
  std::swap(patch.smooth[index(Side::u0)], patch.smooth[index(Side::u1)]);
  std::swap(patch.vertices[0], patch.vertices[2]);
  std::swap(patch.vertices[1], patch.vertices[3]);
  return patch;
}

SurfacePatch flipped_v(SurfacePatch patch) {
  patch.bezier = reversed_v(patch.bezier);
  std::swap(patch.smooth[index(Side::v0)], patch.smooth[index(Side::v1)]);
  std::swap(patch.vertices[0], patch.vertices[1]);
  std::swap(patch.vertices[2], patch.vertices[3]);
  return patch;
}

/// Of a patch whose sides u = 0 and v = 1 are split: the rectangle between their middles, and the
/// two trapezoids between it and the other sides.
void split_corner(const SurfacePatch& whole, const VertexGrid& grid,
                  std::vector<SurfacePatch>& result) {
  constexpr Interval lower = {0, 0.5};
  constexpr Interval upper = {0.5, 1};
  result.push_back(rectangle(whole, grid, lower, upper));
  const auto smooth = [&](Side side) { return whole.smooth[index(side)]; };
  SurfacePatch below = whole;
  below.bezier = tapered(restricted(whole.bezier, {0, 1}, lower), 1, 0.5);
  below.smooth = {smooth(Side::u0), true, smooth(Side::v0), true};
  below.vertices = {grid[0][0], grid[0][1], grid[2][0], grid[1][1]};
  result.push_back(std::move(below));
  SurfacePatch beside = whole;
  const BezierPatch turned = transposed(reversed_v(restricted(whole.bezier, upper, {0, 1})));
  beside.bezier = reversed_v(transposed(tapered(turned, 0.5, 1)));
  beside.smooth = {true, smooth(Side::u1), true, smooth(Side::v1)};
  beside.vertices = {grid[1][1], grid[1][2], grid[2][0], grid[2][2]};
  result.push_back(std::move(beside));
}

/// The corners of a side, by their places among the vertices.
std::array<std::size_t, 2> side_corners(Side side) {
  const bool upper = at_upper_end(side);
  if (along_v(side))
    return upper ? std::array<std::size_t, 2>{2, 3} : std::array<std::size_t, 2>{0, 1};
  return upper ? std::array<std::size_t, 2>{1, 3} : std::array<std::size_t, 2>{0, 2};
}

void divide(const SurfacePatch& whole, const std::array<bool, 4>& split, EdgeMiddles& middles,
            std::vector<SurfacePatch>& result) {
  constexpr std::array<Interval, 2> halves = {Interval{0, 0.5}, Interval{0.5, 1}};
  const bool u0 = split[index(Side::u0)];
  const bool u1 = split[index(Side::u1)];
  const bool v0 = split[index(Side::v0)];
  const bool v1 = split[index(Side::v1)];
  const int count = int(u0) + int(u1) + int(v0) + int(v1);
  const bool tapers = count == 2 && u0 != u1;
  const int tapered_degree = whole.bezier.degree_u + whole.bezier.degree_v;
  if (count % 2 != 0 || count == 0 || (tapers && tapered_degree > max_degree)) {
    result.push_back(whole);
    return;
  }
  const auto middle = [&](Side side) {
    const auto [a, b] = side_corners(side);
    return middles.find(whole.vertices[a], whole.vertices[b]);
  };
  const int centre = count == 2 && !tapers ? -1 : middles.add_vertex();
  const auto& v = whole.vertices;
  VertexGrid grid = {{{v[0], middle(Side::u0), v[1]},
                      {middle(Side::v0), centre, middle(Side::v1)},
                      {v[2], middle(Side::u1), v[3]}}};
  if (count == 4) {
    for (const Interval& u : halves) {
      for (const Interval& t : halves) result.push_back(rectangle(whole, grid, u, t));
    }
  } else if (u0 && u1) {
    for (const Interval& t : halves) result.push_back(rectangle(whole, grid, {0, 1}, t));
  } else if (v0 && v1) {
    for (const Interval& u : halves) result.push_back(rectangle(whole, grid, u, {0, 1}));
  } else {
    SurfacePatch turned = u1 ? flipped_u(whole) : whole;
    if (u1) std::swap(grid[0], grid[2]);
    if (v0) {
      turned = flipped_v(std::move(turned));
      for (auto& row : grid) std::swap(row[0], row[2]);
    }
    const std::size_t first = result.size();
    split_corner(turned, grid, result);
    // Sides of parts are parts of the same sides again.
    for (std::size_t i = first; i < result.size(); ++i) {
      if (v0) result[i] = flipped_v(std::move(result[i]));
      if (u1) result[i] = flipped_u(std::move(result[i]));
    }
  }
}

/// Of a triangle: corners by barycentric coordinates.
struct SubTriangle {
  std::array<dvec3, 3> corners;
  std::array<int, 3> vertices;
  std::array<bool, 3> smooth = {};
};

std::vector<SubTriangle> bisected(const SurfaceTriangle& whole, const std::array<bool, 4>& split,
                                  const EdgeMiddles& middles) {
  const std::array<dvec3, 3> c = {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
  const std::array<int, 3>& v = whole.vertices;
  const std::array<bool, 3>& smooth = whole.smooth;
  std::array<dvec3, 3> m;
  std::array<int, 3> w;
  for (std::size_t k = 0; k < 3; ++k) {
    m[k] = 0.5 * (c[k] + c[(k + 1) % 3]);
    w[k] = middles.find(v[k], v[(k + 1) % 3]);
  }
  const int count = int(split[0]) + int(split[1]) + int(split[2]);
  if (count == 0) return {{c, v, smooth}};
  if (count == 3) {
    return {{{c[0], m[0], m[2]}, {v[0], w[0], w[2]}, {smooth[0], true, smooth[2]}},
            {{m[0], c[1], m[1]}, {w[0], v[1], w[1]}, {smooth[0], smooth[1], true}},
            {{m[2], m[1], c[2]}, {w[2], w[1], v[2]}, {true, smooth[1], smooth[2]}},
            {{m[0], m[1], m[2]}, {w[0], w[1], w[2]}, {true, true, true}}};
  }
  // The first of the split sides, or of the two that follow each other.
  std::size_t k = 0;
  while (!split[k] || (count == 2 && !split[(k + 1) % 3])) ++k;
  const std::size_t l = (k + 1) % 3;
  const std::size_t n = (k + 2) % 3;
  if (count == 1) {
    return {{{c[k], m[k], c[n]}, {v[k], w[k], v[n]}, {smooth[k], true, smooth[n]}},
            {{m[k], c[l], c[n]}, {w[k], v[l], v[n]}, {smooth[k], smooth[l], true}}};
  }
  return {{{m[k], c[l], m[l]}, {w[k], v[l], w[l]}, {smooth[k], smooth[l], true}},
          {{c[k], m[k], m[l]}, {v[k], w[k], w[l]}, {smooth[k], true, true}},
          {{c[k], m[l], c[n]}, {v[k], w[l], v[n]}, {true, smooth[l], smooth[n]}}};
}

void divide(const SurfaceTriangle& whole, const std::array<bool, 4>& split, EdgeMiddles& middles,
            std::vector<SurfaceTriangle>& result) {
  const std::vector<SubTriangle> parts = bisected(whole, split, middles);
  if (parts.size() == 1) {
    result.push_back(whole);
    return;
  }
  for (const SubTriangle& part : parts) {
    SurfaceTriangle piece = whole;
    if (whole.exact) {
      if (whole.whole.empty()) piece.whole = whole.points;
      for (std::size_t k = 0; k < 3; ++k) {
        const dvec3& at = part.corners[k];
        piece.corners[k] =
            at.x * whole.corners[0] + at.y * whole.corners[1] + at.z * whole.corners[2];
      }
      piece.points = sub_triangle(piece.whole, piece.corners);
    } else {
      piece.points = sub_triangle(whole.points, part.corners);
    }
    piece.vertices = part.vertices;
    piece.smooth = part.smooth;
    result.push_back(std::move(piece));
  }
}

void add_quads(const SurfaceTriangle& triangle, EdgeMiddles& middles,
               std::vector<SurfacePatch>& result) {
  const std::array<dvec3, 3>& c = triangle.corners;
  const dvec3 centre = (c[0] + c[1] + c[2]) / 3.0;
  const std::vector<dvec3>& points = triangle.whole.empty() ? triangle.points : triangle.whole;
  const std::array<int, 3>& v = triangle.vertices;
  const int inner = middles.add_vertex();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t before = (k + 2) % 3;
    const dvec3 to_next = 0.5 * (c[k] + c[(k + 1) % 3]);
    const dvec3 to_last = 0.5 * (c[k] + c[before]);
    SurfacePatch quad;
    quad.bezier = quad_of_triangle(points, {c[k], to_last, to_next, centre});
    quad.cage_face = triangle.cage_face;
    quad.vertices = {v[k], middles.add(v[k], v[before]), middles.add(v[k], v[(k + 1) % 3]), inner};
    quad.exact = triangle.exact;
    quad.smooth = {triangle.smooth[before], true, triangle.smooth[k], true};
    result.push_back(std::move(quad));
  }
}

/// @name Sides of polygons, and the vertices from which and to which they run
/// @{
VertexSide side_vertices(const SurfacePatch& patch, int side) {
  const auto [a, b] = side_corners(all_sides[to_size(side)]);
  return {patch.vertices[a], patch.vertices[b]};
}
VertexSide side_vertices(const SurfaceTriangle& triangle, int side) {
  return {triangle.vertices[to_size(side)], triangle.vertices[to_size((side + 1) % 3)]};
}

BezierCurve side_curve(const SurfacePatch& patch, int side) {
  return border(patch.bezier, all_sides[to_size(side)]);
}

/// Where a triangle of a degree has the points of a side.
std::vector<std::size_t> side_points(std::size_t n, int side) {
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k <= n; ++k) {
    points.push_back(side == 0   ? triangle_point(n, k, 0)
                     : side == 1 ? triangle_point(n, n - k, k)
                                 : triangle_point(n, 0, n - k));
  }
  return points;
}

BezierCurve side_curve(const SurfaceTriangle& triangle, int side) {
  BezierCurve curve;
  for (const std::size_t i : side_points(triangle_degree_of(triangle.points.size()), side)) {
    curve.points.push_back(homogeneous(triangle.points[i]));
  }
  return curve;
}

void set_side(SurfacePatch& patch, int number, BezierCurve curve) {
  BezierPatch& bezier = patch.bezier;
  const Side side = all_sides[to_size(number)];
  const bool along = along_v(side);
  const int degree = std::max(along ? bezier.degree_v : bezier.degree_u, curve.degree());
  if (curve.degree() < degree) curve = elevated(curve, degree);
  bezier = elevated(bezier, along ? bezier.degree_u : degree, along ? degree : bezier.degree_v);
  const int fixed = !at_upper_end(side) ? 0 : along ? bezier.degree_u : bezier.degree_v;
  for (int i = 0; i <= degree; ++i) {
    (along ? bezier.at(fixed, i) : bezier.at(i, fixed)) = curve.points[to_size(i)];
  }
}

void set_side(SurfaceTriangle& triangle, int side, BezierCurve curve) {
  const auto degree = [&] { return to_int(triangle_degree_of(triangle.points.size())); };
  while (degree() < curve.degree()) triangle.points = elevated_triangle(triangle.points);
  if (curve.degree() < degree()) curve = elevated(curve, degree());
  const std::vector<std::size_t> points = side_points(to_size(degree()), side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    triangle.points[points[i]] = dvec3(curve.points[i]);
  }
}

/// @}

/// Polygons of which the vertices are known. The places of these are told by exact ones, or else by
/// those that may touch the hull.
template <class Polygon>
class Division {
 public:
  Division(std::vector<Polygon> polygons, EdgeMiddles& middles, const Progress& progress)
      : polygons_(std::move(polygons)), middles_(middles), progress_(progress) {}

  /// Divides polygons until whole sides meet.
  std::vector<Polygon> run() {
    for (int round = 0; round < round_limit; ++round) {
      const std::size_t count = polygons_.size();
      run_round();
      if (polygons_.size() == count) break;
    }
    return std::move(polygons_);
  }

 private:
  static constexpr int k = std::tuple_size_v<decltype(Polygon::vertices)>;

  static int rank(const Polygon& polygon) { return polygon.exact ? 0 : polygon.may_touch ? 1 : 2; }
  const Polygon& polygon_of(int side) const { return polygons_[to_size(side / k)]; }

  void run_round() {
    place_vertices();
    SideGraph graph(sides(), k, middles_);
    graph.visit_joined([&](const std::vector<int>& sides) { join(sides); });
    if (k == 4) graph.make_even();
    std::vector<Polygon> next;
    next.reserve(polygons_.size());
    for (int p = 0; p < to_int(polygons_.size()); ++p) {
      progress_.check();
      const Polygon& whole = polygons_[to_size(p)];
      std::array<bool, 4> split = {};
      for (int i = 0; i < k; ++i) split[to_size(i)] = graph.is_split(k * p + i);
      const std::size_t first = next.size();
      divide(whole, split, middles_, next);
      if (whole.exact || next.size() == first + 1) continue;
      for (int i = 0; i < k; ++i) {
        if (split[to_size(i)]) move_halves(side_vertices(whole, i), next, first);
      }
    }
    polygons_ = std::move(next);
  }

  /// Those of polygons with a vertex twice take no part, nor those that their ends do not tell
  /// apart.
  std::vector<VertexSide> sides() const {
    std::vector<VertexSide> result;
    result.reserve(to_size(k) * polygons_.size());
    for (const Polygon& polygon : polygons_) {
      auto vertices = polygon.vertices;
      std::sort(vertices.begin(), vertices.end());
      const bool regular = std::adjacent_find(vertices.begin(), vertices.end()) == vertices.end();
      for (int i = 0; i < k; ++i) {
        const VertexSide side = side_vertices(polygon, i);
        const bool known = regular && !middles_.are_several(side[0], side[1]);
        result.push_back(known ? side : VertexSide{-1, -1});
      }
    }
    return result;
  }

  void place_vertices() {
    places_.assign(to_size(middles_.vertex_count()), {});
    for (const Polygon& polygon : polygons_) {
      progress_.check();
      for (int i = 0; i < k; ++i) {
        const BezierCurve curve = side_curve(polygon, i);
        const VertexSide v = side_vertices(polygon, i);
        for (const std::size_t end : {0, 1}) {
          Place& place = places_[to_size(v[end])];
          if (rank(polygon) >= place.rank) continue;
          place = {rank(polygon), end == 0 ? curve.points.front() : curve.points.back()};
        }
      }
    }
    for (Polygon& polygon : polygons_) {
      if (rank(polygon) < 2) continue;
      for (int i = 0; i < k; ++i) {
        BezierCurve curve = side_curve(polygon, i);
        const auto [a, b] = side_vertices(polygon, i);
        curve.points.front() = places_[to_size(a)].point;
        curve.points.back() = places_[to_size(b)].point;
        set_side(polygon, i, std::move(curve));
      }
    }
  }

  /// Polygons that are not exact take over the side of another.
  void join(const std::vector<int>& sides) {
    const int from = *std::min_element(sides.begin(), sides.end(), [&](int a, int b) {
      return rank(polygon_of(a)) < rank(polygon_of(b));
    });
    for (const int side : sides) {
      Polygon& polygon = polygons_[to_size(side / k)];
      if (side == from || polygon.exact) continue;
      BezierCurve curve = side_curve(polygon_of(from), from % k);
      if (polygon.may_touch && curve.degree() != side_curve(polygon, side % k).degree()) continue;
      const bool is_reversed =
          side_vertices(polygon_of(from), from % k) != side_vertices(polygon, side % k);
      set_side(polygon, side % k, is_reversed ? reversed(curve) : std::move(curve));
    }
  }

  /// The halves of a side that is split at a corner of others end there: straight until whole sides
  /// meet.
  void move_halves(const VertexSide& whole, std::vector<Polygon>& parts, std::size_t first) const {
    const int middle = middles_.find(whole[0], whole[1]);
    if (middle >= to_int(places_.size()) || places_[to_size(middle)].rank == unknown) return;
    for (std::size_t p = first; p < parts.size(); ++p) {
      for (int i = 0; i < k; ++i) {
        const VertexSide half = side_vertices(parts[p], i);
        for (const int end : whole) {
          if (half != VertexSide{end, middle} && half != VertexSide{middle, end}) continue;
          set_side(parts[p], i,
                   {{places_[to_size(half[0])].point, places_[to_size(half[1])].point}});
        }
      }
    }
  }

  static constexpr int unknown = 3;
  struct Place {
    int rank = unknown;
    dvec4 point = dvec4(0.0);
  };

  std::vector<Polygon> polygons_;
  EdgeMiddles& middles_;
  const Progress& progress_;
  std::vector<Place> places_;  // per vertex
};

}  // namespace

std::vector<SurfacePatch> conforming(std::vector<SurfacePatch> patches, EdgeMiddles middles,
                                     const Progress& progress) {
  return Division<SurfacePatch>(std::move(patches), middles, progress).run();
}

std::vector<SurfacePatch> conforming(std::vector<SurfaceTriangle> triangles, EdgeMiddles middles,
                                     const Progress& progress) {
  std::vector<SurfacePatch> result;
  for (const SurfaceTriangle& triangle :
       Division<SurfaceTriangle>(std::move(triangles), middles, progress).run()) {
    progress.check();
    add_quads(triangle, middles, result);
  }
  return result;
}

}  // namespace taut
