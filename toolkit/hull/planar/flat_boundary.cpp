#include "taut/hull/planar/flat_boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/hull/planar/flat_side.h"
#include "taut/hull/planar/planar_arcs.h"
#include "taut/hull/planar/planar_hull.h"

namespace taut {
namespace {

/// Places on edges no farther from an end are there: Newton's method leaves them so near to it.
constexpr double end_distance = 1e-9;

/// What the outline's heights, and those of support queries above them, differ by as they round.
constexpr double rounding_of_heights = planar_slack + support_slack;

/// Directions about a corner that are asked differ by no more: what is no higher than d in two of
/// them is no farther from the corner, between them, than d over the cosine of half of it.
constexpr double most_turn = std::numbers::pi / 6;

/// Places of faces beyond which an outline is not followed.
constexpr std::size_t most_corners = 1 << 17;

/// A supporting line of the outline, and where it touches that.
struct Tangent {
  dvec2 n;  ///< unit, outward
  dvec2 x;
  Contact at;
  bool begins = false;  ///< the first one of a side
};

double distance_to_segment(const dvec2& x, const dvec2& a, const dvec2& b) {
  return taut::distance_to_segment(dvec3(x, 0), dvec3(a, 0), dvec3(b, 0));
}

/// Makes the boundary.
class FlatBoundary {
 public:
  FlatBoundary(const ContactGeometry& geometry, SupportQuery& query, const FlatExtent& extent,
               double rho)
      : geometry_(geometry),
        query_(query),
        extent_(extent),
        frame_(tangent_frame(extent.n)),
        rho_(rho),
        width_(std::min(cover_share * rho, across(rho, 2 * extent.half_width))) {}

  std::optional<HullBoundary> make();

 private:
  /// Of a length, what is left in a plane where it reaches so far across it.
  static double across(double length, double height) {
    return std::sqrt(std::max(length * length - height * height, 0.0));
  }
  dvec2 in_plane(const dvec3& x) const { return {glm::dot(x, frame_[0]), glm::dot(x, frame_[1])}; }
  dvec3 in_space(const dvec2& d) const { return d.x * frame_[0] + d.y * frame_[1]; }
  std::size_t next(std::size_t k) const { return (k + 1) % sides_.size(); }

  void measure_across();
  void collect();
  Contact on_piece(int curve, double t) const;
  std::vector<dvec3> planar_curve(const Contact& piece) const;
  void set_polygon(FlatSide& side) const;
  void take(const PlanarHull& hull);
  void simplify();
  double distance_beside(std::size_t from, std::size_t to) const;
  std::size_t straight_end(std::size_t from, std::size_t limit) const;
  void close_dents();
  std::optional<double> dent(const FlatSide& before, const FlatSide& across,
                             const FlatSide& after) const;
  void see_corners();
  std::vector<Tangent> tangents() const;
  void ask(const Tangent& tangent);
  void ask_between(const Tangent& from, const Tangent& to);
  void ask_all();
  bool has_area() const;
  bool find_sides(const std::vector<std::vector<dvec3>>& curves, bool with_faces);

  HullFace facet() const;

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  FlatExtent extent_;
  std::array<dvec3, 2> frame_;
  double rho_;
  double width_;                  ///< what may be left out
  double off_ = 0;                ///< how far the outline is from the hull's
  std::vector<Contact> corners_;  ///< places that may be corners
  std::vector<Contact> beyond_;   ///< places beyond the outline
  std::vector<Contact> pieces_;
  std::vector<FlatSide> sides_;
};

/// Of what is thinner than its plane is told apart by, but thicker than rounding makes it.
void FlatBoundary::measure_across() {
  if (extent_.half_width > 0) return;
  const Scene& scene = geometry_.scene();
  const dvec3 reach = glm::max(glm::abs(scene.box().lower), glm::abs(scene.box().upper));
  const double of_coordinates = coordinate_rounding * (reach.x + reach.y + reach.z);
  const double width = query_(extent_.n).h_bound + query_(-extent_.n).h_bound;
  // Bounds in a scene of size two, at most.
  constexpr double slack = 2 * 2 * support_slack;
  if (width <= slack + scene.frame().length_to_frame(of_coordinates)) return;
  extent_.half_width = 0.5 * width;
}

/// The model's vertices, and pieces of edges that are not straight.
void FlatBoundary::collect() {
  const Model& model = geometry_.scene().model();
  for (const int i : geometry_.scene().distinct_instances()) {
    const Part& part = model.parts()[to_size(model.instances()[to_size(i)].part)];
    const int vertices = int(part.vertices().size()) - part.seam_vertex_count();
    for (int k = 0; k < vertices; ++k) {
      const Contact vertex{i, SourceKind::vertex, k, 0, 0};
      if (!geometry_.is_repeated(vertex)) corners_.push_back(vertex);
    }
    for (int k = 0; k < int(part.pieces().size()); ++k) {
      const Contact piece{i, SourceKind::edge, k, 0, 0};
      if (part.pieces()[to_size(k)].edge < 0 || geometry_.is_repeated(piece)) continue;
      if (!geometry_.is_straight(piece)) pieces_.push_back(piece);
    }
  }
}

/// At an end that is no farther, or inside.
Contact FlatBoundary::on_piece(int curve, double t) const {
  Contact c = pieces_[to_size(curve)];
  c.u = t;
  const double end = std::round(t);
  if (std::abs(t - end) * glm::length(geometry_.jet(c).dx[0]) <= end_distance) c.u = end;
  return c;
}

std::vector<dvec3> FlatBoundary::planar_curve(const Contact& piece) const {
  std::vector<dvec3> curve;
  for (const dvec4& p : geometry_.curve(piece).points) curve.emplace_back(in_plane(dvec3(p)), p.w);
  return curve;
}

void FlatBoundary::set_polygon(FlatSide& side) const {
  side.polygon = part_polygon(planar_curve(side.along.at(0)), side.along.from, side.along.to);
}

void FlatBoundary::take(const PlanarHull& hull) {
  for (const OutlineSide& side : hull.sides) {
    FlatSide own;
    own.corner = geometry_.canonical(side.point >= 0 ? corners_[to_size(side.point)]
                                                     : on_piece(side.curve, side.t));
    own.x = in_plane(geometry_.point(own.corner));
    if (side.along >= 0) {
      const Contact& piece = pieces_[to_size(side.along)];
      own.along = {piece.instance, piece.element, on_piece(side.along, side.from).u,
                   on_piece(side.along, side.to).u};
      set_polygon(own);
    }
    sides_.push_back(std::move(own));
  }
}

/// How far the sides from one corner to another are from the segment between these, at most.
double FlatBoundary::distance_beside(std::size_t from, std::size_t to) const {
  geometry_.check_stop();
  const auto side = [&](std::size_t k) -> const FlatSide& { return sides_[k % sides_.size()]; };
  double farthest = 0;
  const auto see = [&](const dvec2& x) {
    farthest = std::max(farthest, distance_to_segment(x, side(from).x, side(to).x));
  };
  for (std::size_t k = from; k < to; ++k) {
    see(side(k).x);
    for (const dvec2& x : side(k).polygon) see(x);
  }
  return farthest;
}

/// The last corner, before the limit, to which a segment runs beside all sides from the first on.
std::size_t FlatBoundary::straight_end(std::size_t from, std::size_t limit) const {
  std::size_t to = from;
  while (to < limit && distance_beside(from, to + 1) <= width_) ++to;
  return to;
}

/// Beginning in a corner that stays: the farthest from another.
void FlatBoundary::simplify() {
  const auto farther = [&](const FlatSide& a, const FlatSide& b) {
    return glm::distance(a.x, sides_[0].x) < glm::distance(b.x, sides_[0].x);
  };
  std::rotate(sides_.begin(), std::max_element(sides_.begin(), sides_.end(), farther),
              sides_.end());
  std::vector<FlatSide> left;
  for (std::size_t from = 0; from < sides_.size();) {
    left.push_back(sides_[from]);
    const std::size_t to = straight_end(from, sides_.size());
    if (to > from) {
      off_ = std::max(off_, distance_beside(from, to));
      left.back().along = {};
      left.back().polygon.clear();
    }
    from = std::max(to, from + 1);
  }
  sides_ = std::move(left);
}

/// Where a straight side leads from one piece of an edge over a dent at its end to the next one:
/// how deep that is.
std::optional<double> FlatBoundary::dent(const FlatSide& before, const FlatSide& across,
                                         const FlatSide& after) const {
  if (!before.is_curved() || across.is_curved() || !after.is_curved()) return std::nullopt;
  const double end = before.along.to > before.along.from ? 1 : 0;
  const double begin = after.along.to > after.along.from ? 0 : 1;
  const dvec2 a = in_plane(geometry_.point(before.along.at(end)));
  const dvec2 b = in_plane(geometry_.point(after.along.at(begin)));
  if (glm::distance(a, b) > geometry_.tie()) return std::nullopt;
  double depth = 0;
  const auto see = [&](const EdgeStretch& along, double from, double to) {
    for (const dvec2& x : part_polygon(planar_curve(along.at(0)), from, to)) {
      depth = std::max(depth, distance_to_segment(x, across.x, after.x));
    }
  };
  see(before.along, before.along.to, end);
  see(after.along, begin, after.along.from);
  return depth <= width_ ? std::optional(depth) : std::nullopt;
}

/// Pieces of edges are followed to where they join.
void FlatBoundary::close_dents() {
  for (std::size_t k = 0; k < sides_.size() && sides_.size() > 2;) {
    const std::size_t before = (k + sides_.size() - 1) % sides_.size();
    const std::size_t after = next(k);
    const std::optional<double> depth = dent(sides_[before], sides_[k], sides_[after]);
    if (!depth) {
      ++k;
      continue;
    }
    off_ = std::max(off_, *depth);
    EdgeStretch& in = sides_[before].along;
    EdgeStretch& out = sides_[after].along;
    in.to = in.to > in.from ? 1 : 0;
    out.from = out.to > out.from ? 0 : 1;
    set_polygon(sides_[before]);
    set_polygon(sides_[after]);
    sides_[after].corner = geometry_.canonical(out.at(out.from));
    sides_[after].x = in_plane(geometry_.point(sides_[after].corner));
    sides_.erase(sides_.begin() + std::ptrdiff_t(k));
  }
}

/// Curved sides begin and end in their corners, but for elements that are one.
void FlatBoundary::see_corners() {
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const FlatSide& side = sides_[k];
    if (!side.is_curved()) continue;
    const auto see = [&](double t, const dvec2& corner) {
      off_ = std::max(off_, glm::distance(in_plane(geometry_.point(side.along.at(t))), corner));
    };
    see(side.along.from, side.x);
    see(side.along.to, sides_[next(k)].x);
  }
}

/// Of all sides, counter-clockwise.
std::vector<Tangent> FlatBoundary::tangents() const {
  std::vector<Tangent> result;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const FlatSide& side = sides_[k];
    if (!side.is_curved()) {
      result.push_back({outward(side.x, sides_[next(k)].x), side.x, side.corner, true});
      continue;
    }
    const double sense = side.along.to > side.along.from ? 1 : -1;
    for (int i = 0; i <= stretch_points; ++i) {
      const ContactJet jet = geometry_.jet(side.at(i));
      const dvec2 along = sense * in_plane(jet.dx[0]);
      if (!(glm::length(along) > 0)) continue;
      result.push_back({outward(dvec2(0), along), in_plane(jet.x), side.at(i), i == 0});
    }
  }
  return result;
}

/// How far the model is beyond a tangent, and where, if that is more than the resolution.
void FlatBoundary::ask(const Tangent& tangent) {
  const Support top = query_(unit(in_space(tangent.n)), tangent.at);
  const double rise = top.h_bound - glm::dot(tangent.x, tangent.n);
  const double off = rise > rounding_of_heights ? rise / std::cos(0.5 * most_turn) : rise;
  off_ = std::max(off_, off);
  if (off > rho_ + geometry_.tie()) beyond_.push_back(top.contact);
}

/// And, between two of them, beyond the corner in which the second one begins.
void FlatBoundary::ask_between(const Tangent& from, const Tangent& to) {
  double turn = std::atan2(cross(from.n, to.n), glm::dot(from.n, to.n));
  // Those of both sides of a sharp tip are half a turn but for rounding.
  if (turn < -0.5 * std::numbers::pi) turn += 2 * std::numbers::pi;
  const double start = std::atan2(from.n.y, from.n.x);
  const int parts = int(std::ceil(turn / most_turn));
  for (int i = 1; i < parts; ++i) {
    ask({direction_at(start + turn * i / parts), to.x, to.at});
  }
}

void FlatBoundary::ask_all() {
  const std::vector<Tangent> all = tangents();
  for (std::size_t k = 0; k < all.size(); ++k) {
    ask(all[k]);
    if (all[k].begins) ask_between(all[(k > 0 ? k : all.size()) - 1], all[k]);
  }
}

/// The side that is seen from along n.
HullFace FlatBoundary::facet() const {
  HullFace face;
  face.kind = FaceKind::facet;
  face.n = extent_.n;
  face.offset = extent_.middle + extent_.half_width;
  face.tolerant = std::max(2 * extent_.half_width, off_ > rounding_of_heights ? off_ : 0);
  const auto curved = [](const FlatSide& side) { return side.is_curved(); };
  const bool is_curved = std::any_of(sides_.begin(), sides_.end(), curved);
  for (const FlatSide& side : sides_) {
    face.contacts.push_back(side.corner);
    face.points.push_back(geometry_.point(side.corner));
    if (is_curved) face.sides.push_back(side.along);
  }
  return face;
}

bool FlatBoundary::has_area() const {
  return sides_.size() > 2 ||
         (!sides_.empty() && (sides_.front().is_curved() || sides_.back().is_curved()));
}

/// Of the places and curves, and what is beyond them; false without an area. Of places of faces
/// none is left out: they are as far apart as the resolution asks for.
bool FlatBoundary::find_sides(const std::vector<std::vector<dvec3>>& curves, bool with_faces) {
  std::vector<dvec2> points;
  points.reserve(corners_.size());
  for (const Contact& c : corners_) points.push_back(in_plane(geometry_.point(c)));
  sides_.clear();
  beyond_.clear();
  off_ = 0;
  take(planar_hull(points, curves, geometry_.stop()));
  if (!sides_.empty() && !with_faces) simplify();
  close_dents();
  if (!has_area()) return false;
  ask_all();
  return true;
}

std::optional<HullBoundary> FlatBoundary::make() {
  measure_across();
  collect();
  std::vector<std::vector<dvec3>> curves;
  curves.reserve(pieces_.size());
  for (const Contact& c : pieces_) curves.push_back(planar_curve(c));
  if (!find_sides(curves, false)) return std::nullopt;
  // Faces that fold reach beyond their borders.
  while (!beyond_.empty()) {
    corners_.insert(corners_.end(), beyond_.begin(), beyond_.end());
    if (corners_.size() > most_corners || !find_sides(curves, true)) return std::nullopt;
  }
  see_corners();
  HullBoundary boundary;
  boundary.frame = geometry_.scene().frame();
  boundary.dimension = 2;
  boundary.faces = {facet()};
  boundary.curves = flat_curves(geometry_, sides_);
  boundary.gap = boundary.faces.front().tolerant > 0 ? rho_ : 0;
  return boundary;
}

}  // namespace

std::optional<HullBoundary> flat_boundary(const ContactGeometry& geometry, SupportQuery& query,
                                          const FlatExtent& extent, double rho) {
  return FlatBoundary(geometry, query, extent, rho).make();
}

}  // namespace taut
