#include "taut/bounds/contact_exits.h"

#include <algorithm>

namespace taut {
namespace {

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
  // The end at which the neighbour goes on: the one nearer to this piece's end.
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

}  // namespace

Contact on_side(int instance, int patch, Side side, double t) {
  const dvec2 uv = taut::on_side(side, t);
  return {instance, SourceKind::face, patch, uv.x, uv.y};
}

Contact on_side(const Contact& edge, const ContactGeometry::PieceSide& side) {
  return on_side(side.instance < 0 ? edge.instance : side.instance, side.patch, side.side,
                 side.reversed ? 1 - edge.u : edge.u);
}

Contact piece_end(const Contact& vertex, const ContactGeometry::PieceEnd& end) {
  return {end.instance < 0 ? vertex.instance : end.instance, SourceKind::edge, end.piece,
          double(end.end), 0};
}

std::vector<Contact> piece_ends(const ContactGeometry& geometry, const Contact& vertex) {
  std::vector<Contact> result;
  for (const ContactGeometry::PieceEnd& end : geometry.ends(vertex)) {
    result.push_back(piece_end(vertex, end));
  }
  return result;
}

dvec3 inward_derivative(const ContactJet& j, Side side) {
  const dvec3& d = j.dx[along_v(side) ? 0 : 1];
  return at_upper_end(side) ? -d : d;
}

dvec3 tangent_from(const ContactGeometry& geometry, const Contact& vertex,
                   const ContactGeometry::PieceEnd& end) {
  const ContactJet j = geometry.jet(piece_end(vertex, end));
  return end.end == 0 ? j.dx[0] : -j.dx[0];
}

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
      if (!geometry.is_straight(piece_end(c, ends[k]))) {
        result.push_back({Kind::edge, int(k)});
      }
    }
  }
  return result;
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
      return piece_end(c, end);
    }
  }
  return std::nullopt;
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

}  // namespace taut
