#include "taut/hull/contact/contact_exits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

/// The patch's contact at a side, where the side's free parameter is t.
Contact on_side(int instance, int patch, Side side, double t) {
  const dvec2 uv = taut::on_side(side, t);
  return {instance, SourceKind::face, patch, uv.x, uv.y};
}

Contact on_side(const Contact& edge, const ContactGeometry::PieceSide& side) {
  return on_side(side.instance < 0 ? edge.instance : side.instance, side.patch, side.side,
                 side.reversed ? 1 - edge.u : edge.u);
}

/// The patch's derivative across the side, into the patch.
dvec3 inward(const ContactJet& j, Side side) {
  const dvec3& d = j.dx[along_v(side) ? 0 : 1];
  return at_upper_end(side) ? -d : d;
}

/// Sine of the angle that a vector makes with the plane across n; zero of a zero vector.
double elevation(const dvec3& v, const dvec3& n) {
  const double length = glm::length(v);
  return length > 0 ? glm::dot(v, n) / length : 0;
}

/// The vertex as the end of a piece.
Contact at_end(const Contact& vertex, const ContactGeometry::PieceEnd& end) {
  return {end.instance < 0 ? vertex.instance : end.instance, SourceKind::edge, end.piece,
          double(end.end), 0};
}

/// The edge's tangent at the end of the piece, away from the end.
dvec3 leaving(const ContactGeometry& geometry, const Contact& vertex,
              const ContactGeometry::PieceEnd& end) {
  const ContactJet j = geometry.jet(at_end(vertex, end));
  return end.end == 0 ? j.dx[0] : -j.dx[0];
}

std::optional<Contact> beyond_side(const ContactGeometry& geometry, const Contact& c, Side side) {
  const Border& border = geometry.patch(c).borders[std::size_t(side)];
  const double t = std::clamp(along_v(side) ? c.v : c.u, 0.0, 1.0);
  if (border.piece >= 0) {
    return Contact{c.instance, SourceKind::edge, border.piece, border.piece_reversed ? 1 - t : t,
                   0};
  }
  if (border.kind == BorderKind::smooth) {
    return on_side(c.instance, border.neighbor, border.neighbor_side, border.reversed ? 1 - t : t);
  }
  if (border.vertex >= 0) return Contact{c.instance, SourceKind::vertex, border.vertex, 0, 0};
  return std::nullopt;
}

std::optional<Contact> beyond_end(const ContactGeometry& geometry, const Contact& c, int end) {
  const EdgePiece& piece = geometry.piece(c);
  if (const int vertex = piece.end_vertex[std::size_t(end)]; vertex >= 0) {
    return Contact{c.instance, SourceKind::vertex, vertex, 0, 0};
  }
  const int next = piece.end_neighbor[std::size_t(end)];
  if (next < 0) return std::nullopt;
  // The end at which the neighbour goes on: the one that is nearer to this one's.
  const dvec3 here = geometry.point({c.instance, SourceKind::edge, c.element, double(end), 0});
  const auto distance = [&](double t) {
    return glm::distance(geometry.point({c.instance, SourceKind::edge, next, t, 0}), here);
  };
  double t = distance(0) <= distance(1) ? 0 : 1;
  if (next == c.element) t = 1 - end;
  return Contact{c.instance, SourceKind::edge, next, t, 0};
}

/// Pieces of an edge in a row.
constexpr int run_limit = 64;
/// A contact whose parameter is so near to a collapsed side is at the pole.
constexpr double pole_parameter = 1e-9;
/// How near to a pole, as a parameter, a climb in the direction of its normal need not go on.
constexpr double about_pole = 1e-5;
/// Parameters about a pole that are tried for the steepest way up, a patch.
constexpr int pole_samples = 8;
/// How far from a pole a climb begins at most.
constexpr double off_pole = 0.3;
/// A contact is at a pole for good if n is the pole's normal to within this.
constexpr double pole_angle = 1e-8;

/// From a pole whose normal is not n, a start of a climb on the steepest way up among all patches
/// about it, at the maximum of the parabola along it. None at a vertex of another kind, and where
/// no way leads up.
std::optional<Contact> way_off_pole(const ContactGeometry& geometry, const Contact& c,
                                    const dvec3& n) {
  const dvec3 x = geometry.point(c);
  const std::vector<Patch>& patches = geometry.part(c).patches();
  std::optional<Contact> best;
  double steepest = 0;
  for (int p = 0; p < int(patches.size()); ++p) {
    for (const Side side : all_sides) {
      if (!is_pole(geometry, {c.instance, SourceKind::face, p, 0, 0}, side)) continue;
      if (glm::distance(geometry.point(on_side(c.instance, p, side, 0.5)), x) > join_distance) {
        continue;
      }
      for (int k = 0; k <= pole_samples; ++k) {
        Contact at = on_side(c.instance, p, side, double(k) / pole_samples);
        const ContactJet j = geometry.jet(at);
        const dvec3 away = inward(j, side);
        const double slope = elevation(away, n);
        if (slope <= steepest) continue;
        const double second = glm::dot(along_v(side) ? j.dxx : j.dyy, n);
        const double rise = glm::dot(away, n);
        const double step = second < 0 ? std::min(-rise / second, off_pole) : off_pole;
        (along_v(side) ? at.u : at.v) = at_upper_end(side) ? 1 - step : step;
        steepest = slope;
        best = at;
      }
    }
  }
  return best;
}

/// Climbs; one element at a time.
class Climb {
 public:
  Climb(const ContactGeometry& geometry, const Contact& c, const dvec3& n)
      : geometry_(geometry), c_(c), n_(n) {}

  std::optional<Contact> run() {
    if (c_.kind == SourceKind::face && geometry_.is_ruled(c_)) c_ = at_rest(geometry_, c_, n_);
    for (int k = 0; k < step_limit; ++k) {
      const Progress progress = c_.kind == SourceKind::face   ? on_face()
                                : c_.kind == SourceKind::edge ? on_edge()
                                                              : at_vertex();
      if (progress == Progress::arrived) return c_;
      if (progress == Progress::lost) return std::nullopt;
    }
    return is_on_top() ? std::optional(c_) : std::nullopt;
  }

 private:
  enum class Progress { moved, arrived, lost };
  static constexpr int step_limit = 60;
  /// Steps of the point shorter than this end the climb; the maximum is flat there.
  static constexpr double short_step = 1e-13;
  /// Steps shorter than this that do not get shorter are rounding, which poles magnify.
  static constexpr double noise_step = 1e-9;
  /// Slopes below this are rounding.
  static constexpr double flat = 1e-13;
  /// Normal curvature from which on a level point is a minimum.
  static constexpr double bent = 1e-9;
  /// Beside the tangents' own length: those about a pole are as short as they like, their rounding
  /// is not.
  static constexpr double small_tangent = 0.01;
  /// Share of a patch that steps may take where the value is not concave.
  static constexpr double stride = 0.2;

  /// What rounding may leave of a level tangent's slope, by the tangent's length.
  double slack(double size) const { return flat * size + geometry_.rounding(); }
  bool is_bent(double second, double size) const {
    return second > bent * size * size + geometry_.rounding();
  }
  /// On an edge, to within rounding: near an inflection that makes steps without end.
  bool is_on_top() const {
    if (c_.kind != SourceKind::edge) return false;
    const ContactJet j = geometry_.jet(c_);
    const double size = glm::length(j.dx[0]);
    return std::abs(glm::dot(j.dx[0], n_)) <= slack(size) && is_bent(-glm::dot(j.dxx, n_), size);
  }
  bool rises(const dvec3& tangent) const {
    return glm::dot(tangent, n_) > slack(glm::length(tangent));
  }

  Progress leave(const ContactExit& exit) {
    const std::optional<Contact> next = beyond(geometry_, c_, exit);
    if (!next) return Progress::lost;
    c_ = *next;
    return Progress::moved;
  }

  Progress on_face() {
    if (at_its_pole()) return Progress::arrived;
    const ContactJet j = geometry_.jet(c_);
    const dvec2 slope(glm::dot(j.dx[0], n_), glm::dot(j.dx[1], n_));
    const dvec2 size(glm::length(j.dx[0]), glm::length(j.dx[1]));
    dvec2 at(c_.u, c_.v);
    for (int a = 0; a < 2; ++a) {
      const bool low = at[a] <= 0 && slope[a] < -slack(size[a] + small_tangent);
      const bool high = at[a] >= 1 && slope[a] > slack(size[a] + small_tangent);
      if (!low && !high) continue;
      const Side side = a == 0 ? (low ? Side::u0 : Side::u1) : (low ? Side::v0 : Side::v1);
      if (is_pole(geometry_, c_, side)) return off_the_pole();
      return leave({ContactExit::Kind::side, int(side)});
    }
    const double uu = glm::dot(j.dxx, n_);
    const double uv = glm::dot(j.dxy, n_);
    const double vv = glm::dot(j.dyy, n_);
    dvec2 step(0.0);
    const double det = uu * vv - uv * uv;
    if (uu < 0 && det > geometry_.rounding() * std::abs(uu + vv)) {
      step = {(uv * slope.y - vv * slope.x) / det, (uv * slope.x - uu * slope.y) / det};
    } else {
      for (int a = 0; a < 2; ++a) {
        if (size[a] == 0) continue;
        const double second = a == 0 ? uu : vv;
        // Where the value is not concave, far, off a minimum too; where it is flat, nowhere.
        const bool level = std::abs(slope[a]) <= slack(size[a] + small_tangent) &&
                           !is_bent(std::abs(second), size[a]);
        step[a] = level ? 0 : second < 0 ? -slope[a] / second : std::copysign(stride, slope[a]);
      }
    }
    // On a border that the slope does not lead over.
    for (int a = 0; a < 2; ++a) {
      if (step[a] != 0 && room_for(a, step[a]) <= 0) step[a] = 0;
    }
    for (int a = 0; a < 2; ++a) {
      const double room = step[a] < 0 ? at[a] : 1 - at[a];
      if (step[a] != 0 && at_pole(a, step[a]) && room < pole_parameter) return off_the_pole();
    }
    const double length = glm::length(step * size);
    const bool noise = length < noise_step && length > 0.5 * last_length_;
    last_length_ = length;
    if (length <= short_step || noise) {
      return pole_side(geometry_, c_) ? off_the_pole() : Progress::arrived;
    }
    const double longest = std::max(std::abs(step.x), std::abs(step.y));
    if (longest > 0.5) step *= 0.5 / longest;
    double share = 1;
    for (int a = 0; a < 2; ++a) {
      const double room = room_for(a, step[a]);
      if (std::abs(step[a]) > room) share = std::min(share, room / std::abs(step[a]));
    }
    for (int a = 0; a < 2; ++a) {
      const double room = room_for(a, step[a]);
      // The same quotient: the product may be rounded to less than the room.
      const bool meets = std::abs(step[a]) > room && room / std::abs(step[a]) <= share;
      at[a] = meets && !at_pole(a, step[a]) ? (step[a] < 0 ? 0.0 : 1.0)
                                            : std::clamp(at[a] + share * step[a], 0.0, 1.0);
    }
    const bool still = share * glm::length(step * size) <= short_step;
    c_.u = at.x;
    c_.v = at.y;
    return still && ++stuck_ > 4 ? Progress::lost : Progress::moved;
  }

  /// About a pole whose normal is n: moves there. Parameters are of no use so near to it.
  bool at_its_pole() {
    for (const Side side : all_sides) {
      const double t = along_v(side) ? c_.u : c_.v;
      if ((at_upper_end(side) ? 1 - t : t) > about_pole || !is_pole(geometry_, c_, side)) continue;
      const Contact pole = at_exit(c_, {ContactExit::Kind::side, int(side)});
      const double least = std::max(pole_angle, 2 * pole_turn(geometry_, pole));
      if (glm::length(glm::cross(unit_normal(geometry_, pole), n_)) >= least) continue;
      c_ = pole;
      return true;
    }
    return false;
  }
  /// At a pole: arrived, unless it is not the maximum.
  Progress off_the_pole() {
    if (left_pole_) return Progress::lost;
    const dvec3 normal = unit_normal(geometry_, c_);
    const double least = std::max(pole_angle, 2 * pole_turn(geometry_, c_));
    if (glm::length(glm::cross(normal, n_)) < least) return Progress::arrived;
    const std::optional<Contact> start = way_off_pole(geometry_, c_, n_);
    if (!start) return Progress::lost;
    left_pole_ = true;
    c_ = *start;
    return Progress::moved;
  }
  bool at_pole(int parameter, double step) const {
    const Side side =
        parameter == 0 ? (step < 0 ? Side::u0 : Side::u1) : (step < 0 ? Side::v0 : Side::v1);
    return is_pole(geometry_, c_, side);
  }
  /// How far a step may go: to the border, but only most of the way to a pole, where the parameters
  /// fail.
  double room_for(int parameter, double step) const {
    const double at = parameter == 0 ? c_.u : c_.v;
    const double room = step < 0 ? at : 1 - at;
    return at_pole(parameter, step) ? 0.95 * room : room;
  }

  Progress on_edge() {
    const ContactJet j = geometry_.jet(c_);
    const double slope = glm::dot(j.dx[0], n_);
    const double size = glm::length(j.dx[0]);
    if (c_.u <= 0 && slope < -slack(size)) return leave({ContactExit::Kind::end, 0});
    if (c_.u >= 1 && slope > slack(size)) return leave({ContactExit::Kind::end, 1});
    const double second = glm::dot(j.dxx, n_);
    const bool level = std::abs(slope) <= slack(size) && !is_bent(std::abs(second), size);
    double step = level ? 0 : second < 0 ? -slope / second : std::copysign(stride, slope);
    step = std::clamp(step, -0.5, 0.5);
    const double to = std::clamp(c_.u + step, 0.0, 1.0);
    const bool to_end = to != c_.u && (to == 0 || to == 1);
    const double length = std::abs(to - c_.u) * size;
    const bool noise = length < noise_step && length > 0.5 * last_length_;
    last_length_ = length;
    if ((length > short_step && !noise) || to_end) {
      c_.u = to;
      return Progress::moved;
    }
    const bool straight = geometry_.is_straight(c_);
    if (!straight && std::abs(slope) > slack(size) && second >= 0) return Progress::lost;
    const auto& sides = geometry_.sides(c_);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const dvec3 c = inward(geometry_.jet(on_side(c_, sides[k])), sides[k].side);
      if (rises(c)) return leave({ContactExit::Kind::face, int(k)});
    }
    if (!straight) return Progress::arrived;
    // Level: its ends are as high.
    c_ = geometry_.straight_end(c_, c_.u < 0.5 ? 0 : 1);
    return Progress::moved;
  }

  Progress at_vertex() {
    const auto& ends = geometry_.ends(c_);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      // The other end of a straight edge is a contact of its own.
      if (geometry_.is_straight(at_end(c_, ends[k]))) continue;
      if (rises(leaving(geometry_, c_, ends[k]))) {
        return leave({ContactExit::Kind::edge, int(k)});
      }
    }
    return Progress::arrived;
  }

  const ContactGeometry& geometry_;
  Contact c_;
  dvec3 n_;
  int stuck_ = 0;
  bool left_pole_ = false;
  double last_length_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<ContactExit> exits(const ContactGeometry& geometry, const Contact& c) {
  using Kind = ContactExit::Kind;
  std::vector<ContactExit> result;
  const auto add = [&](Kind kind, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) result.push_back({kind, int(k)});
  };
  if (c.kind == SourceKind::face) {
    add(Kind::side, 4);
  } else if (c.kind == SourceKind::edge) {
    add(Kind::end, 2);
    add(Kind::face, geometry.sides(c).size());
  } else {
    // Across a straight edge its other end takes over.
    const std::vector<ContactGeometry::PieceEnd>& ends = geometry.ends(c);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (!geometry.is_straight(at_end(c, ends[k]))) {
        result.push_back({Kind::edge, int(k)});
      }
    }
  }
  return result;
}

LinearEquation exit_margin(const ContactGeometry& geometry, const CommonSupport& s, int i,
                           const ContactExit& exit) {
  const Contact& c = s.contact[std::size_t(i)];
  LinearEquation e;
  dvec2& parameter = e.parameter[std::size_t(i)];
  if (exit.kind == ContactExit::Kind::side) {
    const Side side = all_sides[std::size_t(exit.index)];
    const int a = along_v(side) ? 0 : 1;
    const double value = a == 0 ? c.u : c.v;
    e.residual = at_upper_end(side) ? 1 - value : value;
    parameter[a] = at_upper_end(side) ? -1 : 1;
  } else if (exit.kind == ContactExit::Kind::end) {
    e.residual = exit.index == 0 ? c.u : 1 - c.u;
    parameter.x = exit.index == 0 ? 1 : -1;
  } else if (exit.kind == ContactExit::Kind::face) {
    const ContactGeometry::PieceSide& side = geometry.sides(c)[std::size_t(exit.index)];
    const ContactJet j = geometry.jet(on_side(c, side));
    const dvec3 in = inward(j, side.side);
    const double length = glm::length(in);
    if (length == 0) return e;
    e.n = -in / length;
    e.residual = glm::dot(e.n, s.n);
    const double sense = (side.reversed ? -1.0 : 1.0) * (at_upper_end(side.side) ? -1.0 : 1.0);
    parameter.x = -sense * glm::dot(j.dxy, s.n) / length;
  } else {
    const ContactGeometry::PieceEnd& end = geometry.ends(c)[std::size_t(exit.index)];
    const dvec3 away = leaving(geometry, c, end);
    const double length = glm::length(away);
    if (length == 0) return e;
    e.n = -away / length;
    e.residual = glm::dot(e.n, s.n);
  }
  return e;
}

double exit_length(const ContactGeometry& geometry, const Contact& c, const ContactExit& exit) {
  switch (exit.kind) {
    case ContactExit::Kind::side:
      return glm::length(geometry.jet(c).dx[along_v(all_sides[std::size_t(exit.index)]) ? 0 : 1]);
    case ContactExit::Kind::end:
      return glm::length(geometry.jet(c).dx[0]);
    case ContactExit::Kind::face: {
      const ContactGeometry::PieceSide& side = geometry.sides(c)[std::size_t(exit.index)];
      return glm::length(inward(geometry.jet(on_side(c, side)), side.side));
    }
    case ContactExit::Kind::edge:
      return glm::length(leaving(geometry, c, geometry.ends(c)[std::size_t(exit.index)]));
  }
  return 0;
}

bool extends_over(const ContactGeometry& geometry, const CommonSupport& s, int i,
                  const ContactExit& exit) {
  const auto k = std::size_t(i);
  const LinearEquation e = exit_margin(geometry, s, i, exit);
  const dvec3 inward = i == 0 ? s.d() : -s.d();
  const std::optional<dvec2> rate = parameter_rate(s.jet[k], s.n, inward);
  return rate && glm::dot(e.parameter[k], *rate) < 0;
}

bool leads_over_border(const ContactExit& exit) {
  return exit.kind == ContactExit::Kind::side || exit.kind == ContactExit::Kind::end;
}

bool stands_at(const Contact& c, const ContactExit& exit) {
  const Contact at = at_exit(c, exit);
  return at.u == c.u && at.v == c.v;
}

Contact at_exit(Contact c, const ContactExit& exit) {
  if (exit.kind == ContactExit::Kind::side) {
    const Side side = all_sides[std::size_t(exit.index)];
    (along_v(side) ? c.u : c.v) = at_upper_end(side) ? 1 : 0;
  } else if (exit.kind == ContactExit::Kind::end) {
    c.u = exit.index;
  }
  return c;
}

std::optional<Contact> beyond(const ContactGeometry& geometry, const Contact& c,
                              const ContactExit& exit) {
  const auto first = [&](const std::optional<Contact>& over) {
    return over ? std::optional(geometry.first(*over)) : std::nullopt;
  };
  switch (exit.kind) {
    case ContactExit::Kind::side:
      return first(beyond_side(geometry, c, all_sides[std::size_t(exit.index)]));
    case ContactExit::Kind::end:
      return first(beyond_end(geometry, c, exit.index));
    case ContactExit::Kind::face:
      return on_side(c, geometry.sides(c)[std::size_t(exit.index)]);
    case ContactExit::Kind::edge: {
      const ContactGeometry::PieceEnd& end = geometry.ends(c)[std::size_t(exit.index)];
      return at_end(c, end);
    }
  }
  return std::nullopt;
}

std::vector<Contact> piece_ends(const ContactGeometry& geometry, const Contact& vertex) {
  std::vector<Contact> result;
  for (const ContactGeometry::PieceEnd& end : geometry.ends(vertex)) {
    result.push_back(at_end(vertex, end));
  }
  return result;
}

bool found_on_edge(
    const ContactGeometry& geometry, const Contact& from,
    const std::function<EdgeVisit(const Contact& begin, const Contact& end)>& visit) {
  std::optional<Contact> at = from;
  for (int k = 0; k < run_limit && at && at->kind == SourceKind::edge; ++k) {
    Contact end = *at;
    end.u = at->u < 0.5 ? 1 : 0;
    const EdgeVisit answer = visit(*at, end);
    if (answer != EdgeVisit::on) return answer == EdgeVisit::found;
    at = beyond(geometry, end, {ContactExit::Kind::end, int(end.u)});
  }
  return false;
}

bool is_pole(const ContactGeometry& geometry, const Contact& c, Side side) {
  const Border& border = geometry.patch(c).borders[std::size_t(side)];
  return border.kind == BorderKind::collapsed && border.vertex < 0;
}

dvec3 unit_normal(const ContactGeometry& geometry, const Contact& c) {
  return geometry.to_frame(c.instance, unit_normal(geometry.patch(c).bezier, c.u, c.v));
}

std::optional<Side> pole_side(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    const double t = along_v(side) ? c.u : c.v;
    if ((at_upper_end(side) ? 1 - t : t) < pole_parameter && is_pole(geometry, c, side))
      return side;
  }
  return std::nullopt;
}

std::optional<Side> collapsed_side(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    const double t = along_v(side) ? c.u : c.v;
    const Border& border = geometry.patch(c).borders[std::size_t(side)];
    const bool there = (at_upper_end(side) ? 1 - t : t) < pole_parameter;
    if (there && border.kind == BorderKind::collapsed) return side;
  }
  return std::nullopt;
}

double pole_turn(const ContactGeometry& geometry, const Contact& pole) {
  const std::optional<Side> side = pole_side(geometry, pole);
  if (!side) return 0;
  const double size = glm::length(geometry.jet(pole).dx[along_v(*side) ? 0 : 1]);
  return size > 0 ? geometry.rounding() / size : 0;
}

std::optional<Contact> beside_pole(const ContactGeometry& geometry, const Contact& pole,
                                   const dvec3& n) {
  const std::optional<Contact> start = way_off_pole(geometry, pole, n);
  return start ? climbed(geometry, *start, n) : std::nullopt;
}

Contact at_rest(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  Contact own = geometry.canonical(c);
  const auto move_to_end = [&](const Contact& low, const Contact& high) {
    const dvec3 x = geometry.point(own);
    const dvec3 to_low = geometry.point(low) - x;
    const dvec3 to_high = geometry.point(high) - x;
    const double rise = glm::dot(to_high - to_low, n);
    const bool level = std::abs(rise) <= geometry.tie();
    const bool nearer_to_high = glm::length(to_high) <= glm::length(to_low);
    own = geometry.canonical((level ? nearer_to_high : rise > 0) ? high : low);
  };
  const Part& part = geometry.part(own);
  for (std::size_t k = 0; own.kind == SourceKind::face; ++k) {
    const PatchPoint at{own.element, {own.u, own.v}};
    const std::vector<std::array<dvec2, 2>> all = rulings(geometry.patch(own), at.uv);
    if (k >= all.size()) break;
    const dvec3 along =
        unit(point(part, {at.patch, all[k][1]}) - point(part, {at.patch, all[k][0]}));
    const auto last = [&](const dvec3& direction) {
      const std::vector<PatchPoint> path = ruling_path(part, at, direction);
      const PatchPoint end = path.empty() ? at : path.back();
      return Contact{own.instance, own.kind, end.patch, end.uv.x, end.uv.y};
    };
    move_to_end(last(-along), last(along));
  }
  if (own.kind == SourceKind::edge && geometry.is_straight(own)) {
    move_to_end(geometry.straight_end(own, 0), geometry.straight_end(own, 1));
  }
  return own;
}

Contact moved_to_border(const ContactGeometry& geometry, Contact c, double distance) {
  const ContactJet j = geometry.jet(c);
  // Along a pole all parameters are its point, and the one that is there tells where from.
  const std::optional<Side> pole = pole_side(geometry, c);
  const auto snap = [&](double& t, const dvec3& dx) {
    const double nearest = std::round(std::clamp(t, 0.0, 1.0));
    if (std::abs(t - nearest) * glm::length(dx) <= distance) t = nearest;
  };
  if (j.dimension == 2 && !(pole && along_v(*pole))) snap(c.v, j.dx[1]);
  if (j.dimension >= 1 && !(pole && !along_v(*pole))) snap(c.u, j.dx[0]);
  return c;
}

Contact snapped(const ContactGeometry& geometry, const Contact& c, double distance) {
  return geometry.canonical(moved_to_border(geometry, c, distance));
}

Contact turned_to(const ContactGeometry& geometry, Contact c, const Contact& beside) {
  const std::optional<Side> side = collapsed_side(geometry, c);
  if (side) (along_v(*side) ? c.v : c.u) = along_v(*side) ? beside.v : beside.u;
  return c;
}

std::optional<Contact> expressed_in(const ContactGeometry& geometry, const Contact& c,
                                    const Contact& other) {
  if (c.instance != other.instance) return std::nullopt;
  if (same_element(c, other)) return turned_to(geometry, c, other);
  const auto found = [&](const std::optional<Contact>& next) {
    const bool own = next && same_element(*next, other);
    return own ? std::optional(turned_to(geometry, *next, other)) : std::nullopt;
  };
  if (c.kind == SourceKind::vertex) {
    for (const ContactGeometry::PieceEnd& end : geometry.ends(c)) {
      const Contact at = at_end(c, end);
      if (const auto next = found(at)) return next;
      if (const auto next = found(expressed_in(geometry, at, other))) return next;
    }
    if (other.kind != SourceKind::face) return std::nullopt;
    for (const Side side : all_sides) {
      if (geometry.patch(other).borders[std::size_t(side)].vertex != c.element) continue;
      return on_side(c.instance, other.element, side, along_v(side) ? other.v : other.u);
    }
    const std::array<int, 4>& corners = geometry.patch(other).corner_vertex;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k] != c.element) continue;
      return Contact{c.instance, other.kind, other.element, k < 2 ? 0.0 : 1.0,
                     k % 2 == 0 ? 0.0 : 1.0};
    }
    return std::nullopt;
  }
  for (const ContactExit& exit : exits(geometry, c)) {
    if (!stands_at(c, exit)) continue;
    if (const auto next = found(beyond(geometry, c, exit))) return next;
  }
  for (const Contact& at : about(geometry, c)) {
    if (const auto next = found(at)) return next;
  }
  return std::nullopt;
}

std::optional<Contact> climbed(const ContactGeometry& geometry, Contact c, const dvec3& n) {
  c.u = std::clamp(c.u, 0.0, 1.0);
  c.v = std::clamp(c.v, 0.0, 1.0);
  return Climb(geometry, geometry.canonical(c), n).run();
}

}  // namespace taut
