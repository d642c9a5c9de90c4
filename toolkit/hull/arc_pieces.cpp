#include "taut/hull/arc_pieces.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/contact_exits.h"
#include "taut/hull/pole_passage.h"

namespace taut {
namespace {

/// Puts a ruling in the place of one very near to it, its contacts in their own elements as far as
/// they reach there.
void move_to(const ContactGeometry& geometry, Ruling& ruling, const Ruling& place) {
  ruling.n = place.n;
  ruling.point = place.point;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = snapped(geometry, place.contact[i], shortest_piece);
    if (const auto own = in_element(geometry, c, ruling.contact[i])) ruling.contact[i] = *own;
  }
}

/// Contacts with which pieces begin and end in their normal form: turned to the next ones.
void turn_ends(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces) {
  for (ArcPiece& piece : pieces) {
    std::vector<Ruling>& rulings = piece.rulings;
    if (rulings.size() < 2) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      Contact& first = rulings.front().contact[i];
      Contact& last = rulings.back().contact[i];
      first = turned_to(geometry, first, rulings[1].contact[i]);
      last = turned_to(geometry, last, rulings[rulings.size() - 2].contact[i]);
    }
  }
}

}  // namespace

void drop_empty_pieces(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces) {
  const auto square = [](const dvec3& x) { return glm::dot(x, x); };
  // At its ends, where heights tie over as much.
  const double tied = std::max(shortest_piece, std::sqrt(geometry.rounding()));
  const auto is_empty = [&](std::size_t k) {
    const std::vector<Ruling>& rulings = pieces[k].rulings;
    const double shortest = k == 0 || k + 1 == pieces.size() ? tied : shortest_piece;
    const Ruling& a = rulings.front();
    return std::all_of(rulings.begin(), rulings.end(), [&](const Ruling& b) {
      return square(b.n - a.n) + square(b.point[0] - a.point[0]) + square(b.point[1] - a.point[1]) <
             shortest * shortest;
    });
  };
  for (std::size_t k = pieces.size(); k-- > 0 && pieces.size() > 1;) {
    if (!is_empty(k)) continue;
    // What begins and ends the arc is told by its first ruling and its last.
    if (k == 0) move_to(geometry, pieces[1].rulings.front(), pieces[0].rulings.front());
    if (k + 1 == pieces.size())
      move_to(geometry, pieces[k - 1].rulings.back(), pieces[k].rulings.back());
    if (k > 0 && k + 1 < pieces.size()) {
      // One contact crosses its border here, the other one in the piece's other end.
      Ruling& before = pieces[k - 1].rulings.back();
      Ruling& after = pieces[k + 1].rulings.front();
      move_to(geometry, before, before);
      move_to(geometry, after, after);
      for (std::size_t i = 0; i < 2; ++i) {
        if (!same_element(before.contact[i], after.contact[i])) continue;
        after.contact[i] = before.contact[i];
        after.point[i] = before.point[i];
      }
    }
    pieces.erase(pieces.begin() + std::ptrdiff_t(k));
  }
  turn_ends(geometry, pieces);
}

void reverse(std::vector<ArcPiece>& pieces) {
  std::reverse(pieces.begin(), pieces.end());
  for (ArcPiece& piece : pieces) {
    std::reverse(piece.rulings.begin(), piece.rulings.end());
    for (Ruling& r : piece.rulings) {
      std::swap(r.contact[0], r.contact[1]);
      std::swap(r.point[0], r.point[1]);
    }
  }
}

bool same_elements(const Ruling& a, const Ruling& b) {
  return same_element(a.contact[0], b.contact[0]) && same_element(a.contact[1], b.contact[1]);
}

void append(std::vector<ArcPiece>& pieces, std::vector<ArcPiece>&& more) {
  auto first = more.begin();
  if (!pieces.empty() && first != more.end() &&
      same_elements(pieces.back().rulings.back(), first->rulings.front())) {
    auto& to = pieces.back().rulings;
    to.insert(to.end(), first->rulings.begin() + 1, first->rulings.end());
    ++first;
  }
  std::move(first, more.end(), std::back_inserter(pieces));
}

}  // namespace taut
