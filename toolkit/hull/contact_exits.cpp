#include "taut/hull/contact_exits.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

bool across_u(Side side) { return side == Side::u0 || side == Side::u1; }
bool at_end(Side side) { return side == Side::u1 || side == Side::v1; }

/// The patch's contact at a side, where the side's free parameter is t.
Contact on_side(int instance, int patch, Side side, double t) {
  const double fixed = at_end(side) ? 1 : 0;
  return across_u(side) ? Contact{instance, SourceKind::face, patch, fixed, t}
                        : Contact{instance, SourceKind::face, patch, t, fixed};
}

Contact on_side(const Contact& edge, const ContactGeometry::PieceSide& side) {
  return on_side(edge.instance, side.patch, side.side, side.reversed ? 1 - edge.u : edge.u);
}

/// The patch's derivative across the side, into the patch.
dvec3 inward(const ContactJet& j, Side side) {
  const dvec3& d = j.dx[across_u(side) ? 0 : 1];
  return at_end(side) ? -d : d;
}

/// Sine of the angle that a vector makes with the plane across n; zero of a zero vector.
double elevation(const dvec3& v, const dvec3& n) {
  const double length = glm::length(v);
  return length > 0 ? glm::dot(v, n) / length : 0;
}

/// The edge's tangent at the end of the piece, away from the end.
dvec3 leaving(const ContactGeometry& geometry, int instance, const ContactGeometry::PieceEnd& end) {
  const ContactJet j = geometry.jet({instance, SourceKind::edge, end.piece, double(end.end), 0});
  return end.end == 0 ? j.dx[0] : -j.dx[0];
}

std::optional<Contact> beyond_side(const ContactGeometry& geometry, const Contact& c, Side side) {
  const Border& border =
      geometry.part(c).patches()[std::size_t(c.element)].borders[std::size_t(side)];
  const double t = std::clamp(across_u(side) ? c.v : c.u, 0.0, 1.0);
  if (border.kind == BorderKind::smooth) {
    return on_side(c.instance, border.neighbor, border.neighbor_side, border.reversed ? 1 - t : t);
  }
  if (border.kind == BorderKind::edge && border.piece >= 0) {
    return Contact{c.instance, SourceKind::edge, border.piece, border.piece_reversed ? 1 - t : t,
                   0};
  }
  if (border.vertex >= 0) return Contact{c.instance, SourceKind::vertex, border.vertex, 0, 0};
  return std::nullopt;
}

std::optional<Contact> beyond_end(const ContactGeometry& geometry, const Contact& c, int end) {
  const EdgePiece& piece = geometry.part(c).pieces()[std::size_t(c.element)];
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

/// Climbs; one element at a time.
class Climb {
 public:
  Climb(const ContactGeometry& geometry, const Contact& c, const dvec3& n)
      : geometry_(geometry), c_(c), n_(n) {}

  std::optional<Contact> run() {
    for (int k = 0; k < step_limit; ++k) {
      const Progress progress = c_.kind == SourceKind::face   ? on_face()
                                : c_.kind == SourceKind::edge ? on_edge()
                                                              : at_vertex();
      if (progress == Progress::arrived) return c_;
      if (progress == Progress::lost) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  enum class Progress { moved, arrived, lost };
  static constexpr int step_limit = 60;
  /// Steps of the point shorter than this end the climb; the maximum is flat there.
  static constexpr double short_step = 1e-13;
  /// Slopes below this are rounding.
  static constexpr double flat = 1e-13;
  /// Share of a patch that steps may take where the value is not concave.
  static constexpr double stride = 0.2;

  Progress leave(const ContactExit& exit) {
    const std::optional<Contact> next = beyond(geometry_, c_, exit);
    if (!next) return Progress::lost;
    c_ = *next;
    return Progress::moved;
  }

  Progress on_face() {
    const ContactJet j = geometry_.jet(c_);
    const dvec2 slope(glm::dot(j.dx[0], n_), glm::dot(j.dx[1], n_));
    const dvec2 size(glm::length(j.dx[0]), glm::length(j.dx[1]));
    dvec2 at(c_.u, c_.v);
    std::array<bool, 2> held = {false, false};
    for (int a = 0; a < 2; ++a) {
      const bool low = at[a] <= 0 && slope[a] < -flat * size[a];
      const bool high = at[a] >= 1 && slope[a] > flat * size[a];
      if (!low && !high) continue;
      const Side side = a == 0 ? (low ? Side::u0 : Side::u1) : (low ? Side::v0 : Side::v1);
      const Border& border =
          geometry_.part(c_).patches()[std::size_t(c_.element)].borders[std::size_t(side)];
      if (border.kind == BorderKind::collapsed && border.vertex < 0) {
        held[std::size_t(a)] = true;  // a pole: it may be left along the other parameter
        continue;
      }
      return leave({ContactExit::Kind::side, int(side)});
    }
    const double uu = glm::dot(j.dxx, n_);
    const double uv = glm::dot(j.dxy, n_);
    const double vv = glm::dot(j.dyy, n_);
    dvec2 step(0.0);
    const double det = uu * vv - uv * uv;
    if (!held[0] && !held[1] && uu < 0 && det > 0) {
      step = {(uv * slope.y - vv * slope.x) / det, (uv * slope.x - uu * slope.y) / det};
    } else {
      for (int a = 0; a < 2; ++a) {
        if (held[std::size_t(a)] || size[a] == 0) continue;
        const double second = a == 0 ? uu : vv;
        step[a] = second < 0
                      ? -slope[a] / second
                      : std::copysign(std::min(stride, std::abs(slope[a]) / size[a]), slope[a]);
      }
    }
    if (glm::length(step * size) <= short_step) return Progress::arrived;
    const double longest = std::max(std::abs(step.x), std::abs(step.y));
    if (longest > 0.5) step *= 0.5 / longest;
    double share = 1;
    for (int a = 0; a < 2; ++a) {
      const double room = step[a] < 0 ? at[a] : 1 - at[a];
      if (std::abs(step[a]) > room) share = std::min(share, room / std::abs(step[a]));
    }
    for (int a = 0; a < 2; ++a) {
      const double room = step[a] < 0 ? at[a] : 1 - at[a];
      const bool meets = std::abs(step[a]) * share >= room && std::abs(step[a]) > room;
      at[a] = meets ? (step[a] < 0 ? 0.0 : 1.0) : std::clamp(at[a] + share * step[a], 0.0, 1.0);
    }
    const bool still = share * glm::length(step * size) <= short_step;
    c_.u = at.x;
    c_.v = at.y;
    return still && ++stuck_ > 4 ? Progress::lost : Progress::moved;
  }

  Progress on_edge() {
    const ContactJet j = geometry_.jet(c_);
    const double slope = glm::dot(j.dx[0], n_);
    const double size = glm::length(j.dx[0]);
    if (c_.u <= 0 && slope < -flat * size) return leave({ContactExit::Kind::end, 0});
    if (c_.u >= 1 && slope > flat * size) return leave({ContactExit::Kind::end, 1});
    const double second = glm::dot(j.dxx, n_);
    double step = second < 0 ? -slope / second
                             : std::copysign(std::min(stride, std::abs(slope) / size), slope);
    step = std::clamp(step, -0.5, 0.5);
    const double to = std::clamp(c_.u + step, 0.0, 1.0);
    if (std::abs(to - c_.u) * size > short_step) {
      c_.u = to;
      return Progress::moved;
    }
    if (std::abs(slope) > flat * size && second >= 0) return Progress::lost;
    const auto& sides = geometry_.sides(c_);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const dvec3 c = inward(geometry_.jet(on_side(c_, sides[k])), sides[k].side);
      if (elevation(c, n_) > flat) return leave({ContactExit::Kind::face, int(k)});
    }
    return Progress::arrived;
  }

  Progress at_vertex() {
    const auto& ends = geometry_.ends(c_);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (elevation(leaving(geometry_, c_.instance, ends[k]), n_) > flat) {
        return leave({ContactExit::Kind::edge, int(k)});
      }
    }
    return Progress::arrived;
  }

  const ContactGeometry& geometry_;
  Contact c_;
  dvec3 n_;
  int stuck_ = 0;
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
    add(Kind::edge, geometry.ends(c).size());
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
    const int a = across_u(side) ? 0 : 1;
    const double value = a == 0 ? c.u : c.v;
    e.residual = at_end(side) ? 1 - value : value;
    parameter[a] = at_end(side) ? -1 : 1;
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
    const double sense = (side.reversed ? -1.0 : 1.0) * (at_end(side.side) ? -1.0 : 1.0);
    parameter.x = -sense * glm::dot(j.dxy, s.n) / length;
  } else {
    const ContactGeometry::PieceEnd& end = geometry.ends(c)[std::size_t(exit.index)];
    const dvec3 away = leaving(geometry, c.instance, end);
    const double length = glm::length(away);
    if (length == 0) return e;
    e.n = -away / length;
    e.residual = glm::dot(e.n, s.n);
  }
  return e;
}

std::optional<Contact> beyond(const ContactGeometry& geometry, const Contact& c,
                              const ContactExit& exit) {
  switch (exit.kind) {
    case ContactExit::Kind::side:
      return beyond_side(geometry, c, all_sides[std::size_t(exit.index)]);
    case ContactExit::Kind::end:
      return beyond_end(geometry, c, exit.index);
    case ContactExit::Kind::face:
      return on_side(c, geometry.sides(c)[std::size_t(exit.index)]);
    case ContactExit::Kind::edge: {
      const ContactGeometry::PieceEnd& end = geometry.ends(c)[std::size_t(exit.index)];
      return Contact{c.instance, SourceKind::edge, end.piece, double(end.end), 0};
    }
  }
  return std::nullopt;
}

std::optional<Contact> climbed(const ContactGeometry& geometry, Contact c, const dvec3& n) {
  return Climb(geometry, geometry.canonical(c), n).run();
}

}  // namespace taut
