#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/surface/model.h"

namespace taut {
namespace {

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }
int to_int(std::size_t n) { return static_cast<int>(n); }

/// The quotient comes first since squares of a small part's lengths underflow.
bool same_point(const dvec3& a, const dvec3& b, double tolerance) {
  const dvec3 d = (a - b) / tolerance;
  return glm::dot(d, d) <= 1;
}

/// Numbered points, found by place. Cells are a few tolerances wide: a query seldom looks into more
/// than one, and points that lie farther apart than the tolerance cannot crowd one.
class PointGrid {
 public:
  PointGrid(const Box& box, double tolerance)
      : origin_(box.lower), tolerance_(tolerance), cell_(8 * tolerance) {}

  void insert(const dvec3& p, int number) {
    int& head = heads_.try_emplace(key(cell(p, 0)), -1).first->second;
    entries_.push_back({p, number, head});
    head = to_int(entries_.size()) - 1;
  }

  /// Calls visit(number) for all points within the tolerance of p, in a fixed order.
  template <class Visit>
  void visit_near(const dvec3& p, const Visit& visit) const {
    const Cell lower = cell(p, -tolerance_);
    const Cell upper = cell(p, tolerance_);
    Cell c;
    for (c[0] = lower[0]; c[0] <= upper[0]; ++c[0]) {
      for (c[1] = lower[1]; c[1] <= upper[1]; ++c[1]) {
        for (c[2] = lower[2]; c[2] <= upper[2]; ++c[2]) {
          const auto head = heads_.find(key(c));
          if (head == heads_.end()) continue;
          for (int e = head->second; e >= 0; e = entries_[to_size(e)].next) {
            const Entry& entry = entries_[to_size(e)];
            if (same_point(entry.point, p, tolerance_)) visit(entry.number);
          }
        }
      }
    }
  }

 private:
  struct Entry {
    dvec3 point;
    int number;
    int next;
  };
  using Cell = std::array<std::uint64_t, 3>;

  /// The box is at most 1 / (8 join_distance) cells wide, which leaves room in 21 bits; the limits
  /// are met only where coordinates are so far out that a tolerance is less than their rounding.
  Cell cell(const dvec3& p, double offset) const {
    Cell c;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = std::floor((p[axis] + offset - origin_[axis]) / cell_) + 2;
      c[to_size(axis)] = static_cast<std::uint64_t>(std::fmin(std::fmax(x, 0), 0x1p21 - 1));
    }
    return c;
  }
  static std::uint64_t key(const Cell& c) { return (c[0] << 42) | (c[1] << 21) | c[2]; }

  dvec3 origin_;
  double tolerance_;
  double cell_;
  std::unordered_map<std::uint64_t, int> heads_;
  std::vector<Entry> entries_;
};

/// Disjoint sets of the numbers below a count; a set is known by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int a) {
    while (parent_[to_size(a)] != a) {
      a = parent_[to_size(a)] = parent_[to_size(parent_[to_size(a)])];
    }
    return a;
  }
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[to_size(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Unit vectors differ by at most the angle whose chord is given.
bool same_direction(const dvec3& a, const dvec3& b, double chord) {
  return glm::length(a - b) <= chord;
}

/// Chebyshev parameter k of 0 .. m on [0, 1]: a polynomial of degree m is at most O(log m) times as
/// large between them as at them.
double sample_parameter(int k, int m) { return 0.5 - 0.5 * std::cos(std::numbers::pi * k / m); }

/// Curve b, run backwards if `reversed`, is curve a.
///
/// They are compared as points at equal parameters rather than by control points, since that is the
/// distance which the tolerance means, for any weights and degrees. Two rational curves of degrees
/// p and q that agree at p + q + 1 parameters are the same.
bool agree(const BezierCurve& a, const BezierCurve& b, bool reversed, double tolerance) {
  const auto same = [&](const dvec4& p, const dvec4& q) {
    return same_point(euclidean(p), euclidean(q), tolerance);
  };
  if (!same(a.points.front(), reversed ? b.points.back() : b.points.front()) ||
      !same(a.points.back(), reversed ? b.points.front() : b.points.back())) {
    return false;
  }
  const int m = a.degree() + b.degree();
  for (int k = 1; k < m; ++k) {
    const double t = sample_parameter(k, m);
    if (!same_point(point(a, t), point(b, reversed ? 1 - t : t), tolerance)) return false;
  }
  return true;
}

/// A point that curves have in common if they agree, in either direction, within twice the
/// tolerance. The middle alone would do, but not where very many curves cross in theirs.
dvec3 place_of(const BezierCurve& curve) {
  const dvec3 chord = euclidean(curve.points.back()) - euclidean(curve.points.front());
  return point(curve, 0.5) + 0.5 * glm::abs(chord);
}

/// Unit direction in which the curve leaves its start, or zero if it stays within the tolerance.
/// Points nearer than that are passed over: what they tell is rounding, or nothing if they
/// coincide.
dvec3 start_direction(const BezierCurve& curve, double tolerance) {
  const dvec3 start = euclidean(curve.points.front());
  for (const dvec4& p : curve.points) {
    if (!same_point(euclidean(p), start, tolerance)) return unit(euclidean(p) - start);
  }
  return dvec3(0.0);
}

/// Normal of the patch at parameter t of a side.
dvec3 side_normal(const BezierPatch& patch, Side side, double t) {
  switch (side) {
    case Side::u0:
      return unit_normal(patch, 0, t);
    case Side::u1:
      return unit_normal(patch, 1, t);
    case Side::v0:
      return unit_normal(patch, t, 0);
    default:
      return unit_normal(patch, t, 1);
  }
}

/// The corners (as in Patch::corner_vertex) from which and to which a side runs.
std::array<int, 2> side_corners(Side side) {
  switch (side) {
    case Side::u0:
      return {0, 1};
    case Side::u1:
      return {2, 3};
    case Side::v0:
      return {0, 2};
    default:
      return {1, 3};
  }
}

/// Su x Sv is (direction into the patch) x (direction of the side), or minus it.
bool normal_is_inward_cross_along(Side side) { return side == Side::u0 || side == Side::v1; }

/// One side of a patch; sides are numbered 4 * patch + side.
struct SideCurve {
  BezierCurve curve;
  bool collapsed = false;
};

/// A side that takes part in a join.
struct Use {
  int side = 0;
  bool reversed = false;  ///< relative to the first use
};

/// A curve in which sides meet, or a single one ends; uses are in ascending order of the sides.
struct Join {
  std::vector<Use> uses;
  bool smooth = false;
};

/// A piece of an edge before edges are put together; arcs' ends are numbered 2 * arc + end.
struct Arc {
  int join = -1;                           ///< -1: a piece of a free curve
  std::array<int, 2> point = {-1, -1};     ///< set of points at its ends
  std::array<dvec3, 2> direction = {};     ///< from its ends into the arc, unit
  std::array<int, 2> neighbor = {-1, -1};  ///< the arc's end that goes straight on from its ends
  int piece = -1;                          ///< its number in Part::pieces
};

/// The state of Part::connect. Points are numbered: the patches' corners, 4 * patch + corner, then
/// the ends of the free curves' pieces.
class Connector {
 public:
  Connector(std::vector<Patch>& patches, std::vector<EdgePiece>& pieces, std::vector<Edge>& edges,
            std::vector<dvec3>& vertices, const Box& box, double smooth_angle)
      : patches_(patches),
        pieces_(pieces),
        edges_(edges),
        vertices_(vertices),
        box_(box),
        tolerance_(std::max(join_distance * diagonal(box), std::numeric_limits<double>::min())),
        chord_(2 * std::sin(smooth_angle / 2)),
        free_piece_count_(to_int(pieces.size())),
        points_(4 * patches.size() + 2 * pieces.size()) {}

  void run() {
    find_sides();
    match_sides();
    identify_points();
    find_arcs();
    place_vertices();
    make_edges();
    fill_borders();
  }

 private:
  void find_sides();
  void match_sides();
  bool is_smooth(const Use& a, const Use& b) const;
  bool is_pole(int side) const;
  dvec3 point_at(int number) const;
  void identify_points();
  void find_arcs();
  void add_arc(int join, const BezierCurve& curve, std::array<int, 2> points);
  void place_vertices();
  bool goes_straight_on(int end_a, int end_b) const;
  std::vector<int> face_sides(const Arc& arc) const;
  std::vector<int> successors() const;
  void make_edges();
  void append_piece(Arc& arc, Edge& edge);
  void fill_borders();

  /// Of a side's or a corner's number.
  const Patch& patch_of(int number) const { return patches_[to_size(number / 4)]; }
  Border& border_of(int side) { return patches_[to_size(side / 4)].borders[to_size(side % 4)]; }
  int& neighbor(int end) { return arcs_[to_size(end / 2)].neighbor[to_size(end % 2)]; }
  std::array<int, 2> side_points(int side) const;

  std::vector<Patch>& patches_;
  std::vector<EdgePiece>& pieces_;
  std::vector<Edge>& edges_;
  std::vector<dvec3>& vertices_;
  const Box box_;
  const double tolerance_;
  const double chord_;  // of the smooth angle
  const int free_piece_count_;
  std::vector<SideCurve> sides_;
  std::vector<Join> joins_;
  DisjointSets points_;
  std::vector<int> vertex_of_;  // by point set
  std::vector<Arc> arcs_;       // the free pieces first, in their order
};

void Connector::find_sides() {
  sides_.reserve(4 * patches_.size());
  for (const Patch& patch : patches_) {
    for (const Side side : all_sides) {
      SideCurve s{border(patch.bezier, side), true};
      const dvec3 start = euclidean(s.curve.points.front());
      for (const dvec4& p : s.curve.points) {
        s.collapsed = s.collapsed && same_point(euclidean(p), start, tolerance_);
      }
      sides_.push_back(std::move(s));
    }
  }
}

void Connector::match_sides() {
  PointGrid places(box_, 2 * tolerance_);
  for (int side = 0; side < to_int(sides_.size()); ++side) {
    const SideCurve& s = sides_[to_size(side)];
    if (s.collapsed) continue;
    const dvec3 place = place_of(s.curve);
    Use use{side, false};
    int found = to_int(joins_.size());
    places.visit_near(place, [&](int join) {
      if (join > found) return;
      const BezierCurve& first = sides_[to_size(joins_[to_size(join)].uses.front().side)].curve;
      for (const bool reversed : {false, true}) {
        if (!agree(first, s.curve, reversed, tolerance_)) continue;
        found = join;
        use.reversed = reversed;
        return;
      }
    });
    if (found == to_int(joins_.size())) {
      joins_.emplace_back();
      places.insert(place, found);
    }
    joins_[to_size(found)].uses.push_back(use);
  }
  for (Join& join : joins_) {
    join.smooth = join.uses.size() == 2 && is_smooth(join.uses[0], join.uses[1]);
  }
}

/// G1 along a border x(t) is det(X, X', A, B) = 0 with homogeneous X and cross derivatives A, B: a
/// polynomial of degree at most 4 d - 2, which 4 d - 1 parameters determine.
bool Connector::is_smooth(const Use& a, const Use& b) const {
  const Side side_a = all_sides[to_size(a.side % 4)];
  const Side side_b = all_sides[to_size(b.side % 4)];
  const bool reversed = a.reversed != b.reversed;
  // Where b continues a, the directions into the two patches are opposite; where it folds back onto
  // a, they are the same. So the sign between the two normals is known.
  const bool opposite =
      (normal_is_inward_cross_along(side_a) == normal_is_inward_cross_along(side_b)) != reversed;
  const int m =
      4 * std::max(sides_[to_size(a.side)].curve.degree(), sides_[to_size(b.side)].curve.degree()) -
      2;
  for (int k = 0; k <= m; ++k) {
    const double t = sample_parameter(k, m);
    const dvec3 na = side_normal(patch_of(a.side).bezier, side_a, t);
    const dvec3 nb = side_normal(patch_of(b.side).bezier, side_b, reversed ? 1 - t : t);
    if (na == dvec3(0.0) || !same_direction(na, opposite ? -nb : nb, chord_)) return false;
  }
  return true;
}

/// The normals' limits agree along a collapsed side, as at the pole of a sphere.
bool Connector::is_pole(int side) const {
  const BezierPatch& patch = patch_of(side).bezier;
  const Side s = all_sides[to_size(side % 4)];
  const int m = 4 * sides_[to_size(side)].curve.degree() - 2;
  const dvec3 first = side_normal(patch, s, 0);
  if (first == dvec3(0.0)) return false;
  for (int k = 1; k <= m; ++k) {
    if (!same_direction(side_normal(patch, s, sample_parameter(k, m)), first, chord_)) return false;
  }
  return true;
}

std::array<int, 2> Connector::side_points(int side) const {
  const std::array<int, 2> corners = side_corners(all_sides[to_size(side % 4)]);
  return {side / 4 * 4 + corners[0], side / 4 * 4 + corners[1]};
}

dvec3 Connector::point_at(int number) const {
  const int corner_count = 4 * to_int(patches_.size());
  if (number < corner_count) {
    const BezierPatch& patch = patch_of(number).bezier;
    const int corner = number % 4;
    return euclidean(
        patch.at(corner < 2 ? 0 : patch.degree_u, corner % 2 == 0 ? 0 : patch.degree_v));
  }
  const int end = number - corner_count;
  const auto& points = pieces_[to_size(end / 2)].bezier.points;
  return euclidean(end % 2 == 0 ? points.front() : points.back());
}

/// Unites points that are the same by their place or because sides that meet, or collapse, say so.
void Connector::identify_points() {
  PointGrid grid(box_, tolerance_);
  for (int i = 0; i < to_int(4 * patches_.size()) + 2 * free_piece_count_; ++i) {
    const dvec3 p = point_at(i);
    bool is_new = true;
    grid.visit_near(p, [&](int j) {
      points_.unite(i, j);
      is_new = false;
    });
    // One point for many near ones keeps the cells small.
    if (is_new) grid.insert(p, i);
  }
  for (const Join& join : joins_) {
    const std::array<int, 2> first = side_points(join.uses.front().side);
    for (const Use& use : join.uses) {
      const std::array<int, 2> ends = side_points(use.side);
      points_.unite(first[0], ends[use.reversed ? 1 : 0]);
      points_.unite(first[1], ends[use.reversed ? 0 : 1]);
    }
  }
  for (int side = 0; side < to_int(sides_.size()); ++side) {
    const std::array<int, 2> ends = side_points(side);
    if (sides_[to_size(side)].collapsed) points_.unite(ends[0], ends[1]);
  }
}

void Connector::add_arc(int join, const BezierCurve& curve, std::array<int, 2> points) {
  Arc arc;
  arc.join = join;
  arc.point = {points_.find(points[0]), points_.find(points[1])};
  arc.direction = {start_direction(curve, tolerance_),
                   start_direction(reversed(curve), tolerance_)};
  arcs_.push_back(arc);
}

void Connector::find_arcs() {
  const int corner_count = 4 * to_int(patches_.size());
  for (int i = 0; i < free_piece_count_; ++i) {
    add_arc(-1, pieces_[to_size(i)].bezier, {corner_count + 2 * i, corner_count + 2 * i + 1});
    arcs_.back().piece = i;
  }
  for (int j = 0; j < to_int(joins_.size()); ++j) {
    if (joins_[to_size(j)].smooth) continue;
    const int side = joins_[to_size(j)].uses.front().side;
    add_arc(j, sides_[to_size(side)].curve, side_points(side));
  }
}

/// An end that meets exactly one other straight on goes on there; all others end in a vertex.
void Connector::place_vertices() {
  std::vector<bool> has_vertex(4 * patches_.size() + 2 * to_size(free_piece_count_));
  for (int side = 0; side < to_int(sides_.size()); ++side) {
    if (sides_[to_size(side)].collapsed && !is_pole(side)) {
      has_vertex[to_size(points_.find(side_points(side)[0]))] = true;
    }
  }
  std::vector<std::pair<int, int>> ends;  // (point set, end)
  for (int a = 0; a < to_int(arcs_.size()); ++a) {
    for (const int e : {0, 1}) ends.emplace_back(arcs_[to_size(a)].point[to_size(e)], 2 * a + e);
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0, next = 0; i < ends.size(); i = next) {
    const int point = ends[i].first;
    while (next < ends.size() && ends[next].first == point) ++next;
    if (next - i == 2 && !has_vertex[to_size(point)] &&
        goes_straight_on(ends[i].second, ends[i + 1].second)) {
      neighbor(ends[i].second) = ends[i + 1].second;
      neighbor(ends[i + 1].second) = ends[i].second;
    } else {
      has_vertex[to_size(point)] = true;
    }
  }
  vertex_of_.assign(has_vertex.size(), -1);
  for (std::size_t point = 0; point < has_vertex.size(); ++point) {
    if (!has_vertex[point]) continue;
    vertex_of_[point] = to_int(vertices_.size());
    vertices_.push_back(point_at(to_int(point)));
  }
}

bool Connector::goes_straight_on(int end_a, int end_b) const {
  const dvec3 a = arcs_[to_size(end_a / 2)].direction[to_size(end_a % 2)];
  const dvec3 b = arcs_[to_size(end_b / 2)].direction[to_size(end_b % 2)];
  return a != dvec3(0.0) && same_direction(a, -b, chord_);
}

/// The sides of faces that meet in a border arc, the same for all arcs of one edge.
std::vector<int> Connector::face_sides(const Arc& arc) const {
  std::vector<int> result;
  for (const Use& use : joins_[to_size(arc.join)].uses) {
    result.push_back(4 * patch_of(use.side).face + use.side % 4);
  }
  return result;
}

/// For each arc the next one of the same edge, or -1.
std::vector<int> Connector::successors() const {
  std::vector<int> next(arcs_.size(), -1);
  for (std::size_t a = to_size(free_piece_count_); a < arcs_.size(); ++a) {
    const int end = arcs_[a].neighbor[1];
    if (end < 2 * free_piece_count_ || end % 2 != 0) continue;
    if (face_sides(arcs_[a]) == face_sides(arcs_[to_size(end / 2)])) next[a] = end / 2;
  }
  return next;
}

/// Edges stand in the order of their lowest arcs; a closed one begins there.
void Connector::make_edges() {
  const std::vector<int> next = successors();
  std::vector<int> previous(arcs_.size(), -1);
  for (int a = 0; a < to_int(arcs_.size()); ++a) {
    if (next[to_size(a)] >= 0) previous[to_size(next[to_size(a)])] = a;
  }
  for (int a = free_piece_count_; a < to_int(arcs_.size()); ++a) {
    if (arcs_[to_size(a)].piece >= 0) continue;
    int first = a;
    while (previous[to_size(first)] >= 0) {
      first = previous[to_size(first)];
      if (first == a) break;
    }
    Edge edge;
    edge.first_piece = to_int(pieces_.size());
    for (const int face_side : face_sides(arcs_[to_size(first)])) {
      edge.faces.push_back(face_side / 4);
    }
    for (int b = first; b >= 0 && arcs_[to_size(b)].piece < 0; b = next[to_size(b)]) {
      append_piece(arcs_[to_size(b)], edge);
    }
    edges_.push_back(std::move(edge));
  }
  for (const Arc& arc : arcs_) {
    EdgePiece& piece = pieces_[to_size(arc.piece)];
    for (const std::size_t e : {0u, 1u}) {
      if (arc.neighbor[e] >= 0) {
        piece.end_neighbor[e] = arcs_[to_size(arc.neighbor[e] / 2)].piece;
      } else {
        piece.end_vertex[e] = vertex_of_[to_size(arc.point[e])];
      }
    }
  }
}

/// Appends the arc's piece to the edge that is about to be added.
void Connector::append_piece(Arc& arc, Edge& edge) {
  const double t = edge.piece_count++;
  arc.piece = to_int(pieces_.size());
  EdgePiece piece;
  piece.bezier = sides_[to_size(joins_[to_size(arc.join)].uses.front().side)].curve;
  piece.t = {t, t + 1};
  piece.edge = to_int(edges_.size());
  pieces_.push_back(std::move(piece));
}

void Connector::fill_borders() {
  for (const Join& join : joins_) {
    for (const Use& use : join.uses) {
      Border& border = border_of(use.side);
      border.kind = join.smooth ? BorderKind::smooth : BorderKind::edge;
      if (join.uses.size() != 2) continue;
      const Use& other = &use == &join.uses[0] ? join.uses[1] : join.uses[0];
      border.neighbor = other.side / 4;
      border.neighbor_side = all_sides[to_size(other.side % 4)];
      border.reversed = use.reversed != other.reversed;
    }
  }
  for (std::size_t a = to_size(free_piece_count_); a < arcs_.size(); ++a) {
    for (const Use& use : joins_[to_size(arcs_[a].join)].uses) {
      Border& border = border_of(use.side);
      border.piece = arcs_[a].piece;
      border.edge = pieces_[to_size(border.piece)].edge;
      border.piece_reversed = use.reversed;
    }
  }
  for (int side = 0; side < to_int(sides_.size()); ++side) {
    if (!sides_[to_size(side)].collapsed) continue;
    border_of(side).kind = BorderKind::collapsed;
    border_of(side).vertex = vertex_of_[to_size(points_.find(side_points(side)[0]))];
  }
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c) {
      patches_[p].corner_vertex[c] = vertex_of_[to_size(points_.find(to_int(4 * p + c)))];
    }
  }
}

}  // namespace

void Part::connect(double smooth_angle) {
  assert(!connected_);
  if (!(smooth_angle >= 0 && smooth_angle <= std::numbers::pi / 2)) {
    throw InvalidInput(name + ": the smooth angle " + std::to_string(smooth_angle) +
                       " is not between 0 and pi/2");
  }
  point_count_ = to_int(vertices_.size());
  Connector(patches_, pieces_, edges_, vertices_, box_, smooth_angle).run();
  connected_ = true;
}

}  // namespace taut
