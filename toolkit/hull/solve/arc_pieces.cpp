#include "taut/hull/solve/arc_pieces.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/solve/pole_passage.h"

namespace taut {
namespace {

/// Cosine of the angle to the way back from which on it turns back, beyond rounding.
constexpr double turned_back = 1e-3;

/// Steps no longer than this are none, and what is no farther from a border is on it.
constexpr double least_piece = 1e-12;
/// The same where a contact goes from border to border of its element: beside a corner, or off and
/// on a join that it runs along, where rounding moves it far along the one while hardly off it.
constexpr double least_piece_at_corner = 1e-10;

/// The same contacts, and with them the same direction: that of a patch tells it.
bool has_contacts(const Ruling& a, const Ruling& b) {
  const auto same = [](const Contact& c, const Contact& d) {
    return same_element(c, d) && c.u == d.u && c.v == d.v;
  };
  const bool on_face =
      a.contact[0].kind == SourceKind::face || a.contact[1].kind == SourceKind::face;
  return on_face && same(a.contact[0], b.contact[0]) && same(a.contact[1], b.contact[1]);
}

double distance(const Ruling& a, const Ruling& b) {
  const auto square = [](const dvec3& x) { return glm::dot(x, x); };
  return std::sqrt(square(b.n - a.n) + square(b.point[0] - a.point[0]) +
                   square(b.point[1] - a.point[1]));
}

double uncertainty(const ContactGeometry& geometry, const Ruling& r) {
  return ContactSystem(geometry).uncertainty(CommonSupport(geometry, r));
}

/// Contacts that are on patches before and after are in one place.
bool meet_on_patches(const Ruling& before, const Ruling& after) {
  for (const std::size_t i : {0u, 1u}) {
    const bool on_patches =
        before.contact[i].kind == SourceKind::face && after.contact[i].kind == SourceKind::face;
    if (on_patches && before.point[i] != after.point[i]) return false;
  }
  return true;
}

/// One of the contacts lies on borders of its element where the piece begins and where it ends.
bool passes_corner(const ArcPiece& piece) {
  const auto on_border = [](const Contact& c) {
    const auto is_end = [](double t) { return t == 0 || t == 1; };
    return c.kind == SourceKind::vertex || is_end(c.u) ||
           (c.kind == SourceKind::face && is_end(c.v));
  };
  const Ruling& first = piece.rulings.front();
  const Ruling& last = piece.rulings.back();
  return (on_border(first.contact[0]) && on_border(last.contact[0])) ||
         (on_border(first.contact[1]) && on_border(last.contact[1]));
}

/// How far contacts may be moved to where they cross borders with others.
double reach(const ContactGeometry& geometry, const Ruling& r) {
  return std::clamp(uncertainty(geometry, r), least_piece_at_corner, longest_empty_piece);
}

/// Puts a ruling in the place of one very near to it, its contacts in their own elements. False if
/// one of these is a patch that does not reach there but for rounding, so that no curve in it would
/// end where the next one begins, or an edge or vertex that is farther off than `distance`; it
/// stays as it is then.
bool move_to(const ContactGeometry& geometry, Ruling& ruling, const Ruling& place,
             double distance) {
  Ruling moved = place;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = snapped(geometry, place.contact[i], reach(geometry, place));
    const auto own = in_element(geometry, c, ruling.contact[i]);
    const double off = glm::distance(ruling.point[i], place.point[i]);
    const bool is_face = ruling.contact[i].kind == SourceKind::face;
    const double most = std::max(reach(geometry, place), is_face ? 0 : distance);
    if (!own && off > most) return false;
    moved.contact[i] = own.value_or(ruling.contact[i]);
  }
  ruling = moved;
  return true;
}

void set_contact(const ContactGeometry& geometry, Ruling& ruling, std::size_t i,
                 const Contact& place) {
  if (place.u == ruling.contact[i].u && place.v == ruling.contact[i].v) return;
  ruling.contact[i] = place;
  ruling.point[i] = geometry.point(place);
}

/// Puts contacts on borders to which they are so near that they cross them there.
void move_to_borders(const ContactGeometry& geometry, Ruling& ruling, double distance) {
  distance = std::max(distance, reach(geometry, ruling));
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = snapped(geometry, ruling.contact[i], distance);
    if (const auto own = in_element(geometry, c, ruling.contact[i])) {
      set_contact(geometry, ruling, i, *own);
    }
  }
}

}  // namespace

void turn_ends(const ContactSystem& system, std::vector<ArcPiece>& pieces) {
  const auto turn = [&](Ruling& end, const Ruling& next) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Contact c = turned_to(system.geometry(), end.contact[i], next.contact[i]);
      const bool at_pole = same_element(c, next.contact[i]) && pole_side(system.geometry(), c) &&
                           !pole_side(system.geometry(), next.contact[i]);
      const auto into = at_pole ? into_pole(system, next, end, i) : std::nullopt;
      end.contact[i] = into.value_or(c);
    }
  };
  for (ArcPiece& piece : pieces) {
    std::vector<Ruling>& rulings = piece.rulings;
    if (rulings.size() < 2) continue;
    turn(rulings.front(), rulings[1]);
    turn(rulings.back(), rulings[rulings.size() - 2]);
  }
}

namespace {

/// Pieces that go on into each other in the same elements are one.
void join_pieces(std::vector<ArcPiece>& pieces) {
  std::vector<ArcPiece> joined;
  for (ArcPiece& piece : pieces) {
    std::vector<ArcPiece> own;
    own.push_back(std::move(piece));
    append(joined, std::move(own));
  }
  pieces = std::move(joined);
}

/// The smooth join along which all of the piece's contacts i run: on it, or no farther than
/// `extent` from it where heights tie.
std::optional<ContactExit> join_along(const ContactGeometry& geometry, const ArcPiece& piece,
                                      std::size_t i, double extent) {
  const Contact& any = piece.rulings.front().contact[i];
  if (any.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    if (geometry.patch(any).borders[std::size_t(side)].kind != BorderKind::smooth) continue;
    const ContactExit exit{ContactExit::Kind::side, int(side)};
    const bool along = std::all_of(piece.rulings.begin(), piece.rulings.end(), [&](const auto& r) {
      if (stands_at(r.contact[i], exit)) return true;
      if (extent == 0) return false;
      const dvec3 off = geometry.point(at_exit(r.contact[i], exit)) - r.point[i];
      return glm::length(off) <= extent && glm::dot(off, r.n) >= -geometry.tie();
    });
    if (along) return exit;
  }
  return std::nullopt;
}

/// The region of contact i of a piece along a side of its patch is beyond that: it lies to the left
/// of contact 1 and to the right of contact 0 as they go, seen from outside.
bool extends_over(const ContactGeometry& geometry, const ArcPiece& piece, std::size_t i,
                  Side side) {
  const Contact& first = piece.rulings.front().contact[i];
  const Contact& last = piece.rulings.back().contact[i];
  const double along = along_v(side) ? last.v - first.v : last.u - first.u;
  double outward = 0;  // of Su x Sv
  for (const Ruling& r : piece.rulings) {
    const ContactJet j = geometry.jet(r.contact[i]);
    outward += glm::dot(glm::cross(j.dx[0], j.dx[1]), r.n);
  }
  const bool is_ahead = (side == Side::v0 || side == Side::u1) == (along > 0);
  return along != 0 && is_ahead != ((i == 1) == (outward > 0));
}

}  // namespace

void tell_along_edges(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces) {
  const auto tell = [&](ArcPiece& piece, const ArcPiece& next, std::size_t i) {
    if (piece.rulings.front().contact[i].kind != SourceKind::face ||
        next.rulings.front().contact[i].kind != SourceKind::edge) {
      return;
    }
    const Contact& edge = next.rulings.front().contact[i];
    std::vector<Ruling> told = piece.rulings;
    for (Ruling& r : told) {
      const std::optional<Contact> own = expressed_in(geometry, r.contact[i], edge);
      if (!own) return;
      r.contact[i] = *own;
    }
    piece.rulings = std::move(told);
  };
  for (const std::size_t i : {0u, 1u}) {
    for (std::size_t k = 1; k < pieces.size(); ++k) tell(pieces[k], pieces[k - 1], i);
    for (std::size_t k = pieces.size(); --k > 0;) tell(pieces[k - 1], pieces[k], i);
  }
  join_pieces(pieces);
}

void tell_along_joins(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces,
                      double extent) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    ArcPiece& piece = pieces[k];
    for (std::size_t i = 0; i < 2; ++i) {
      const std::optional<ContactExit> exit = join_along(geometry, piece, i, extent);
      if (!exit) continue;
      for (Ruling& r : piece.rulings) set_contact(geometry, r, i, at_exit(r.contact[i], *exit));
      if (extends_over(geometry, piece, i, all_sides[std::size_t(exit->index)])) {
        for (Ruling& r : piece.rulings) {
          if (const auto over = beyond(geometry, r.contact[i], *exit)) r.contact[i] = *over;
        }
      }
      if (extent == 0) continue;
      if (k > 0) set_places(geometry, pieces[k - 1].rulings.back(), piece.rulings.front());
      if (k + 1 < pieces.size()) {
        set_places(geometry, pieces[k + 1].rulings.front(), piece.rulings.back());
      }
    }
  }
  join_pieces(pieces);
}

namespace {

/// Rounding may make any shorter piece of nothing.
double shortest_piece(const ContactGeometry& geometry, const ArcPiece& piece) {
  const Ruling& first = piece.rulings.front();
  const double least = passes_corner(piece) ? least_piece_at_corner : least_piece;
  return std::clamp(uncertainty(geometry, first), least, longest_empty_piece);
}

}  // namespace

void drop_empty_pieces(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces, double place,
                       double reach, double extent) {
  // At its ends, where heights tie over as much.
  const double tied =
      std::max({longest_empty_piece, std::sqrt(geometry.rounding()), reach, extent});
  const double off = std::max(longest_empty_piece, place);
  const auto is_empty = [&](std::size_t k) {
    const std::vector<Ruling>& rulings = pieces[k].rulings;
    const bool ends = k == 0 || k + 1 == pieces.size();
    const Ruling& a = rulings.front();
    double length = 0;
    for (const Ruling& b : rulings) {
      if (!has_contacts(a, b)) length = std::max(length, distance(a, b));
    }
    return length < (ends ? tied : std::max(reach, shortest_piece(geometry, pieces[k])));
  };
  // Leaving a piece out shortens those about it.
  for (std::size_t count = 0; count != pieces.size();) {
    count = pieces.size();
    for (std::size_t k = pieces.size(); k-- > 0 && pieces.size() > 1;) {
      if (!is_empty(k)) continue;
      // What begins and ends the arc is told by its first ruling and its last.
      const Ruling& first = pieces[k].rulings.front();
      const Ruling& last = pieces[k].rulings.back();
      if (k == 0 && !move_to(geometry, pieces[1].rulings.front(), first, off)) continue;
      if (k + 1 == pieces.size() && !move_to(geometry, pieces[k - 1].rulings.back(), last, off)) {
        continue;
      }
      if (k > 0 && k + 1 < pieces.size()) {
        // One contact crosses its border here, the other one in the piece's other end.
        Ruling before = pieces[k - 1].rulings.back();
        Ruling after = pieces[k + 1].rulings.front();
        move_to_borders(geometry, before, extent > 0 ? reach : 0);
        move_to_borders(geometry, after, extent > 0 ? reach : 0);
        set_places(geometry, after, before);
        const bool is_end = (k == 1 && pieces[0].rulings.size() == 1) ||
                            (k + 2 == pieces.size() && pieces[k + 1].rulings.size() == 1);
        if (is_end || !meet_on_patches(before, after)) continue;
        pieces[k - 1].rulings.back() = before;
        pieces[k + 1].rulings.front() = after;
      }
      pieces.erase(pieces.begin() + std::ptrdiff_t(k));
    }
  }
}

Ruling reversed(const Ruling& r) {
  return {r.n, {r.contact[1], r.contact[0]}, {r.point[1], r.point[0]}};
}

void reverse(std::vector<Ruling>& rulings) {
  std::reverse(rulings.begin(), rulings.end());
  for (Ruling& r : rulings) r = reversed(r);
}

void reverse(std::vector<ArcPiece>& pieces) {
  std::reverse(pieces.begin(), pieces.end());
  for (ArcPiece& piece : pieces) reverse(piece.rulings);
}

void set_places(const ContactGeometry& geometry, Ruling& ruling, Ruling& other) {
  for (std::size_t i = 0; i < 2; ++i) {
    auto own = expressed_in(geometry, other.contact[i], ruling.contact[i]);
    if (!own) {
      const Contact place = moved_to_border(geometry, other.contact[i], reach(geometry, other));
      own = expressed_in(geometry, place, ruling.contact[i]);
      if (own) set_contact(geometry, other, i, place);
    }
    if (!own) continue;
    ruling.contact[i] = *own;
    ruling.point[i] = other.point[i];
  }
}

bool same_elements(const Ruling& a, const Ruling& b) {
  return same_element(a.contact[0], b.contact[0]) && same_element(a.contact[1], b.contact[1]);
}

void drop_beside_ends(std::vector<Ruling>& rulings, double extent) {
  while (rulings.size() > 2 && distance(rulings[0], rulings[1]) < extent) {
    rulings.erase(rulings.begin() + 1);
  }
  while (rulings.size() > 2 && distance(rulings[rulings.size() - 2], rulings.back()) < extent) {
    rulings.erase(rulings.end() - 2);
  }
}

void drop_turns(std::vector<Ruling>& rulings, double extent) {
  using Place = std::array<dvec3, 3>;
  const auto place = [](const Ruling& r) { return Place{r.n, r.point[0], r.point[1]}; };
  const auto turns = [&](const Ruling& a, const Ruling& b, const Ruling& c) {
    const Place from = place(a), turn = place(b), to = place(c);
    double along = 0, before = 0, after = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      along += glm::dot(turn[i] - from[i], to[i] - turn[i]);
      before += glm::dot(turn[i] - from[i], turn[i] - from[i]);
      after += glm::dot(to[i] - turn[i], to[i] - turn[i]);
      if (std::min(distance_to_segment(to[i], from[i], turn[i]),
                   distance_to_segment(from[i], turn[i], to[i])) > extent) {
        return false;
      }
    }
    return along < -turned_back * std::sqrt(before * after);
  };
  for (std::size_t k = 1; k + 1 < rulings.size();) {
    if (turns(rulings[k - 1], rulings[k], rulings[k + 1])) {
      rulings.erase(rulings.begin() + std::ptrdiff_t(k));
      k = std::max<std::size_t>(k - 1, 1);
    } else {
      ++k;
    }
  }
}

void tell_corners(std::vector<ArcPiece>& pieces, double place, double extent, double depth) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    std::vector<Ruling>& rulings = pieces[k].rulings;
    Ruling* next = k + 1 < pieces.size() ? &pieces[k + 1].rulings.front() : nullptr;
    for (const std::size_t i : {0u, 1u}) {
      const Contact corner = rulings.front().contact[i];
      const dvec3 end = rulings.front().point[i];
      const Contact last = rulings.back().contact[i];
      const bool is_same = corner.u == last.u && corner.v == last.v;
      // What goes on from a place beside goes on from there.
      const bool is_beside = corner.kind == SourceKind::edge && next &&
                             same_element(next->contact[i], last) &&
                             glm::distance(end, rulings.back().point[i]) <= place;
      const bool is_inside = corner.kind == SourceKind::face || (0 < corner.u && corner.u < 1);
      const bool comes_back = corner.kind != SourceKind::vertex && is_inside &&
                              same_element(corner, last) && (is_same || is_beside);
      const bool stays =
          comes_back && std::all_of(rulings.begin(), rulings.end(), [&](const auto& r) {
            return glm::distance(r.point[i], end) <= extent &&
                   glm::dot(r.point[i] - end, r.n) <= depth;
          });
      if (!stays) continue;
      for (Ruling& r : rulings) {
        r.contact[i] = corner;
        r.point[i] = end;
      }
      if (is_same) continue;
      next->contact[i] = corner;
      next->point[i] = end;
    }
  }
}

void tell_vertices(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces, double extent) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    std::vector<Ruling>& rulings = pieces[k].rulings;
    Ruling* before = k > 0 ? &pieces[k - 1].rulings.back() : nullptr;
    Ruling* after = k + 1 < pieces.size() ? &pieces[k + 1].rulings.front() : nullptr;
    for (const std::size_t i : {0u, 1u}) {
      Contact end = rulings.front().contact[i];
      if (end.kind != SourceKind::edge) continue;
      end.u = std::round(end.u);
      const Contact vertex = geometry.first(geometry.canonical(end));
      if (vertex.kind != SourceKind::vertex) continue;
      const dvec3 x = geometry.point(vertex);
      // What it meets beside is there, or goes on along the edge.
      const auto meets = [&](const Ruling& own, const Ruling* beside) {
        const double far =
            beside && same_element(beside->contact[i], end) ? extent : geometry.tie();
        return glm::distance(own.point[i], x) <= far;
      };
      const bool stays = meets(rulings.front(), before) && meets(rulings.back(), after) &&
                         std::all_of(rulings.begin(), rulings.end(), [&](const Ruling& r) {
                           return glm::dot(r.point[i] - x, r.n) <= geometry.tie();
                         });
      if (!stays) continue;
      for (Ruling& r : rulings) {
        r.contact[i] = vertex;
        r.point[i] = x;
      }
      for (Ruling* beside : {before, after}) {
        if (!beside || !same_element(beside->contact[i], end)) continue;
        beside->contact[i] = end;
        beside->point[i] = x;
      }
    }
  }
  join_pieces(pieces);
}

void append(std::vector<ArcPiece>& pieces, std::vector<ArcPiece>&& more) {
  auto first = more.begin();
  if (!pieces.empty() && first != more.end() &&
      same_elements(pieces.back().rulings.back(), first->rulings.front())) {
    auto& to = pieces.back().rulings;
    // They meet in a ruling that both have; a single one may be another, with which the arc ends.
    const bool meet = first->rulings.size() > 1 || distance(to.back(), first->rulings[0]) == 0;
    to.insert(to.end(), first->rulings.begin() + (meet ? 1 : 0), first->rulings.end());
    pieces.back().tolerant = std::max(pieces.back().tolerant, first->tolerant);
    ++first;
  }
  std::move(first, more.end(), std::back_inserter(pieces));
}

}  // namespace taut
