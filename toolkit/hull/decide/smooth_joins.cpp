#include "taut/hull/decide/smooth_joins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/poles.h"
#include "taut/bounds/scene_content.h"
#include "taut/core/tolerances.h"
#include "taut/surface/side_joins.h"

namespace taut {
namespace {

/// Places along a smooth join at which its kink is measured.
constexpr int kink_samples = 5;

/// The largest angle between directions at a vertex next to each other: what is across all of them
/// is off their plane's normal by twice their angles with the plane at most.
constexpr double surrounding_angle = 2 * std::numbers::pi / 3;

double sample(int k) { return (k + 0.5) / kink_samples; }

/// What meets others at some places: where, and the unit vectors along which it leaves.
struct Meeting {
  std::array<int, 2> source = {};  ///< instance, and face or edge
  std::array<dvec3, kink_samples> points = {};
  std::array<dvec3, kink_samples> inward = {};
};

struct Match {
  bool apart = false;  ///< not of one source
  double distance = 0, kink = 0;
  std::size_t a = 0, b = 0;
};

/// Pairs of those that go on into each other, each in one at most; of one source first, and the
/// nearest. Behind them
/// what is left goes on into any, as an equal of another that is not told twice.
struct Pairs {
  std::vector<Match> mutual;
  std::vector<Match> left;  ///< of a
  bool are_all(std::size_t count) const { return 2 * mutual.size() + left.size() == count; }
};

Pairs pairs(const std::vector<Meeting>& all) {
  std::vector<Match> found;
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      Match match{all[a].source != all[b].source, 0, 0, a, b};
      for (std::size_t k = 0; k < kink_samples; ++k) {
        match.distance =
            std::max(match.distance, glm::distance(all[a].points[k], all[b].points[k]));
        match.kink = std::max(match.kink, glm::length(all[a].inward[k] + all[b].inward[k]));
      }
      if (match.kink <= smooth_join_angle) found.push_back(match);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Match& x, const Match& y) {
    return std::tie(x.apart, x.distance, x.kink) < std::tie(y.apart, y.distance, y.kink);
  });
  std::vector<bool> taken(all.size(), false);
  Pairs result;
  for (const Match& match : found) {
    if (taken[match.a] || taken[match.b]) continue;
    taken[match.a] = taken[match.b] = true;
    result.mutual.push_back(match);
  }
  for (Match match : found) {
    if (taken[match.a] && taken[match.b]) continue;
    if (taken[match.a]) std::swap(match.a, match.b);
    taken[match.a] = true;
    result.left.push_back(match);
  }
  return result;
}

Meeting meeting_of(const ContactGeometry& geometry, const Contact& edge,
                   const ContactGeometry::PieceSide& side) {
  Meeting result;
  for (std::size_t k = 0; k < kink_samples; ++k) {
    const Contact c = on_side({edge.instance, edge.kind, edge.element, sample(int(k)), 0}, side);
    const ContactJet j = geometry.jet(c);
    const dvec3 along = unit(along_v(side.side) ? j.dx[1] : j.dx[0]);
    const dvec3 inward = inward_derivative(j, side.side);
    result.source = {c.instance, geometry.patch(c).face};
    result.points[k] = j.x;
    result.inward[k] = unit(inward - glm::dot(inward, along) * along);
  }
  return result;
}

/// The unit tangents along the sides that end in a corner of a patch; at a collapsed side along
/// both that end in it.
void add_tangents(const ContactGeometry& geometry, Contact corner, std::vector<dvec3>& tangents) {
  const auto side_at = [&](bool of_u) {
    const double at = of_u ? corner.u : corner.v;
    return of_u ? (at < 0.5 ? Side::u0 : Side::u1) : (at < 0.5 ? Side::v0 : Side::v1);
  };
  const auto is_point = [&](Side side) {
    return geometry.patch(corner).borders[std::size_t(side)].kind == BorderKind::collapsed;
  };
  const auto add = [&](Side side) {
    const dvec3 inward = unit(inward_derivative(geometry.jet(corner), side));
    if (inward != dvec3(0.0)) tangents.push_back(inward);
  };
  for (const bool of_u : {true, false}) {
    if (is_point(side_at(!of_u))) continue;
    add(side_at(of_u));
    if (!is_point(side_at(of_u))) continue;
    double& other = of_u ? corner.v : corner.u;
    other = 1 - other;
    add(side_at(of_u));
  }
}

}  // namespace

SmoothJoins::SmoothJoins(const ContactGeometry& geometry) : geometry_(geometry) {
  const Scene& scene = geometry.scene();
  const Model& model = scene.model();
  for (const SourceKind kind : {SourceKind::edge, SourceKind::vertex}) {
    for (const int i : scene.distinct_instances()) {
      const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
      const auto count = kind == SourceKind::edge ? part.pieces().size() : part.vertices().size();
      for (int k = 0; k < int(count); ++k) {
        const Contact c{i, kind, k, 0, 0};
        if (geometry.is_repeated(c)) continue;
        kind == SourceKind::edge ? pair_sides(c) : pair_ends(c);
      }
    }
  }
}

/// Of more than two, how two meet has been told; if they are all paired: else the edge remains.
void SmoothJoins::pair_sides(const Contact& edge) {
  if (geometry_.piece(edge).edge < 0 || geometry_.is_straight(edge)) return;
  std::vector<ContactGeometry::PieceSide> all;
  std::vector<Contact> patches;
  std::size_t count = 0;  // of copies, too
  for (const auto* list : {&geometry_.sides(edge), &geometry_.ruled_sides(edge)}) {
    count += list->size();
    for (const ContactGeometry::PieceSide& side : *list) {
      const int instance = side.instance < 0 ? edge.instance : side.instance;
      const Contact patch{instance, SourceKind::face, side.patch, 0, 0};
      if (geometry_.is_repeated(patch) || geometry_.patch(patch).repeats >= 0) continue;
      all.push_back(side);
      patches.push_back(patch);
    }
  }
  if (count <= 2) return;
  std::vector<Meeting> meetings;
  meetings.reserve(all.size());
  for (const auto& side : all) meetings.push_back(meeting_of(geometry_, edge, side));
  const Pairs found = pairs(meetings);
  // Ruled patches have no contacts of their own.
  const auto is_ruled = [&](const Match& match) {
    return geometry_.is_ruled(patches[match.a]) && geometry_.is_ruled(patches[match.b]);
  };
  if (!found.are_all(all.size()) ||
      std::any_of(found.mutual.begin(), found.mutual.end(), is_ruled) ||
      std::any_of(found.left.begin(), found.left.end(), is_ruled)) {
    return;
  }
  passed_.insert({edge.kind, edge.instance, edge.element});
  const auto add = [&](std::size_t from, const Contact& to, const Match& match) {
    const std::size_t other = from == match.a ? match.b : match.a;
    sides_[{patches[from].instance, patches[from].element, all[from].side}] = {
        {to, all[other].side, all[from].reversed != all[other].reversed}, match.kink};
  };
  for (const Match& match : found.mutual) {
    add(match.a, patches[match.b], match);
    add(match.b, patches[match.a], match);
  }
  for (const Match& match : found.left) add(match.a, {}, match);
}

void SmoothJoins::pair_ends(const Contact& vertex) {
  std::vector<ContactGeometry::PieceEnd> all;
  const bool several = geometry_.ends(vertex).size() > 2;  // of two it has been told
  bool any_passed = false;
  for (const ContactGeometry::PieceEnd& end : geometry_.ends(vertex)) {
    const Contact piece = piece_end(vertex, end);
    if (geometry_.is_repeated(piece)) continue;
    any_passed = any_passed || passes(piece);
    // Straight ones have no contacts but where curves pass; along smooth ones these are patches'.
    if (geometry_.is_straight(piece) || is_smooth(piece)) continue;
    all.push_back(end);
  }
  if (any_passed ? is_surrounded(vertex) : several && all.size() > 1 && join(vertex, all)) {
    passed_.insert({vertex.kind, vertex.instance, vertex.element});
  }
}

/// Pairs ends of curves. Whether none is left.
bool SmoothJoins::join(const Contact& vertex, const std::vector<ContactGeometry::PieceEnd>& all) {
  std::vector<Contact> pieces;
  std::vector<Meeting> meetings;
  for (const ContactGeometry::PieceEnd& end : all) {
    pieces.push_back(piece_end(vertex, end));
    Meeting& meeting = meetings.emplace_back();
    meeting.source = {pieces.back().instance, geometry_.piece(pieces.back()).edge};
    meeting.points.fill(geometry_.point(pieces.back()));
    meeting.inward.fill(unit(tangent_from(geometry_, vertex, end)));
  }
  const Pairs found = pairs(meetings);
  if (!found.are_all(pieces.size())) return false;
  const auto add = [&](const Contact& from, const Contact& to) {
    ends_[{from.instance, from.element, int(from.u)}] = {to, int(to.u)};
  };
  for (const Match& match : found.mutual) {
    add(pieces[match.a], pieces[match.b]);
    add(pieces[match.b], pieces[match.a]);
  }
  return true;
}

/// Edges and patches leave in one plane to all sides, and the edges are straight or smooth: planes
/// that touch are that plane.
bool SmoothJoins::is_surrounded(const Contact& vertex) const {
  std::vector<dvec3> tangents;
  for (const ContactGeometry::PieceEnd& end : geometry_.ends(vertex)) {
    const Contact piece = piece_end(vertex, end);
    if (geometry_.is_repeated(piece)) continue;
    if (!is_smooth(piece) && !geometry_.is_straight(piece)) return false;
    tangents.push_back(unit(tangent_from(geometry_, vertex, end)));
    for (const auto* list : {&geometry_.sides(piece), &geometry_.ruled_sides(piece)}) {
      for (const ContactGeometry::PieceSide& side : *list) {
        add_tangents(geometry_, on_side(piece, side), tangents);
      }
    }
  }
  if (tangents.empty()) return false;
  dvec3 normal(0.0);
  for (const dvec3& t : tangents) {
    const dvec3 across = glm::cross(tangents.front(), t);
    if (glm::length(across) > glm::length(normal)) normal = across;
  }
  normal = unit(normal);
  const auto [x, y] = tangent_frame(normal);
  std::vector<double> angles;
  for (const dvec3& t : tangents) {
    if (!(std::abs(glm::dot(t, normal)) <= smooth_join_angle)) return false;
    angles.push_back(std::atan2(glm::dot(t, y), glm::dot(t, x)));
  }
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2 * std::numbers::pi);
  for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
    if (angles[k + 1] - angles[k] > surrounding_angle) return false;
  }
  return true;
}

/// At as many places as tell whether there is none (JoinSmoothness::is_smooth), the ends among
/// them, where what vanishes at some places between is largest.
double SmoothJoins::measured_kink(const Contact& face, taut::Side side,
                                  const Border& border) const {
  const Contact beyond{face.instance, face.kind, border.neighbor, 0, 0};
  const auto degree = [&](const Contact& c, taut::Side of) {
    const BezierPatch& patch = geometry_.patch(c).bezier;
    return along_v(of) ? patch.degree_v : patch.degree_u;
  };
  const int last = 4 * std::max(degree(face, side), degree(beyond, border.neighbor_side)) - 2;
  double largest = 0;
  for (int k = 0; k <= last; ++k) {
    const double t = sample_parameter(k, last);
    const dvec3 own = unit_normal(geometry_, on_side(face.instance, face.element, side, t));
    const dvec3 other = unit_normal(
        geometry_,
        on_side(face.instance, border.neighbor, border.neighbor_side, border.reversed ? 1 - t : t));
    largest = std::max(largest, glm::length(glm::cross(own, other)));
  }
  return largest;
}

std::optional<SmoothJoins::Side> SmoothJoins::beyond(const Contact& face, taut::Side side) const {
  const Border& border = geometry_.patch(face).borders[std::size_t(side)];
  if (border.kind == BorderKind::smooth) {
    return Side{
        {face.instance, face.kind, border.neighbor, 0, 0}, border.neighbor_side, border.reversed};
  }
  const auto found = sides_.find({face.instance, face.element, side});
  return found == sides_.end() ? std::nullopt : std::optional(found->second.beyond);
}

double SmoothJoins::kink(const Contact& face, taut::Side side) {
  const Border& border = geometry_.patch(face).borders[std::size_t(side)];
  if (border.kind != BorderKind::smooth) {
    const auto found = sides_.find({face.instance, face.element, side});
    return found == sides_.end() ? 0 : found->second.kink;
  }
  const int part = geometry_.scene().content().instances[std::size_t(face.instance)].part;
  const std::array own = {part, face.element, int(side)};
  const std::array other = {part, border.neighbor, int(border.neighbor_side)};
  const auto [known, is_new] = measured_.try_emplace(std::min(own, other), 0);
  if (is_new) known->second = measured_kink(face, side, border);
  return known->second;
}

std::optional<SmoothJoins::End> SmoothJoins::beyond(const Contact& piece, int end) const {
  const auto found = ends_.find({piece.instance, piece.element, end});
  return found == ends_.end() ? std::nullopt : std::optional(found->second);
}

double SmoothJoins::kink(const Contact& piece, int end) const {
  const auto leaving = [&](const Contact& c, int at) {
    std::vector<dvec4> p = geometry_.curve(c).points;
    if (at == 1) std::reverse(p.begin(), p.end());
    dvec3 way(0.0);
    for (std::size_t k = 1; k < p.size() && way == dvec3(0.0); ++k) {
      way = euclidean(p[k]) - euclidean(p[0]);
    }
    return unit(way);
  };
  const auto angle = [&](const Contact& other, int at) {
    return glm::length(leaving(piece, end) + leaving(other, at));
  };
  if (const std::optional<End> other = beyond(piece, end)) return angle(other->piece, other->end);
  const int next = geometry_.piece(piece).end_neighbor[std::size_t(end)];
  if (next < 0) return 0;
  // Where both its ends meet the piece, the one that goes on straighter is meant.
  double least = infinity;
  const Contact other{piece.instance, piece.kind, next, 0, 0};
  for (const int far : {0, 1}) {
    if (geometry_.piece(other).end_neighbor[std::size_t(far)] != piece.element) continue;
    if (next == piece.element && far == end) continue;
    least = std::min(least, angle(other, far));
  }
  return least < infinity ? least : 0;
}

}  // namespace taut
