#include "taut/hull/mesh/constrained_edges.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// So often a place is sought at its length: that of a short chord's parts is nearly in proportion
/// to the parameter.
constexpr int length_steps = 3;

/// Of a curve's chord, in the root of the second fundamental form.
double form_length(const Ruling& a, const Ruling& b, int contact) {
  const auto i = std::size_t(contact);
  return std::sqrt(std::max(glm::dot(b.n - a.n, b.point[i] - a.point[i]), 0.0));
}

}  // namespace

ConstrainedEdges::ConstrainedEdges(const ContactGeometry& geometry, const HullBoundary& boundary,
                                   const ContactFaces& faces, const std::vector<CurveChord>& chords,
                                   const SampleSpacing& spacing)
    : geometry_(geometry),
      boundary_(boundary),
      faces_(faces),
      system_(geometry),
      spacing_(spacing),
      least_(spacing.width * geometry.scene().frame().scale) {
  for (const CurveChord& chord : chords) add(chord);
}

void ConstrainedEdges::add(const CurveChord& chord) {
  chords_.emplace(std::minmax(chord.a, chord.b), chord);
}

bool ConstrainedEdges::near(const Ruling& a, const Ruling& b, int contact) const {
  const auto i = std::size_t(contact);
  return glm::distance(a.point[i], b.point[i]) <= least_;
}

/// The share of the way at which a span is divided: half of it, or what is nearest to that and a
/// power of two from its end. `at`: the place at a share, if there is one.
double ConstrainedEdges::share(const Span& span, int contact,
                               const std::function<std::optional<Ruling>(double share)>& at) const {
  constexpr double half = 0.5;
  const double length = form_length(span.a, span.b, contact);
  if (span.from_end == span.to_end || !(length > 0)) return half;
  const double shell = std::exp2(std::round(std::log2(half * length)));
  double part = shell / length;
  for (int step = 0; step < length_steps; ++step) {
    const std::optional<Ruling> there = at(span.from_end ? part : 1 - part);
    if (!there) return half;
    part *= shell / form_length(span.from_end ? span.a : span.b, *there, contact);
    if (!(part > 0 && part < 1)) return half;
  }
  return span.from_end ? part : 1 - part;
}

/// Between two rulings of a piece.
std::optional<ArcPlace> ConstrainedEdges::within(const CurveChord& chord, int piece,
                                                 const Ruling& a, const Ruling& b) const {
  const int arc = chord.from.arc;
  const std::vector<Ruling>& own =
      boundary_.arcs[std::size_t(arc)].pieces[std::size_t(piece)].rulings;
  const auto at = [&](double s) { return ruling_between(system_, a, b, s); };
  const Span span = {a, b, near(a, own.front(), chord.contact), near(b, own.back(), chord.contact)};
  const std::optional<Ruling> middle = at(share(span, chord.contact, at));
  if (!middle) return std::nullopt;
  return ArcPlace{arc, piece, *middle};
}

/// Of a chord across pieces, where one of these ends, the nearest to its middle, unless all do at
/// the chord's ends. None if no exact ruling is found there.
std::optional<ArcPlace> ConstrainedEdges::middle_of(const CurveChord& chord) const {
  const ArcPlace& from = chord.from;
  const ArcPlace& to = chord.to;
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(from.arc)].pieces;
  const auto i = std::size_t(chord.contact);
  const auto end_of = [&](int p) -> const Ruling& {
    return p == to.piece ? to.ruling : pieces[std::size_t(p)].rulings.back();
  };
  int first = from.piece;  // that leads away from the chord's beginning
  while (first < to.piece && near(end_of(first), from.ruling, chord.contact)) ++first;
  int best = -1;
  double least = infinity;
  for (int p = first; p < to.piece && !near(end_of(p), to.ruling, chord.contact); ++p) {
    const dvec3& x = end_of(p).point[i];
    const double farther =
        std::max(glm::distance(from.ruling.point[i], x), glm::distance(x, to.ruling.point[i]));
    if (!(farther < least)) continue;
    least = farther;
    best = p;
  }
  if (best >= 0) return ArcPlace{from.arc, best, end_of(best)};
  const Ruling& begin =
      first == from.piece ? from.ruling : pieces[std::size_t(first)].rulings.front();
  return within(chord, first, begin, end_of(first));
}

std::optional<EdgeConstraints::Middle> ConstrainedEdges::middle(int a, int b) const {
  const auto found = chords_.find(std::minmax(a, b));
  if (found == chords_.end()) return std::nullopt;
  const CurveChord& chord = found->second;
  if (near(chord.from.ruling, chord.to.ruling, chord.contact)) return std::nullopt;
  const std::optional<ArcPlace> middle = middle_of(chord);
  if (!middle) return std::nullopt;
  const Ruling& r = middle->ruling;
  const Contact c = geometry_.canonical(clamped(r.contact[std::size_t(chord.contact)]));
  return Middle{{r.n, c}, geometry_.scene().frame().to_model(geometry_.point(c))};
}

std::vector<std::pair<int, int>> ConstrainedEdges::wanted() const {
  std::vector<std::pair<int, int>> ends;
  for (const auto& [own, chord] : chords_) {
    const Contact& c = chord.from.ruling.contact[std::size_t(chord.contact)];
    if (c.kind == SourceKind::face) ends.push_back(own);
  }
  return ends;
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
