#include "taut/hull/kept_chords.h"

#include <algorithm>

namespace taut {

KeptChords::KeptChords(const ContactGeometry& geometry, const HullBoundary& boundary,
                       const ContactFaces& faces, const std::vector<CurveChord>& chords,
                       double least)
    : geometry_(geometry),
      boundary_(boundary),
      faces_(faces),
      system_(geometry),
      least_(least * geometry.scene().frame().scale) {
  for (const CurveChord& chord : chords) add(chord);
}

void KeptChords::add(const CurveChord& chord) {
  chords_.emplace(std::minmax(chord.a, chord.b), chord);
}

/// Across pieces, where one of them ends.
ArcPlace KeptChords::middle_of(const CurveChord& chord) const {
  const ArcPlace& from = chord.from;
  const ArcPlace& to = chord.to;
  if (from.piece == to.piece) {
    return {from.arc, from.piece, ruling_between(system_, from.ruling, to.ruling, 0.5)};
  }
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(from.arc)].pieces;
  const Ruling& end = pieces[std::size_t(from.piece)].rulings.back();
  if (end.n != from.ruling.n) return {from.arc, from.piece, end};
  const int next = from.piece + 1;
  return middle_of({chord.a,
                    chord.b,
                    chord.contact,
                    {from.arc, next, pieces[std::size_t(next)].rulings.front()},
                    to});
}

std::optional<KeptEdges::Middle> KeptChords::middle(int a, int b) const {
  const auto found = chords_.find(std::minmax(a, b));
  if (found == chords_.end()) return std::nullopt;
  const CurveChord& chord = found->second;
  const auto i = std::size_t(chord.contact);
  if (glm::distance(chord.from.ruling.point[i], chord.to.ruling.point[i]) <= least_) {
    return std::nullopt;
  }
  const Ruling r = middle_of(chord).ruling;
  const Contact c = geometry_.canonical(r.contact[i]);
  return Middle{{r.n, c}, geometry_.scene().frame().to_model(geometry_.point(c))};
}

void KeptChords::bisect(int a, int b, int middle) {
  const auto found = chords_.find(std::minmax(a, b));
  const CurveChord chord = found->second;
  chords_.erase(found);
  const ArcPlace at = middle_of(chord);
  add({chord.a, middle, chord.contact, chord.from, at});
  add({middle, chord.b, chord.contact, at, chord.to});
  inserted_.emplace(middle, faces_.beside(at.arc, at.piece, chord.contact));
}

}  // namespace taut
