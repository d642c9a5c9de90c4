#include <algorithm>
#include <cassert>
#include <numbers>
#include <utility>

#include "taut/core/disjoint_sets.h"
#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/surface/connect_progress.h"
#include "taut/surface/flatness.h"
#include "taut/surface/join_smoothness.h"
#include "taut/surface/model.h"
#include "taut/surface/nearly_ruled.h"
#include "taut/surface/point_grid.h"
#include "taut/surface/repeated_patches.h"
#include "taut/surface/side_joins.h"
#include "taut/surface/split_crests.h"

namespace taut {
namespace {

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

/// A piece of an edge before edges are put together; arcs' ends are numbered 2 * arc + end.
struct Arc {
  int join = -1;  ///< -1: a piece of a free curve
  bool seam = false;
  std::array<int, 2> point = {-1, -1};     ///< set of points at its ends
  std::array<dvec3, 2> direction = {};     ///< from its ends into the arc, unit
  std::array<int, 2> neighbor = {-1, -1};  ///< the arc's end that goes straight on from its ends
  int piece = -1;                          ///< its number in Part::pieces
};

/// A line that is bent no more than with a radius of so many diagonals of its part was straight.
constexpr double straight_radius = 100;

/// The state of Part::connect. Points are numbered: the patches' corners, 4 * patch + corner, then
/// the ends of the free curves' pieces.
class Connector {
 public:
  Connector(std::vector<Patch>& patches, std::vector<EdgePiece>& pieces, std::vector<Edge>& edges,
            std::vector<dvec3>& vertices, const Box& box, double tolerance, double smooth_angle,
            double grid, double bent, const Progress& progress)
      : patches_(patches),
        pieces_(pieces),
        edges_(edges),
        vertices_(vertices),
        box_(box),
        progress_(progress),
        tolerance_(tolerance),
        bent_(bent),
        free_piece_count_(to_int(pieces.size())),
        sides_(side_curves(patches, tolerance_)),
        smoothness_(patches, sides_, tolerance_, smooth_angle, grid, bent),
        points_(4 * patches.size() + 2 * pieces.size()) {}

  void run() {
    joins_ = match_sides(patches_, sides_, box_, tolerance_, progress_);
    smooth_.reserve(joins_.size());
    for (const Join& join : joins_) {
      report_connect(progress_, smooth_.size(), joins_.size());
      smooth_.push_back(smoothness_.is_smooth(join));
    }
    identify_points();
    find_arcs();
    place_vertices();
    make_edges();
    make_seams();
    fill_ends();
    fill_borders();
    fill_repeated();
  }

  int seam_vertex_count() const { return seam_vertex_count_; }
  double join_gap();

 private:
  dvec3 point_at(int number) const;
  void identify_points();
  void find_arcs();
  void add_arc(int join, const BezierCurve& curve, std::array<int, 2> points);
  void place_vertices();
  std::vector<std::pair<int, int>> sorted_ends() const;
  void add_vertices(const std::vector<bool>& has_vertex);
  bool goes_straight_on(int end_a, int end_b) const;
  bool is_straight(int end) const;
  std::vector<int> face_sides(const Arc& arc) const;
  std::vector<int> successors() const;
  void make_edges();
  void append_piece(Arc& arc, Edge& edge);
  void make_seams();
  void fill_ends();
  void fill_borders();
  void fill_repeated();

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
  const Progress& progress_;
  const double tolerance_;
  const double bent_;  ///< so far off rounding may have moved straight segments
  const int free_piece_count_;
  const std::vector<SideCurve> sides_;
  const JoinSmoothness smoothness_;
  std::vector<Join> joins_;
  std::vector<bool> smooth_;  // per join
  DisjointSets points_;
  std::vector<int> vertex_of_;  // by point set
  int seam_vertex_count_ = 0;
  std::vector<Arc> arcs_;  // the free pieces first, in their order
};

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
    const std::array<int, 2> first = side_points(join.front().side);
    for (const Use& use : join) {
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

/// Of sides, and of corners from the one in whose place a vertex would stand.
double Connector::join_gap() {
  double gap = largest_gap(sides_, joins_);
  for (int i = 0; i < to_int(4 * patches_.size()) + 2 * free_piece_count_; ++i) {
    gap = std::max(gap, glm::distance(point_at(i), point_at(points_.find(i))));
  }
  return gap;
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
    const Join& join = joins_[to_size(j)];
    const bool smooth = smooth_[to_size(j)];
    progress_.check();
    if (smooth && !smoothness_.is_seam(join)) continue;
    const int side = join.front().side;
    add_arc(j, sides_[to_size(side)].curve, side_points(side));
    arcs_.back().seam = smooth;
  }
}

/// All arcs' ends with the points they are at, by point.
std::vector<std::pair<int, int>> Connector::sorted_ends() const {
  std::vector<std::pair<int, int>> ends;
  ends.reserve(2 * arcs_.size());
  for (int a = 0; a < to_int(arcs_.size()); ++a) {
    for (const int e : {0, 1}) ends.emplace_back(arcs_[to_size(a)].point[to_size(e)], 2 * a + e);
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

/// An end that meets exactly one other straight on goes on there, unless one of the two is a
/// straight segment and the other is not; all others end in a vertex. First without seams, for
/// these leave edges and their vertices what they are; then with them: a seam that ends beside an
/// edge that goes on makes a vertex inside of that edge.
void Connector::place_vertices() {
  std::vector<bool> has_vertex(4 * patches_.size() + 2 * to_size(free_piece_count_));
  for (int side = 0; side < to_int(sides_.size()); ++side) {
    progress_.check();
    if (sides_[to_size(side)].collapsed && !smoothness_.is_pole(side)) {
      has_vertex[to_size(points_.find(side_points(side)[0]))] = true;
    }
  }
  const std::vector<std::pair<int, int>> ends = sorted_ends();
  vertex_of_.assign(has_vertex.size(), -1);
  for (const bool seams : {false, true}) {
    std::vector<int> here;
    for (std::size_t i = 0; i < ends.size();) {
      const int point = ends[i].first;
      bool concerned = !seams;
      here.clear();
      for (; i < ends.size() && ends[i].first == point; ++i) {
        const bool seam = arcs_[to_size(ends[i].second / 2)].seam;
        concerned = concerned || seam;
        if (seams || !seam) here.push_back(ends[i].second);
      }
      if (here.empty() || !concerned || has_vertex[to_size(point)]) continue;
      if (here.size() == 2 && goes_straight_on(here[0], here[1]) &&
          is_straight(here[0]) == is_straight(here[1])) {
        neighbor(here[0]) = here[1];
        neighbor(here[1]) = here[0];
      } else {
        has_vertex[to_size(point)] = true;
      }
    }
    const std::size_t before = vertices_.size();
    add_vertices(has_vertex);
    if (seams) seam_vertex_count_ = to_int(vertices_.size() - before);
  }
}

/// Adds those that are new.
void Connector::add_vertices(const std::vector<bool>& has_vertex) {
  for (std::size_t point = 0; point < has_vertex.size(); ++point) {
    if (!has_vertex[point] || vertex_of_[point] >= 0) continue;
    vertex_of_[point] = to_int(vertices_.size());
    vertices_.push_back(point_at(to_int(point)));
  }
}

/// Or was, before the part's numbers were rounded.
bool Connector::is_straight(int end) const {
  const Arc& arc = arcs_[to_size(end / 2)];
  const BezierCurve& curve = arc.join < 0
                                 ? pieces_[to_size(arc.piece)].bezier
                                 : sides_[to_size(joins_[to_size(arc.join)].front().side)].curve;
  if (taut::is_straight(curve)) return true;
  const double off = distance_from_segment(curve);
  const dvec3 chord = euclidean(curve.points.back()) - euclidean(curve.points.front());
  return off <= bent_ && glm::dot(chord, chord) >= 8 * straight_radius * diagonal(box_) * off;
}

bool Connector::goes_straight_on(int end_a, int end_b) const {
  const dvec3 a = arcs_[to_size(end_a / 2)].direction[to_size(end_a % 2)];
  const dvec3 b = arcs_[to_size(end_b / 2)].direction[to_size(end_b % 2)];
  return a != dvec3(0.0) && smoothness_.same_direction(a, -b);
}

/// The sides of faces that meet in a border arc, the same for all arcs of one edge.
std::vector<int> Connector::face_sides(const Arc& arc) const {
  std::vector<int> result;
  for (const Use& use : joins_[to_size(arc.join)]) {
    result.push_back(4 * patch_of(use.side).face + use.side % 4);
  }
  return result;
}

/// For each arc the next one of the same edge, or -1.
std::vector<int> Connector::successors() const {
  std::vector<int> next(arcs_.size(), -1);
  for (std::size_t a = to_size(free_piece_count_); a < arcs_.size(); ++a) {
    const int end = arcs_[a].neighbor[1];
    if (arcs_[a].seam || end < 2 * free_piece_count_ || end % 2 != 0) continue;
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
    if (arcs_[to_size(a)].seam || arcs_[to_size(a)].piece >= 0) continue;
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
}

/// Appends the arc's piece to the edge that is about to be added.
void Connector::append_piece(Arc& arc, Edge& edge) {
  const double t = edge.piece_count++;
  arc.piece = to_int(pieces_.size());
  EdgePiece piece;
  piece.bezier = sides_[to_size(joins_[to_size(arc.join)].front().side)].curve;
  piece.t = {t, t + 1};
  piece.edge = to_int(edges_.size());
  pieces_.push_back(std::move(piece));
}

/// Their pieces come after those of all edges.
void Connector::make_seams() {
  for (Arc& arc : arcs_) {
    if (!arc.seam) continue;
    arc.piece = to_int(pieces_.size());
    EdgePiece piece;
    piece.bezier = sides_[to_size(joins_[to_size(arc.join)].front().side)].curve;
    pieces_.push_back(std::move(piece));
  }
}

void Connector::fill_ends() {
  for (const Arc& arc : arcs_) {
    EdgePiece& piece = pieces_[to_size(arc.piece)];
    for (const std::size_t e : {0u, 1u}) {
      piece.end_vertex[e] = vertex_of_[to_size(arc.point[e])];
      if (piece.end_vertex[e] < 0) {
        piece.end_neighbor[e] = arcs_[to_size(arc.neighbor[e] / 2)].piece;
      }
    }
  }
}

void Connector::fill_borders() {
  for (std::size_t j = 0; j < joins_.size(); ++j) {
    const Join& join = joins_[j];
    for (const Use& use : join) {
      Border& border = border_of(use.side);
      border.kind = smooth_[j] ? BorderKind::smooth : BorderKind::edge;
      if (join.size() != 2) continue;
      const Use& other = &use == &join[0] ? join[1] : join[0];
      border.neighbor = other.side / 4;
      border.neighbor_side = all_sides[to_size(other.side % 4)];
      border.reversed = use.reversed != other.reversed;
    }
  }
  for (std::size_t a = to_size(free_piece_count_); a < arcs_.size(); ++a) {
    for (const Use& use : joins_[to_size(arcs_[a].join)]) {
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

/// What has no join of its own is as in the patch that is repeated.
void Connector::fill_repeated() {
  for (Patch& patch : patches_) {
    if (patch.repeats < 0) continue;
    for (const Side side : all_sides) {
      const RepeatedSide there = side_in_repeated(patch, side);
      Border copy = patches_[to_size(patch.repeats)].borders[to_size(int(there.side))];
      copy.reversed = copy.reversed != there.reversed;
      copy.piece_reversed = copy.piece_reversed != there.reversed;
      patch.borders[to_size(int(side))] = copy;
    }
  }
}

/// By how much the patch misses being ruled, where rounding alone may have made it. What stands for
/// a surface has no lines of its own, unless it is plane.
Patch::OffRuled off_ruled(const Patch& own, double bent, double size) {
  const BezierPatch& patch = own.bezier;
  // The middle of a line of length s bent with radius r is s^2 / (8 r) off.
  const auto was_straight = [&](double square, double off) {
    return off <= bent && square >= 8 * straight_radius * size * off;
  };
  const double square_u = square_of_lines(patch, Direction::u);
  const double square_v = square_of_lines(patch, Direction::v);
  Patch::OffRuled result;
  // The inside may be on one side of the plane, the border on the other.
  const double from_plane = 2 * distance_from_plane(patch);
  if (was_straight(std::min(square_u, square_v), from_plane) && !is_folded(patch)) {
    result.u = result.v = from_plane;
    return result;
  }
  if (own.stand_in) return result;
  const double off_u = distance_from_ruled(patch, Direction::u);
  const double off_v = distance_from_ruled(patch, Direction::v);
  if (was_straight(square_u, off_u)) result.u = off_u;
  if (was_straight(square_v, off_v)) result.v = off_v;
  if (result.any()) return result;
  const NearCylinder cylinder = near_cylinder(patch);
  if (was_straight(cylinder.length * cylinder.length, cylinder.distance)) {
    result.oblique = cylinder.distance;
    result.along = cylinder.along;
    result.turned = cylinder.turned;
  }
  return result;
}

/// `bent`: what the rounding of coordinates may have made of the distances of patches' points from
/// straight lines and planes.
void find_rulings(std::vector<Patch>& patches, const Box& box, double bent,
                  const Progress& progress) {
  for (std::size_t k = 0; k < patches.size(); ++k) {
    Patch& patch = patches[k];
    report_connect(progress, k, patches.size());
    const bool plane = is_plane(patch.bezier) && !is_folded(patch.bezier);
    patch.ruled_u = plane || is_ruled(patch.bezier, Direction::u);
    patch.ruled_v = plane || is_ruled(patch.bezier, Direction::v);
    patch.ruled_obliquely = !patch.ruled() && is_developable(patch.bezier);
    if (bent > 0) patch.off_ruled = off_ruled(patch, bent, diagonal(box));
  }
}

}  // namespace

void Part::connect(double smooth_angle, const Progress& progress) {
  assert(!connected_);
  if (!(smooth_angle >= 0 && smooth_angle <= std::numbers::pi / 2)) {
    throw InvalidInput(name + ": the smooth angle " + std::to_string(smooth_angle) +
                       " is not between 0 and pi/2");
  }
  point_count_ = to_int(vertices_.size());
  // As far as the resolution goes that it asks for.
  const double half_step = std::min(0.5 * coordinate_grid().step,
                                    coarsest_resolution / grid_resolution * diagonal(box_));
  // What points may be off lines and planes of others.
  const double bent = cover_share * grid_resolution * half_step;
  // What the steps take of cages, about.
  constexpr double ruled_share = 0.25;
  constexpr double crests_share = 0.75;
  find_rulings(patches_, box_, bent, progress.part(0, ruled_share));
  // Patches of cages are computed, whatever the cages' points were rounded to: their borders meet.
  const bool meet = !cages_.empty();
  const double apart = meet ? 0 : bent;
  split_crests(faces_, patches_, box_, apart, meet ? 0 : 2 * half_step,
               progress.part(ruled_share, crests_share));
  split_junctions(faces_, patches_, box_, apart, progress);
  find_repeated_patches(patches_, box_, meet ? 0 : copies_apart_limit * grid_resolution * half_step,
                        progress);
  const Progress rest = progress.part(crests_share, 1);
  Connector connector(patches_, pieces_, edges_, vertices_, box_, join_tolerance(box_, apart),
                      smooth_angle, meet ? 0 : 2 * half_step, bent, rest);
  connector.run();
  seam_vertex_count_ = connector.seam_vertex_count();
  join_gap_ = connector.join_gap();
  connected_ = true;
}

}  // namespace taut
