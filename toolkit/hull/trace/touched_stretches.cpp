#include "taut/hull/trace/touched_stretches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/parabolic_sides.h"
#include "taut/hull/contact/sign_changes.h"

namespace taut {
namespace {

/// Intervals of each side whose ends are compared.
constexpr int touch_samples = 64;
/// Normals along an edge that differ by less are one.
constexpr double same_normal = 1e-10;
/// Second derivatives across an edge below so many roundings vanish.
constexpr double noise_factor = 64;
/// Coefficients by which a face leaves the plane, in the scene's frame, that are less may be none.
constexpr double least_fall = 1e-6;
/// What is below a chord by less, as a share, is on it.
constexpr double least_sag = 1e-7;
/// Radians by which a plane is turned about an edge to tell chords from stretches, and steps to the
/// highest point beside the edge.
constexpr double turn_beside = 0.01;
constexpr int most_climbs = 20;
/// Of the sides' places, so many are between two that are asked for what supports.
constexpr std::size_t places_queried = 16;
/// Of central touch_difference quotients.
constexpr double touch_difference = 1e-5;
/// Stretches of a piece below this are none.
constexpr double least_stretch = 1e-9;
/// Parameters of a side in which its normals and curvatures are compared.
constexpr std::array<double, 5> all_places = {0, 0.2, 0.4, 0.7, 1};

SideParts reversed(const SideParts& side) {
  SideParts result;
  Contact at = side.end;
  for (auto part = side.parts.rbegin(); part != side.parts.rend(); ++part) {
    SidePart& back = result.parts.emplace_back(SidePart{at, part->stretch});
    std::swap(back.stretch.from, back.stretch.to);
    at = part->begin;
  }
  result.end = at;
  return result;
}

/// A straight edge, or a stretch of it, along which a face has one normal.
class TouchedEdge {
 public:
  TouchedEdge(const ContactGeometry& geometry, const std::array<Contact, 2>& ends, const dvec3& n)
      : geometry_(geometry),
        ends_(ends),
        n_(n),
        origin_(geometry.point(ends[0])),
        along_(unit(geometry.point(ends[1]) - origin_)),
        length_(glm::distance(geometry.point(ends[1]), origin_)) {}

  bool is(const std::array<Contact, 2>& ends, const dvec3& n) const {
    return same_element(ends_[0], ends[0]) && same_element(ends_[1], ends[1]) &&
           glm::distance(n_, n) < same_normal;
  }
  const dvec3& n() const { return n_; }
  /// A side of one of the face's patches.
  void add(const Contact& patch, Side side, const Contact& piece);
  /// The stretches that the face's sides make up; none where they are on both sides of the edge.
  std::vector<TouchedEdge> stretches();
  /// The sides make up the edge.
  bool is_whole() const;
  /// The face lies beside the edge to the right as the parts run, seen from outside.
  bool is_to_the_right() const;
  /// None where a chord has none of the stretch's ends for an end, and where the face does not
  /// leave the plane.
  std::optional<SideParts> parts(SupportQuery& query);

 private:
  struct EdgeSide {
    Contact patch;
    Side side;
    Contact piece;
    Interval range = {};  ///< along the edge
    bool forwards = true;

    double begin() const { return forwards ? 0 : 1; }
    double end() const { return forwards ? 1 : 0; }
  };
  struct Place {
    std::size_t side;
    double t;      ///< the side's parameter
    double at;     ///< along the edge
    double value;  ///< of f, up to a factor
  };

  double position(const EdgeSide& side, double t) const {
    return glm::dot(geometry_.point(on_side_of(side.patch, side.side, t)) - origin_, along_);
  }
  dvec3 across(const EdgeSide& side, int order, double t) const;
  bool bends() const;
  double fall(const EdgeSide& side, double t) const;
  Place place(std::size_t side, double t) const;
  std::optional<std::vector<Place>> samples() const;
  std::optional<Contact> highest_beside(const Place& p, double turn) const;
  bool is_left(const std::vector<Place>& places, SupportQuery& query) const;
  std::optional<Place> tangent_from(const Place& end, const Place& before,
                                    const Place& after) const;
  Contact on_piece(const Place& p) const;
  void add_stretches(const Place& begin, const Place& end, std::vector<SidePart>& parts) const;

  const ContactGeometry& geometry_;
  std::array<Contact, 2> ends_;
  dvec3 n_, origin_, along_;
  double length_;
  bool bends_ = false;
  std::vector<EdgeSide> sides_;
};

void TouchedEdge::add(const Contact& patch, Side side, const Contact& piece) {
  EdgeSide own{patch, side, piece};
  const double from = position(own, 0);
  const double to = position(own, 1);
  own.range = {std::min(from, to), std::max(from, to)};
  own.forwards = to > from;
  sides_.push_back(own);
}

/// The derivative of this order across the side, into the patch.
dvec3 TouchedEdge::across(const EdgeSide& side, int order, double t) const {
  const PatchJet3 j = geometry_.patch_jet(on_side_of(side.patch, side.side, t));
  const std::array<dvec3, 3> of_u = {j.Su, j.Suu, j.Suuu};
  const std::array<dvec3, 3> of_v = {j.Sv, j.Svv, j.Svvv};
  const dvec3& d = (along_v(side.side) ? of_u : of_v)[std::size_t(order - 1)];
  return at_upper_end(side.side) && order % 2 == 1 ? -d : d;
}

std::vector<TouchedEdge> TouchedEdge::stretches() {
  std::sort(sides_.begin(), sides_.end(),
            [](const EdgeSide& a, const EdgeSide& b) { return a.range.lower < b.range.lower; });
  std::vector<TouchedEdge> result;
  for (const EdgeSide& side : sides_) {
    const double at = result.empty() ? -length_ : result.back().sides_.back().range.upper;
    if (side.range.lower < at - same_contact) return {};
    if (side.range.lower > at + same_contact) result.emplace_back(geometry_, ends_, n_);
    result.back().sides_.push_back(side);
  }
  return result;
}

bool TouchedEdge::is_whole() const {
  return sides_.front().range.lower < same_contact &&
         sides_.back().range.upper > length_ - same_contact;
}

/// The face has curvature across the edge.
bool TouchedEdge::bends() const {
  return std::any_of(sides_.begin(), sides_.end(), [&](const EdgeSide& side) {
    return std::any_of(all_places.begin(), all_places.end(), [&](double t) {
      return std::abs(glm::dot(across(side, 2, t), n_)) > noise_factor * geometry_.rounding();
    });
  });
}

/// By the square or the cube of the distance from the edge.
double TouchedEdge::fall(const EdgeSide& side, double t) const {
  const dvec3 d = across(side, 1, t);
  const double y = glm::length(d - glm::dot(d, along_) * along_);
  return bends_ ? -glm::dot(across(side, 2, t), n_) / (2 * y * y)
                : -glm::dot(across(side, 3, t), n_) / (6 * y * y * y);
}

/// The highest of d y - fall y^2, or of d y - fall y^3, over all distances y.
TouchedEdge::Place TouchedEdge::place(std::size_t side, double t) const {
  const double c = fall(sides_[side], t);
  return {side, t, position(sides_[side], t), bends_ ? 1 / c : 1 / std::sqrt(c)};
}

/// In their order along the edge. None where the face does not leave the plane.
std::optional<std::vector<TouchedEdge::Place>> TouchedEdge::samples() const {
  std::vector<Place> result;
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    for (int k = s == 0 ? 0 : 1; k <= touch_samples; ++k) {
      const double share = double(k) / touch_samples;
      const double t = sides_[s].forwards ? share : 1 - share;
      if (!(fall(sides_[s], t) > least_fall)) return std::nullopt;
      result.push_back(place(s, t));
    }
  }
  return result;
}

/// The highest point of the curve across the edge at the place, where the plane has turned about
/// the edge.
std::optional<Contact> TouchedEdge::highest_beside(const Place& p, double turn) const {
  const EdgeSide& side = sides_[p.side];
  const bool is_u = along_v(side.side);
  const double sense = at_upper_end(side.side) ? -1 : 1;
  const dvec3 d = across(side, 1, p.t);
  const dvec3 outward = d - glm::dot(d, along_) * along_;
  const dvec3 n = glm::normalize(n_ + turn * unit(outward));
  const double c = fall(side, p.t);
  double way = (bends_ ? turn / (2 * c) : std::sqrt(turn / (3 * c))) / glm::length(outward);
  Contact at = on_side_of(side.patch, side.side, p.t);
  double& w = is_u ? at.u : at.v;
  const double border = w;
  for (int k = 0; k < most_climbs; ++k) {
    if (!(way > 0 && way < 1)) return std::nullopt;
    w = border + sense * way;
    const ContactJet j = geometry_.jet(at);
    const double slope = sense * glm::dot(j.dx[is_u ? 0 : 1], n);
    const double second = glm::dot(is_u ? j.dxx : j.dyy, n);
    if (!(second < 0)) return std::nullopt;
    way -= slope / second;
  }
  return at;
}

/// Where the places are all on one line, so far as the lowest power of the distance tells: whether
/// in planes that have turned about the edge others than those between the ends support. These are
/// hardly lower than what does, so that queries are slow: some of them tell.
bool TouchedEdge::is_left(const std::vector<Place>& places, SupportQuery& query) const {
  const Place& first = places.front();
  const Place& last = places.back();
  const bool is_line = std::all_of(places.begin() + 1, places.end() - 1, [&](const Place& p) {
    const double share = (p.at - first.at) / (last.at - first.at);
    const double line = (1 - share) * first.value + share * last.value;
    return std::abs(p.value - line) <= least_sag * line;
  });
  if (!is_line) return false;
  for (std::size_t k = places_queried; k + 1 < places.size(); k += places_queried) {
    const std::optional<Contact> c = highest_beside(places[k], turn_beside);
    if (!c) return false;
    const dvec3 n = aligned(unit_normal(geometry_, *c), n_);
    if (query(n, *c).h <= glm::dot(geometry_.point(*c), n) + geometry_.tie()) return false;
  }
  return true;
}

/// Where the tangent goes through the chord's other end: between two places of one side, or of two
/// consecutive ones.
std::optional<TouchedEdge::Place> TouchedEdge::tangent_from(const Place& end, const Place& before,
                                                            const Place& after) const {
  const auto between = [&](std::size_t side, double from, double to) -> std::optional<Place> {
    const auto miss = [&](double t) {
      const Place p = place(side, t);
      const Place a = place(side, t - touch_difference);
      const Place b = place(side, t + touch_difference);
      return (b.value - a.value) / (b.at - a.at) * (p.at - end.at) - (p.value - end.value);
    };
    if ((miss(from) < 0) == (miss(to) < 0)) return std::nullopt;
    return place(side, bisected(miss, from, to));
  };
  if (before.side == after.side) return between(before.side, before.t, after.t);
  const auto first = between(before.side, before.t, sides_[before.side].end());
  return first ? first : between(after.side, sides_[after.side].begin(), after.t);
}

Contact TouchedEdge::on_piece(const Place& p) const {
  const EdgeSide& side = sides_[p.side];
  const bool reversed = geometry_.patch(side.patch).borders[std::size_t(side.side)].piece_reversed;
  Contact c = side.piece;
  c.u = reversed ? 1 - p.t : p.t;
  return c;
}

bool TouchedEdge::is_to_the_right() const {
  return glm::dot(across(sides_.front(), 1, 0.5), glm::cross(along_, n_)) > 0;
}

/// The face's contacts begin along the edge between these places.
void TouchedEdge::add_stretches(const Place& begin, const Place& end,
                                std::vector<SidePart>& parts) const {
  for (std::size_t s = begin.side; s <= end.side; ++s) {
    const Contact a = on_piece(s == begin.side ? begin : place(s, sides_[s].begin()));
    const Contact b = on_piece(s == end.side ? end : place(s, sides_[s].end()));
    if (std::abs(a.u - b.u) < least_stretch) continue;
    parts.push_back({geometry_.canonical(a), {a.instance, a.element, a.u, b.u}});
  }
}

std::optional<SideParts> TouchedEdge::parts(SupportQuery& query) {
  bends_ = bends();
  const std::optional<std::vector<Place>> places = samples();
  if (!places) return std::nullopt;
  const std::vector<Place>& p = *places;
  // The concave hull, by the samples on it.
  std::vector<std::size_t> corners;
  const auto chord = [&](std::size_t k, std::size_t a, std::size_t b) {
    const double share = (p[k].at - p[a].at) / (p[b].at - p[a].at);
    return (1 - share) * p[a].value + share * p[b].value;
  };
  for (std::size_t k = 0; k < p.size(); ++k) {
    const auto is_below = [&](std::size_t b) {
      return p[b].value < chord(b, corners[corners.size() - 2], k);
    };
    while (corners.size() > 1 && is_below(corners.back())) corners.pop_back();
    corners.push_back(k);
  }
  std::vector<std::size_t> chain = {0};
  for (std::size_t c = 1; c < corners.size(); ++c) {
    const std::size_t a = corners[c - 1];
    const std::size_t b = corners[c];
    bool sags = false;
    for (std::size_t k = a + 1; k < b; ++k) {
      sags = sags || p[k].value < (1 - least_sag) * chord(k, a, b);
    }
    for (std::size_t k = a + 1; !sags && k < b; ++k) chain.push_back(k);
    chain.push_back(b);
  }
  const std::size_t last = chain.size() - 2;
  const auto is_chord = [&](std::size_t k) { return chain[k + 1] > chain[k] + 1; };
  for (std::size_t k = 1; k < last; ++k) {
    if (is_chord(k)) return std::nullopt;
  }
  SideParts result;
  const Contact first = geometry_.canonical(on_piece(p.front()));
  result.end = geometry_.canonical(on_piece(p.back()));
  if ((last == 0 && is_chord(0)) || is_left(p, query)) {
    result.parts.push_back({first});
    return result;
  }
  std::optional<Place> begin = p.front();
  std::optional<Place> end = p.back();
  if (is_chord(0)) begin = tangent_from(p.front(), p[chain[1] - 1], p[chain[1] + 1]);
  if (is_chord(last)) end = tangent_from(p.back(), p[chain[last] - 1], p[chain[last] + 1]);
  if (!begin || !end) return std::nullopt;
  if (is_chord(0)) result.parts.push_back({first});
  add_stretches(*begin, *end, result.parts);
  if (is_chord(last)) result.parts.push_back({geometry_.canonical(on_piece(*end))});
  return result;
}

class StretchSearch {
 public:
  StretchSearch(const ContactGeometry& geometry, SupportQuery& query)
      : geometry_(geometry), query_(query) {}

  void search_side(const Contact& patch, Side side);
  std::vector<TouchedStretch> found();

 private:
  TouchedEdge& edge(const std::array<Contact, 2>& ends, const dvec3& n);

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  std::vector<TouchedEdge> edges_;
};

TouchedEdge& StretchSearch::edge(const std::array<Contact, 2>& ends, const dvec3& n) {
  const auto known = std::find_if(edges_.begin(), edges_.end(),
                                  [&](const TouchedEdge& e) { return e.is(ends, n); });
  return known == edges_.end() ? edges_.emplace_back(geometry_, ends, n) : *known;
}

void StretchSearch::search_side(const Contact& patch, Side side) {
  const std::optional<Contact> piece = straight_piece_or_seam(geometry_, patch, side);
  if (!piece) return;
  const auto normal = [&](double t) { return unit_normal(geometry_, on_side_of(patch, side, t)); };
  const Contact c = on_side_of(patch, side, 0.5);
  const dvec3 middle = normal(0.5);
  const bool turns = std::any_of(all_places.begin(), all_places.end(), [&](double t) {
    return glm::distance(normal(t), middle) > same_normal;
  });
  if (turns || middle == dvec3(0.0)) return;
  for (const dvec3& n : {middle, -middle}) {
    if (query_(n, c).h > glm::dot(geometry_.point(c), n) + geometry_.tie()) continue;
    edge(segment_ends(geometry_, *piece), n).add(patch, side, *piece);
  }
}

std::vector<TouchedStretch> StretchSearch::found() {
  std::vector<TouchedStretch> result;
  for (TouchedEdge& edge : edges_) {
    for (TouchedEdge& stretch : edge.stretches()) {
      std::optional<SideParts> parts = stretch.parts(query_);
      if (!parts) continue;
      if (!stretch.is_to_the_right()) *parts = reversed(*parts);
      result.push_back({stretch.n(), std::move(*parts), stretch.is_whole()});
    }
  }
  return result;
}

}  // namespace

std::vector<TouchedStretch> touched_stretches(const ContactGeometry& geometry, SupportQuery& query,
                                              const std::vector<CulledCell>& cells) {
  StretchSearch search(geometry, query);
  for (const auto& [instance, patch] : mixed_patches(cells)) {
    const Contact c{instance, SourceKind::face, patch, 0, 0};
    if (geometry.is_repeated(c) || geometry.is_ruled(c)) continue;
    for (const Side side : all_sides) search.search_side(c, side);
  }
  return search.found();
}

}  // namespace taut
