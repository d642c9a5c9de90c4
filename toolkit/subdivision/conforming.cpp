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

/// Of a side's length: halves are known by their ends up to rounding.
constexpr double half_side_tolerance = 1e-9;

/// Rounds in which sides are divided: as many as levels that meet, at most.
constexpr int round_limit = 64;

/// Sides of polygons that meet along whole sides, or of which some meet the parts of others.
///
/// Polygons have ranks: 0 for those that are exact. Where an exact side meets parts of others, its
/// middle is a corner of theirs, and so are those of the halves that meet parts. What other sides
/// meet may be elsewhere: it is found by going along unjoined sides from the one end to the other.
class SideGraph {
 public:
  /// Polygon i has the sides k i .. k i + k - 1. Sides of no length take no part.
  SideGraph(std::vector<BezierCurve> curves, std::vector<int> ranks, int sides_per_polygon)
      : k_(sides_per_polygon),
        curves_(std::move(curves)),
        ranks_(std::move(ranks)),
        box_(box_of(curves_)),
        grid_(box_, join_tolerance(box_)) {
    edge_of_.reserve(curves_.size());
    starts_.reserve(curves_.size());
    for (int side = 0; side < to_int(curves_.size()); ++side) add_side(side);
    split_.assign(edges_.size(), false);
    fixed_.assign(edges_.size(), false);
  }

  /// Calls visit(side, other side, reversed) for sides that meet whole, one of each edge with all
  /// others: one of the least rank.
  template <class Visit>
  void visit_joined(const Visit& visit) const {
    for (const EdgeNode& edge : edges_) {
      const int first = leading_side(edge);
      for (const int other : edge.sides) {
        if (other != first) visit(first, other, starts_[to_size(first)] != starts_[to_size(other)]);
      }
    }
  }

  /// Marks the sides that meet parts of others to be split.
  void find_splits() {
    for (int e = 0; e < to_int(edges_.size()); ++e) {
      const EdgeNode& edge = edges_[to_size(e)];
      passed_.clear();
      if (ranks_[to_size(leading_side(edge) / k_)] == 0) {
        split_at_middle(e);
      } else if (edge.sides.size() == 1) {
        split_along_others(e);
      }
    }
  }

  bool is_split(int side) const {
    const int e = edge_of_[to_size(side)];
    return e >= 0 && split_[to_size(e)];
  }

  /// The corner of others, if there is one, at which a side is split.
  const dvec3* corner_within(int side) const {
    const int e = edge_of_[to_size(side)];
    const int n = e < 0 ? -1 : edges_[to_size(e)].middle;
    return n < 0 ? nullptr : &positions_[to_size(n)];
  }

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
    int middle = -1;  ///< the node at which it is split
  };

  static Box box_of(const std::vector<BezierCurve>& curves) {
    Box box;
    for (const BezierCurve& curve : curves) box.include(euclidean(curve.points.front()));
    return box;
  }

  static std::uint64_t key(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

  int find_node(const dvec3& p) const {
    int found = -1;
    grid_.visit_near(p, [&](int n) { found = found < 0 ? n : std::min(found, n); });
    return found;
  }

  int node(const dvec3& p) {
    int n = find_node(p);
    if (n < 0) {
      n = to_int(positions_.size());
      grid_.insert(p, n);
      positions_.push_back(p);
      edges_at_.emplace_back();
    }
    return n;
  }

  void add_side(int side) {
    const BezierCurve& curve = curves_[to_size(side)];
    const int a = node(euclidean(curve.points.front()));
    const int b = node(euclidean(curve.points.back()));
    starts_.push_back(a);
    edge_of_.push_back(-1);
    if (a == b) return;
    const auto [entry, is_new] = numbers_.try_emplace(key(a, b), to_int(edges_.size()));
    if (is_new) {
      edges_.push_back({a, b, {}});
      edges_at_[to_size(a)].push_back(entry->second);
      edges_at_[to_size(b)].push_back(entry->second);
    }
    edges_[to_size(entry->second)].sides.push_back(side);
    edge_of_.back() = entry->second;
  }

  int leading_side(const EdgeNode& edge) const {
    return *std::min_element(edge.sides.begin(), edge.sides.end(), [&](int a, int b) {
      return ranks_[to_size(a / k_)] < ranks_[to_size(b / k_)];
    });
  }

  void split(int e, int middle) {
    split_[to_size(e)] = true;
    edges_[to_size(e)].middle = middle;
    fixed_[to_size(e)] = true;
    for (const int f : passed_) fixed_[to_size(f)] = true;
  }

  void split_at_middle(int e) {
    const int side = leading_side(edges_[to_size(e)]);
    const EdgeNode& edge = edges_[to_size(e)];
    const bool forward = starts_[to_size(side)] == edge.a;
    const int from = forward ? edge.a : edge.b;
    const int to = forward ? edge.b : edge.a;
    const int middle = find_node(point(curves_[to_size(side)], 0.5));
    if (middle < 0 || middle == from || middle == to) return;
    if (are_connected(side, {0, 0.5}, from, middle) && are_connected(side, {0.5, 1}, middle, to)) {
      split(e, middle);
    }
  }

  /// Other sides lie along this part of an exact one, between two nodes, one after the other.
  bool are_connected(int side, Interval part, int from, int to) {
    const auto edge = numbers_.find(key(from, to));
    if (edge != numbers_.end()) {
      passed_.push_back(edge->second);
      return true;
    }
    const double t = 0.5 * (part.lower + part.upper);
    const int middle = find_node(point(curves_[to_size(side)], t));
    return middle >= 0 && middle != from && middle != to &&
           are_connected(side, {part.lower, t}, from, middle) &&
           are_connected(side, {t, part.upper}, middle, to);
  }

  /// Goes from end to end along unjoined sides of others that stay near.
  void split_along_others(int e) {
    const EdgeNode& edge = edges_[to_size(e)];
    const dvec3& a = positions_[to_size(edge.a)];
    const dvec3& b = positions_[to_size(edge.b)];
    const dvec3 middle = point(curves_[to_size(edge.sides.front())], 0.5);
    const double length = glm::distance(a, b);
    std::unordered_map<int, int> came_along;  // node -> edge
    std::queue<int> next;
    next.push(edge.a);
    came_along.emplace(edge.a, -1);
    while (!next.empty() && came_along.count(edge.b) == 0) {
      const int n = next.front();
      next.pop();
      for (const int f : edges_at_[to_size(n)]) {
        const EdgeNode& other = edges_[to_size(f)];
        if (other.sides.size() != 1 || other.sides.front() / k_ == edge.sides.front() / k_) continue;
        const int end = other.a == n ? other.b : other.a;
        const double distance = glm::distance(positions_[to_size(end)], middle);
        if (distance > reach * length || !came_along.emplace(end, f).second) continue;
        next.push(end);
      }
    }
    if (came_along.count(edge.b) == 0) return;
    int nearest = -1;
    double least = middle_reach * length;
    for (int n = edge.b; n != edge.a;) {
      const int f = came_along.at(n);
      passed_.push_back(f);
      n = edges_[to_size(f)].a == n ? edges_[to_size(f)].b : edges_[to_size(f)].a;
      const double distance = glm::distance(positions_[to_size(n)], middle);
      if (n == edge.a || distance > least) continue;
      least = distance;
      nearest = n;
    }
    if (nearest >= 0) split(e, nearest);
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

  /// How far from the middle of a side, in its lengths, the corners are that others have along it,
  /// and the one at which it is split. (On a half circle the ends are 0.71 away.)
  static constexpr double reach = 0.75;
  static constexpr double middle_reach = 0.25;

  int k_;
  std::vector<BezierCurve> curves_;
  std::vector<int> ranks_;  // per polygon
  Box box_;
  PointGrid grid_;
  std::vector<dvec3> positions_;            // of nodes
  std::vector<std::vector<int>> edges_at_;  // per node
  std::unordered_map<std::uint64_t, int> numbers_;
  std::vector<EdgeNode> edges_;
  std::vector<int> edge_of_;  // per side, -1 for those of no length
  std::vector<int> starts_;   // per side, its first node
  std::vector<bool> split_;   // per edge
  std::vector<bool> fixed_;   // that are split by neighbours, and what these have there
  std::vector<int> passed_;   // edges along the one that is looked at
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

/// Of a triangle: corners by barycentric coordinates.
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

void add_quads(const SurfaceTriangle& triangle, std::vector<SurfacePatch>& result) {
  const std::array<dvec3, 3> c = {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
  const dvec3 centre = (c[0] + c[1] + c[2]) / 3.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t before = (k + 2) % 3;
    const dvec3 to_next = 0.5 * (c[k] + c[(k + 1) % 3]);
    const dvec3 to_last = 0.5 * (c[k] + c[before]);
    SurfacePatch quad;
    quad.bezier = quad_of_triangle(triangle.points, {c[k], to_last, to_next, centre});
    quad.cage_face = triangle.cage_face;
    quad.exact = triangle.exact;
    quad.smooth = {triangle.smooth[before], true, triangle.smooth[k], true};
    result.push_back(std::move(quad));
  }
}

/// @name What rounds need of polygons
/// @{
constexpr int side_count(const SurfacePatch&) { return 4; }
constexpr int side_count(const SurfaceTriangle&) { return 3; }

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

void divide(const SurfacePatch& patch, const std::array<bool, 4>& split,
            std::vector<SurfacePatch>& result) {
  split_quad(patch, split, result);
}

void divide(const SurfaceTriangle& triangle, const std::array<bool, 4>& split,
            std::vector<SurfaceTriangle>& result) {
  for (const SubTriangle& part : bisected(triangle.smooth, {split[0], split[1], split[2]})) {
    SurfaceTriangle piece = triangle;
    piece.points = sub_triangle(triangle.points, part.corners);
    piece.smooth = part.smooth;
    result.push_back(std::move(piece));
  }
}
/// @}

template <class Polygon>
int rank_of(const Polygon& polygon) {
  return polygon.exact ? 0 : polygon.may_touch ? 1 : 2;
}

/// Gives the halves of a side, which parts of a polygon have, to a corner of others.
template <class Polygon>
void move_middle(const BezierCurve& whole, const dvec3& corner, Polygon* first, Polygon* last) {
  const dvec3 middle = point(whole, 0.5);
  const double tolerance = half_side_tolerance * glm::distance(point(whole, 0), point(whole, 1));
  for (Polygon* part = first; part != last; ++part) {
    for (int side = 0; side < side_count(*part); ++side) {
      const BezierCurve curve = side_curve(*part, side);
      for (const dvec4& end : {whole.points.front(), whole.points.back()}) {
        const auto is_half = [&](const dvec4& a, const dvec4& b) {
          return same_point(euclidean(a), euclidean(end), tolerance) &&
                 same_point(euclidean(b), middle, tolerance);
        };
        // Straight until the others' sides are known to be whole.
        if (is_half(curve.points.front(), curve.points.back())) {
          set_side(*part, side, {{end, homogeneous(corner)}});
        } else if (is_half(curve.points.back(), curve.points.front())) {
          set_side(*part, side, {{homogeneous(corner), end}});
        }
      }
    }
  }
}

/// Divides polygons until whole sides meet.
template <class Polygon>
std::vector<Polygon> divided(std::vector<Polygon> polygons, int k) {
  for (int round = 0; round < round_limit && !polygons.empty(); ++round) {
    std::vector<BezierCurve> curves;
    std::vector<int> ranks;
    curves.reserve(to_size(k) * polygons.size());
    ranks.reserve(polygons.size());
    for (const Polygon& polygon : polygons) {
      ranks.push_back(rank_of(polygon));
      for (int side = 0; side < k; ++side) curves.push_back(side_curve(polygon, side));
    }
    SideGraph graph(std::move(curves), std::move(ranks), k);
    graph.visit_joined([&](int from, int side, bool reversed) {
      Polygon& polygon = polygons[to_size(side / k)];
      if (polygon.exact) return;
      BezierCurve curve = side_curve(polygons[to_size(from / k)], from % k);
      set_side(polygon, side % k, reversed ? taut::reversed(curve) : std::move(curve));
    });
    graph.find_splits();
    if (k == 4) graph.make_even();
    std::vector<Polygon> next;
    next.reserve(polygons.size());
    for (int p = 0; p < to_int(polygons.size()); ++p) {
      const Polygon& whole = polygons[to_size(p)];
      std::array<bool, 4> split = {};
      for (int i = 0; i < k; ++i) split[to_size(i)] = graph.is_split(k * p + i);
      const std::size_t first = next.size();
      divide(whole, split, next);
      if (whole.exact || next.size() == first + 1) continue;
      for (int i = 0; i < k; ++i) {
        const dvec3* const corner = graph.corner_within(k * p + i);
        if (corner == nullptr) continue;
        move_middle(side_curve(whole, i), *corner, next.data() + first, next.data() + next.size());
      }
    }
    const bool done = next.size() == polygons.size();
    polygons = std::move(next);
    if (done) break;
  }
  return polygons;
}

}  // namespace

std::vector<SurfacePatch> conforming(std::vector<SurfacePatch> patches) {
  return divided(std::move(patches), 4);
}

std::vector<SurfacePatch> conforming(std::vector<SurfaceTriangle> triangles) {
  std::vector<SurfacePatch> result;
  result.reserve(3 * triangles.size());
  for (const SurfaceTriangle& triangle : divided(std::move(triangles), 3)) {
    add_quads(triangle, result);
  }
  return result;
}

}  // namespace taut
