#include "taut/hull/contact/facet_contacts.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/planar/planar_hull.h"

namespace taut {
namespace {

/// Turn of the direction, in radians, by which contacts beyond a side show. A tie is won by turn
/// times distance, much more than support_tie; a contact that loses in the plane itself by more
/// than that stays hidden.
constexpr double side_turn = 1e-6;

/// Corners of facets are on a border or at a vertex that is no farther: Newton's method leaves them
/// so near to it.
constexpr double corner_distance = 1e-9;

/// Directions in which a curved side is asked for contacts beyond it differ by no more, in radians.
constexpr double side_angle = 0.2;

/// A plane's contact set, as it becomes known.
class ContactSet {
 public:
  ContactSet(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
             const std::vector<Contact>& pieces, double slack)
      : geometry_(geometry),
        query_(query),
        n_(n),
        frame_(tangent_frame(n)),
        pieces_(pieces),
        slack_(slack) {
    curves_.reserve(pieces.size());
    for (const Contact& piece : pieces) {
      std::vector<dvec3>& curve = curves_.emplace_back();
      for (const dvec4& p : geometry.curve(piece).points) {
        curve.emplace_back(in_plane(dvec3(p)), p.w);
      }
    }
  }

  void add(const Contact& c) {
    contacts_.push_back(settled(c));
    points_.push_back(geometry_.point(contacts_.back()));
  }
  std::optional<FacetContacts> complete();

 private:
  /// Of contacts that tie with the others.
  double least_height() const {
    const dvec3 x = points_.empty() ? geometry_.point(pieces_.front()) : points_.front();
    return glm::dot(x, n_) - geometry_.tie() - slack_;
  }
  double nearness() const { return std::max(corner_distance, geometry_.rounding()); }
  /// The parameter of a piece, or its end if that is no farther, or not told from it by the
  /// tangent.
  double end_or_inside(Contact piece, double t) const {
    piece.u = t;
    const double end = std::round(t);
    const dvec3 dx = geometry_.jet(piece).dx[0];
    if (std::abs(t - end) * glm::length(dx) <= nearness()) return end;
    const std::optional<Contact> level =
        at_level_border(geometry_, piece, unit(glm::cross(dx, n_)));
    return level ? level->u : t;
  }
  /// On the border that is no farther, or that the direction does not tell from where it is. On
  /// straight edges, inside of which nothing is a contact, it stays a face's.
  Contact settled(const Contact& c) const {
    const Contact inside = clamped(c);
    const Contact level = at_level_border(geometry_, inside, n_).value_or(inside);
    const Contact result = snapped(geometry_, level, nearness());
    const bool on_segment = result.kind == SourceKind::edge && geometry_.is_straight(result);
    return on_segment ? level : result;
  }
  bool is_known(const Contact& c) const {
    const dvec3 x = geometry_.point(c);
    return std::any_of(points_.begin(), points_.end(),
                       [&](const dvec3& p) { return glm::distance(p, x) <= same_contact; });
  }
  dvec2 in_plane(const dvec3& x) const { return {glm::dot(x, frame_[0]), glm::dot(x, frame_[1])}; }
  /// A direction in the plane, and how far the outline goes in it.
  struct Probe {
    dvec3 towards;
    double reach;
  };
  std::optional<FacetContacts> outline() const;
  std::vector<Probe> probes(const FacetContacts& f) const;
  bool is_beyond_end(const FacetContacts& f, const Contact& c) const;
  bool leads_level(const Contact& from, const Contact& c) const;
  std::optional<Contact> found(const dvec3& towards);

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  dvec3 n_;
  std::array<dvec3, 2> frame_;
  const std::vector<Contact>& pieces_;
  double slack_;
  std::vector<std::vector<dvec3>> curves_;
  std::vector<Contact> contacts_;
  std::vector<dvec3> points_;
};

std::optional<FacetContacts> ContactSet::outline() const {
  std::vector<dvec2> points;
  points.reserve(points_.size());
  for (const dvec3& x : points_) points.push_back(in_plane(x));
  const PlanarHull hull = planar_hull(points, curves_, geometry_.stop());
  if (!hull.verified) return std::nullopt;
  FacetContacts f;
  for (const OutlineSide& side : hull.sides) {
    Contact c;
    if (side.point >= 0) {
      c = contacts_[std::size_t(side.point)];
    } else {
      c = pieces_[std::size_t(side.curve)];
      c.u = end_or_inside(c, side.t);
      c = geometry_.canonical(c);
    }
    f.contacts.push_back(c);
    f.points.push_back(geometry_.point(c));
    EdgeStretch stretch;
    if (side.along >= 0) {
      const Contact& piece = pieces_[std::size_t(side.along)];
      stretch = {piece.instance, piece.element, end_or_inside(piece, side.from),
                 end_or_inside(piece, side.to)};
    }
    f.sides.push_back(stretch);
  }
  return f;
}

/// Where to look for contacts beyond the outline.
std::vector<ContactSet::Probe> ContactSet::probes(const FacetContacts& f) const {
  std::vector<Probe> result;
  const auto add = [&](const dvec3& x, const dvec3& towards) {
    result.push_back({towards, glm::dot(x, towards)});
  };
  const std::size_t count = f.points.size();
  for (std::size_t k = 0; k < count; ++k) {
    const dvec3& a = f.points[k];
    if (!f.is_curved(k)) {
      if (count > 1) add(a, unit(glm::cross(f.points[(k + 1) % count] - a, n_)));
      continue;
    }
    const EdgeStretch& side = f.sides[k];
    const BezierCurve curve = geometry_.curve(side.at(0));
    const double sense = side.from < side.to ? 1 : -1;
    const auto at = [&](double share) {
      return jet(curve, (1 - share) * side.from + share * side.to);
    };
    const auto outward = [&](double share) { return unit(glm::cross(sense * at(share).ct, n_)); };
    // The middle, and more of them where the side turns.
    double step = 0.5;
    while (step > 1.0 / 64 && glm::distance(outward(0), outward(step)) > side_angle) step /= 2;
    for (double share = 0; share <= 1; share += step) add(at(share).c, outward(share));
  }
  return result;
}

/// A contact that ties with the others, seen from a direction turned by `towards`.
std::optional<Contact> ContactSet::found(const dvec3& towards) {
  const Contact& hint = contacts_.empty() ? pieces_.front() : contacts_.front();
  const Support s = query_(glm::normalize(n_ + side_turn * towards), hint);
  const Contact start = at_rest(geometry_, s.contact, n_);
  std::optional<Contact> c = climbed(geometry_, start, n_);
  if (!c) {
    // Towards a corner in which its element is flat.
    c = start;
    c->u = std::round(start.u);
    c->v = std::round(start.v);
  }
  if (glm::dot(geometry_.point(*c), n_) < least_height()) return std::nullopt;
  return settled(*c);
}

/// From the end of a piece on, other edges lead to the contact that are not straight and leave the
/// plane by no more than a tie.
bool ContactSet::leads_level(const Contact& from, const Contact& c) const {
  const dvec3 x = geometry_.point(c);
  return found_on_edge(geometry_, from, [&](const Contact& begin, const Contact& end) {
    if (geometry_.is_straight(begin)) return EdgeVisit::lost;
    const dvec3 there = geometry_.point(end);
    if (same_element(begin, c) || glm::distance(there, x) <= same_contact) return EdgeVisit::found;
    return glm::dot(there, n_) < least_height() ? EdgeVisit::lost : EdgeVisit::on;
  });
}

/// The contact is where the end of a curved side of the outline goes on so nearly in the plane that
/// support values do not tell where it leaves it.
bool ContactSet::is_beyond_end(const FacetContacts& f, const Contact& c) const {
  const auto starts = [&](const EdgeStretch& side, double t) {
    const Contact end = side.at(t);
    std::vector<Contact> result;
    if (t != 0 && t != 1) return result;
    const std::optional<Contact> next = beyond(geometry_, end, {ContactExit::Kind::end, int(t)});
    if (next && next->kind == SourceKind::edge) result.push_back(*next);
    if (!next || next->kind != SourceKind::vertex) return result;
    for (const Contact& begin : piece_ends(geometry_, *next)) {
      if (!same_element(begin, end)) result.push_back(begin);
    }
    return result;
  };
  for (std::size_t k = 0; k < f.points.size(); ++k) {
    if (!f.is_curved(k)) continue;
    for (const double t : {f.sides[k].from, f.sides[k].to}) {
      for (const Contact& start : starts(f.sides[k], t)) {
        if (leads_level(start, c)) return true;
      }
    }
  }
  return false;
}

std::optional<FacetContacts> ContactSet::complete() {
  const bool finite =
      std::all_of(points_.begin(), points_.end(), [](const dvec3& x) { return is_finite(x); });
  if (!finite || !is_finite(n_)) return std::nullopt;
  while (points_.size() <= facet_corner_limit) {
    std::optional<FacetContacts> f = outline();
    if (!f || f->contacts.empty()) return std::nullopt;
    bool grown = false;
    for (const Probe& probe : probes(*f)) {
      const std::optional<Contact> more = found(probe.towards);
      if (!more || is_known(*more) ||
          glm::dot(geometry_.point(*more), probe.towards) <= probe.reach + same_contact ||
          is_beyond_end(*f, *more)) {
        continue;
      }
      add(*more);
      grown = true;
    }
    if (!grown) return f;
  }
  return std::nullopt;
}

}  // namespace

bool FacetContacts::is_curved() const {
  return std::any_of(sides.begin(), sides.end(),
                     [](const EdgeStretch& side) { return side.piece >= 0; });
}

std::optional<FacetContacts> facet_contacts(const ContactGeometry& geometry, SupportQuery& query,
                                            const dvec3& n, const std::vector<Contact>& known,
                                            const std::vector<Contact>& pieces, double slack) {
  ContactSet set(geometry, query, n, pieces, slack);
  for (const Contact& c : known) set.add(c);
  return set.complete();
}

}  // namespace taut
