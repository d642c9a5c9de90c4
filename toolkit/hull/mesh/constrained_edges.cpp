#include "taut/hull/mesh/constrained_edges.h"

#include <algorithm>

#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {

ConstrainedEdges::ConstrainedEdges(const ContactGeometry& geometry, const HullBoundary& boundary,
                                   const ContactFaces& faces, const std::vector<CurveChord>& chords,
                                   double least)
    : geometry_(geometry),
      boundary_(boundary),
      faces_(faces),
      system_(geometry),
      least_(least * geometry.scene().frame().scale) {
  for (const CurveChord& chord : chords) add(chord);
}

void ConstrainedEdges::add(const CurveChord& chord) {
  chords_.emplace(std::minmax(chord.a, chord.b), chord);
}

/// Of a chord across pieces, where one of these ends, unless that is one of the chord's ends
/// already. None if no exact ruling is found there.
std::optional<ArcPlace> ConstrainedEdges::middle_of(const CurveChord& chord) const {
  const ArcPlace& from = chord.from;
  const ArcPlace& to = chord.to;
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(from.arc)].pieces;
  const auto near = [&](const Ruling& a, const Ruling& b) {
    const auto i = std::size_t(chord.contact);
    return glm::distance(a.point[i], b.point[i]) <= least_;
  };
  const auto bisected = [&](int piece, const Ruling& a,
                            const Ruling& b) -> std::optional<ArcPlace> {
    const std::optional<Ruling> middle = ruling_between(system_, a, b, 0.5);
    if (!middle) return std::nullopt;
    return ArcPlace{from.arc, piece, *middle};
  };
  for (int p = from.piece; p < to.piece; ++p) {
    const Ruling& end = pieces[std::size_t(p)].rulings.back();
    if (near(end, from.ruling)) continue;
    if (!near(end, to.ruling)) return ArcPlace{from.arc, p, end};
    const bool begins_here = p == from.piece;
    return bisected(p, begins_here ? from.ruling : pieces[std::size_t(p)].rulings.front(), end);
  }
  const bool begins_here = from.piece == to.piece;
  return bisected(to.piece,
                  begins_here ? from.ruling : pieces[std::size_t(to.piece)].rulings.front(),
                  to.ruling);
}

std::optional<EdgeConstraints::Middle> ConstrainedEdges::middle(int a, int b) const {
  const auto found = chords_.find(std::minmax(a, b));
  if (found == chords_.end()) return std::nullopt;
  const CurveChord& chord = found->second;
  const auto i = std::size_t(chord.contact);
  if (glm::distance(chord.from.ruling.point[i], chord.to.ruling.point[i]) <= least_) {
    return std::nullopt;
  }
  const std::optional<ArcPlace> at = middle_of(chord);
  if (!at) return std::nullopt;
  const Ruling& r = at->ruling;
  const Contact c = geometry_.canonical(clamped(r.contact[i]));
  return Middle{{r.n, c}, geometry_.scene().frame().to_model(geometry_.point(c))};
}

void ConstrainedEdges::bisect(int a, int b, int middle) {
  const auto found = chords_.find(std::minmax(a, b));
  const CurveChord chord = found->second;
  chords_.erase(found);
  const ArcPlace at = *middle_of(chord);  // there, as it was asked for
  add({chord.a, middle, chord.contact, chord.from, at});
  add({middle, chord.b, chord.contact, at, chord.to});
  inserted_.emplace(middle, faces_.beside(at.arc, at.piece, chord.contact));
}

}  // namespace taut
