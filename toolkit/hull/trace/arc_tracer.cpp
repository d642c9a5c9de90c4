#include "taut/hull/trace/arc_tracer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/in_line_contacts.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/trace/arc_pieces.h"
#include "taut/hull/trace/curve_point.h"
#include "taut/hull/trace/element_changes.h"
#include "taut/hull/trace/level_way.h"
#include "taut/hull/trace/merging.h"
#include "taut/hull/trace/tied_end.h"

namespace taut {
namespace {

/// Lengths are in (n, x_0, x_1), in the scene's frame, whose size is about one.
constexpr double first_step = 0.02;
constexpr double longest_step = 0.12;
constexpr double shortest_step = 1e-11;
/// Steps longer than this are halved where a border is crossed in a place that is not found; what a
/// shorter one crosses is rounding.
constexpr double border_step = 1e-7;
/// A step is halved where the tangent turns by more than the one cosine tells, and the next one
/// grows where it turns by less than the other.
constexpr double turn_limit = 0.97;
constexpr double turn_small = 0.995;
constexpr double step_growth = 1.6;
/// A plane may lie behind the last ruling by this much: a third contact that surpasses the two by
/// less than geometry_.tie() went unseen.
constexpr double plane_slack = 1e-6;
constexpr int step_limit = 4000;
/// Steps below this share of the distance between two contacts are stuck.
constexpr double stuck_share = 0.01;
/// Changes of elements without progress after which the curve is lost.
constexpr int idle_limit = 12;
constexpr int bisection_limit = 60;
/// Contacts nearer than this are lost where support values tell them apart.
constexpr double lost_distance = 1e-6;
/// Contacts that end and hop to others that tie with them, at most, and the first step after that.
constexpr int hop_limit = 16;
constexpr double level_hop_step = 1e-6;
/// Contacts nearer to borders than this run along them, or come to them by themselves.
constexpr double told_distance = 1e-9;

/// The largest turn in which curves leave flat ends: the nearer they are, the less do contacts tell
/// the direction.
constexpr double flat_end_turn = 0.05;

class Trace {
 public:
  Trace(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
        std::span<const Landmark> landmarks)
      : system_(system),
        geometry_(system.geometry()),
        landmarks_(landmarks),
        point_(system, query, start),
        passage_(point_),
        changes_(point_) {}

  TracedArc run(const Progress& progress, bool aside);

 private:
  enum class Pace { on, ended };
  /// A contact on a border of its element, and the exit there.
  struct BorderExit {
    Contact contact;
    ContactExit exit;
  };

  bool leave(bool chord = false);
  bool pass_pole(int contact, Side side);
  bool arrives(const Landmark& landmark);
  bool ends_in_landmark(const CommonSupport& end);
  bool ends_in_flat_facet(const CommonSupport& end);
  std::optional<Pace> reaches_flat_ends();
  bool go_onto_edges();
  bool goes_off_edges(const CommonSupport& next);
  bool is_closing(const CommonSupport& next, double length) const;
  void close();
  bool ends_in(std::optional<MergedEnd> end);
  std::optional<Pace> near_merging();
  Pace surpassed(const CommonSupport& next, const Contact& winner);
  bool is_at_own_vertex(const CommonSupport& plane) const;
  bool ends_in_tie(const CommonSupport& next, std::size_t contact, const Contact& third);
  std::optional<Pace> beside_edge(const CommonSupport& next,
                                  const std::optional<ElementChange>& event);
  bool ends_in_line(const Contact& winner);
  bool ends_widened();
  void settle_flat_ends();
  std::optional<BorderExit> level_exit(std::size_t i) const;
  void settle_at_segment(std::size_t i);
  bool hop(std::size_t i, const ContactExit& exit);
  bool hops_ahead();
  Pace exchange(const ElementChange& event);
  Pace advance();
  void begin_piece(const Ruling& first);
  void continue_in_piece();
  bool enter_level(std::size_t contact);
  bool is_sound() const;
  void push(const Ruling& ruling) { arc_.pieces.back().rulings.push_back(on_joins(ruling)); }
  Ruling on_joins(Ruling ruling) const;
  void end_on_joins(const std::array<Contact, CommonSupport::capacity>& before);

  Pace ended(TracedArc::End end) {
    arc_.end = end;
    return Pace::ended;
  }
  Pace lost(const char* reason) {
    arc_.reason = reason;
    return ended(TracedArc::End::lost);
  }
  /// Where nothing tells the contacts apart the curve ends.
  Pace lost_or_tied(const char* reason) {
    if (ends_in(tied_end(point_))) return Pace::ended;
    return hops_ahead() ? Pace::on : lost(reason);
  }
  /// Halves the step, unless that is of no use any more.
  Pace shorter(const char* reason) {
    step_ *= 0.5;
    return step_ < shortest_step ? lost_or_tied(reason) : Pace::on;
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  std::span<const Landmark> landmarks_;
  /// The first ruling inside a piece, at which the curve closes if it does.
  std::optional<CommonSupport> home_;
  std::size_t home_piece_ = 0;
  std::size_t home_ruling_ = 0;
  CurvePoint point_;
  PolePassage passage_;
  ElementChanges changes_;
  double step_ = first_step;
  int idle_ = 0;
  int hops_ = 0;
  bool has_moved_ = false;
  bool lenient_ = false;  ///< borders that this piece crosses in places not found are rounding
  TracedArc arc_;
};

/// The first step away from where contacts are singular, in a piece of its own.
bool Trace::leave(bool chord) {
  const std::optional<Ruling> first = chord ? passage_.leave_chord() : passage_.leave();
  if (!first) return false;
  begin_piece(*first);
  push(point_.at.ruling());
  return true;
}

/// Goes to a pole within the step, and on beyond it.
bool Trace::pass_pole(int contact, Side side) {
  if (!passage_.reach(contact, side, step_)) return false;
  push(point_.at.ruling());
  return leave();
}

/// Ends the arc in a landmark that lies within the step.
bool Trace::arrives(const Landmark& landmark) {
  if (const std::optional<Ruling> end = passage_.arrival(landmark, step_)) {
    push(*end);
    arc_.n = landmark.n;
    arc_.contacts = landmark.facet.contacts;
    return true;
  }
  return false;
}

/// Ends the arc where its contacts' elements are flat, if that is across a side of a landmark.
bool Trace::ends_in_landmark(const CommonSupport& end) {
  for (const Landmark& landmark : landmarks_) {
    const FacetContacts& facet = landmark.facet;
    if (glm::distance(landmark.n, end.n) > same_contact) continue;
    for (std::size_t k = 0; k < facet.points.size(); ++k) {
      const dvec3& next = facet.points[(k + 1) % facet.points.size()];
      if (facet.is_curved(k) || glm::distance(facet.points[k], end.jet[1].x) > same_contact ||
          glm::distance(next, end.jet[0].x) > same_contact) {
        continue;
      }
      const std::array<Contact, 2> corner = {facet.contacts[(k + 1) % facet.points.size()],
                                             facet.contacts[k]};
      CommonSupport last = end;
      last.n = landmark.n;
      for (std::size_t i = 0; i < 2; ++i) {
        last.contact[i] = expressed_in(geometry_, corner[i], end.contact[i]).value_or(corner[i]);
      }
      last.evaluate(geometry_);
      push(last.ruling());
      arc_.n = landmark.n;
      arc_.contacts = facet.contacts;
      return true;
    }
  }
  return false;
}

/// Ends the arc where its contacts' elements are flat, if that is in a facet and in no landmark.
bool Trace::ends_in_flat_facet(const CommonSupport& end) {
  if (is_landmark(landmarks_, end.n)) return false;
  std::optional<FacetContacts> f =
      facet_contacts(geometry_, point_.query(), end.n, {end.contact[0], end.contact[1]});
  if (!f || !f->is_facet()) return false;
  push(end.ruling());
  arc_.n = end.n;
  arc_.contacts = std::move(f->contacts);
  return true;
}

/// Goes to where both contacts' elements are flat at their ends, and on beyond both, or the one's.
std::optional<Trace::Pace> Trace::reaches_flat_ends() {
  const std::optional<CommonSupport> end = passage_.at_flat_ends(2 * step_);
  if (!end) return std::nullopt;
  if (ends_in_landmark(*end)) return ended(TracedArc::End::plane);
  const CommonSupport before = point_.at;
  point_.at = *end;
  if (go_onto_edges()) return Pace::on;
  const auto is_on_edge = [&](const Contact& c) { return c.kind == SourceKind::edge; };
  const bool on_edges = is_on_edge(end->contact[0]) && is_on_edge(end->contact[1]);
  std::optional<Ruling> first = passage_.go_on();
  // On faces both contacts may go on another way than they came.
  if (!first && !on_edges) first = passage_.leave(flat_end_turn);
  if (first) {
    push(end->ruling());
    has_moved_ = true;
    begin_piece(*first);
    push(point_.at.ruling());
    return Pace::on;
  }
  if (!on_edges) {
    point_.at = before;
    return ends_in_flat_facet(*end) ? std::optional(ended(TracedArc::End::plane)) : std::nullopt;
  }
  push(end->ruling());
  has_moved_ = true;
  ElementChange event;
  event.contact = 0;
  event.exit = {ContactExit::Kind::end, int(end->contact[0].u)};
  event.support = *end;
  return exchange(event);
}

/// Both contacts stand on sides, no corners, beyond which they are on edges or seams: goes on
/// there.
bool Trace::go_onto_edges() {
  const CommonSupport end = point_.at;
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = point_.at.contact[i];
    int on_sides = 0;
    std::optional<Contact> edge;
    for (const ContactExit& exit : exits(geometry_, c)) {
      if (exit.kind != ContactExit::Kind::side || !stands_at(c, exit)) continue;
      ++on_sides;
      edge = beyond(geometry_, c, exit);
    }
    if (on_sides != 1 || !edge || edge->kind != SourceKind::edge) {
      point_.at = end;
      return false;
    }
    c = *edge;
  }
  point_.at.evaluate(geometry_);
  if (!point_.settle()) {
    point_.at = end;
    return false;
  }
  push(end.ruling());
  has_moved_ = true;
  begin_piece(point_.at.ruling());
  return true;
}

/// Contacts on edges or seams have patches beside them that are level across, and rise within the
/// step (swells_beside): goes to where that begins, and on into the patches.
bool Trace::goes_off_edges(const CommonSupport& next) {
  const auto swells = [&](const CommonSupport& s) {
    return swells_beside(geometry_, s.contact[0], s.n) ||
           swells_beside(geometry_, s.contact[1], s.n);
  };
  if (swells(point_.at) || !swells(next)) return false;
  const CommonSupport before = point_.at;
  CommonSupport last = point_.at;
  double low = 0;
  double high = step_;
  for (int k = 0; k < bisection_limit && high - low > margin_slack; ++k) {
    const double middle = 0.5 * (low + high);
    const std::optional<CommonSupport> s = point_.stepped(middle);
    if (!s) return false;
    if (!swells(*s)) last = *s;
    (swells(*s) ? high : low) = middle;
  }
  if (!point_.supports(last)) return false;
  point_.at = last;
  const std::optional<Ruling> first = passage_.leave(flat_end_turn);
  if (!first) {
    point_.at = before;
    return false;
  }
  if (low > plane_slack) push(last.ruling());
  has_moved_ = true;
  begin_piece(*first);
  push(point_.at.ruling());
  return true;
}

/// Ends the arc as told, if it is.
bool Trace::ends_in(std::optional<MergedEnd> end) {
  if (!end) return false;
  const std::vector<Ruling>& rest = end->pieces.front().rulings;
  std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
  rulings.insert(rulings.end(), rest.begin() + 1, rest.end());
  arc_.pieces.insert(arc_.pieces.end(), std::next(end->pieces.begin()), end->pieces.end());
  arc_.n = end->n;
  arc_.contacts = std::move(end->contacts);
  arc_.end = arc_.contacts.empty() ? TracedArc::End::merged : TracedArc::End::crossed;
  return true;
}

bool Trace::is_closing(const CommonSupport& next, double length) const {
  if (!home_ || !same_element(home_->contact[0], point_.at.contact[0]) ||
      !same_element(home_->contact[1], point_.at.contact[1])) {
    return false;
  }
  const double ahead = point_.length_to(*home_);
  if (ahead <= margin_slack || ahead > point_.length_to(next) + margin_slack) return false;
  if (point_.distance_to(*home_) > 1.5 * length) return false;
  const std::optional<CommonSupport> there = point_.stepped(ahead);
  return there && glm::distance(there->n, home_->n) < same_contact &&
         glm::distance(there->jet[0].x, home_->jet[0].x) < same_contact &&
         glm::distance(there->jet[1].x, home_->jet[1].x) < same_contact;
}

/// Ends the arc at home, and drops what led there from the start.
void Trace::close() {
  push(home_->ruling());
  auto& first = arc_.pieces[home_piece_].rulings;
  first.erase(first.begin(), first.begin() + std::ptrdiff_t(home_ruling_));
  arc_.pieces.erase(arc_.pieces.begin(), arc_.pieces.begin() + std::ptrdiff_t(home_piece_));
}

/// Begins a piece with this ruling, in the elements of the point.
void Trace::begin_piece(const Ruling& first) {
  if (!arc_.pieces.empty() && arc_.pieces.back().rulings.size() < 2) arc_.pieces.pop_back();
  arc_.pieces.emplace_back();
  lenient_ = false;
  push(first);
  changes_.begin();
}

/// Begins a piece where the last one ends: a contact that stays in its element does so in the same
/// place, which steps too short to count may have left.
void Trace::continue_in_piece() {
  Ruling first = point_.at.ruling();
  Ruling& last = arc_.pieces.back().rulings.back();
  if (arc_.pieces.back().rulings.size() < 2 && arc_.pieces.size() > 1) {
    // It is dropped: the one before ends there.
    set_places(geometry_, arc_.pieces[arc_.pieces.size() - 2].rulings.back(), last);
  }
  set_places(geometry_, first, last);
  begin_piece(first);
}

/// The ruling with contacts that are beyond a smooth join or the end of a piece, and have not left
/// their element, on it.
Ruling Trace::on_joins(Ruling ruling) const {
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = ruling.contact[i];
    const dvec2 inside(std::clamp(c.u, 0.0, 1.0), std::clamp(c.v, 0.0, 1.0));
    if (inside == dvec2(c.u, c.v)) continue;
    c.u = inside.x;
    c.v = inside.y;
    ruling.point[i] = geometry_.point(c);
  }
  return ruling;
}

/// Puts the last ruling's contacts that have been told since as ones of the patches beyond joins,
/// being hardly off them, on the joins.
void Trace::end_on_joins(const std::array<Contact, CommonSupport::capacity>& before) {
  Ruling& last = arc_.pieces.back().rulings.back();
  for (std::size_t k = 0; k < 2; ++k) {
    const Contact& now = point_.at.contact[k];
    if (same_element(now, before[k]) || !same_element(last.contact[k], before[k])) continue;
    const std::optional<Contact> own = expressed_in(geometry_, now, before[k]);
    if (!own) continue;
    last.contact[k] = *own;
    last.point[k] = geometry_.point(*own);
  }
}

/// All numbers are finite: Newton's method may end in anything on surfaces without tangent planes.
bool Trace::is_sound() const {
  return std::all_of(arc_.pieces.begin(), arc_.pieces.end(), [](const ArcPiece& piece) {
    return std::all_of(piece.rulings.begin(), piece.rulings.end(), [](const Ruling& r) {
      return is_finite(r.n) && is_finite(r.point[0]) && is_finite(r.point[1]);
    });
  });
}

/// Where the step would take the two contacts into each other: shortens it, until they are so near
/// that they merge.
std::optional<Trace::Pace> Trace::near_merging() {
  const double apart = point_.apart();
  const double rate = point_.rate_apart();
  if (rate >= 0 || apart >= -2 * rate * step_) return std::nullopt;
  if (apart >= merging_distance(geometry_)) {
    step_ = -0.5 * apart / rate;
    return std::nullopt;
  }
  if (ends_in(merged_end(point_))) return Pace::ended;
  if (apart < std::min(1.0, -rate) * least_distance_at(point_)) {
    if (ends_in(tied_end(point_))) return Pace::ended;
    if (apart < lost_distance) return lost("two contacts approach each other and do not merge");
  }
  // A third contact may yet surpass them.
  step_ = -0.5 * apart / rate;
  return std::nullopt;
}

/// A contact that surpasses the two has been between them in line: ends the arc where it leaves the
/// element that it has been in.
bool Trace::ends_in_line(const Contact& winner) {
  const std::optional<Contact> third = between_in_line(geometry_, point_.at, winner);
  if (!third) return false;
  CommonSupport last = point_.at;
  Contact between = *third;  // at the last one
  double low = 0;
  double high = step_;
  for (int k = 0; k < bisection_limit && high - low > margin_slack; ++k) {
    const double middle = 0.5 * (low + high);
    const std::optional<CommonSupport> s = point_.stepped(middle);
    if (!s) return false;
    const std::optional<Contact> there = between_in_line(geometry_, *s, *third);
    if (there && same_element(*there, *third)) {
      low = middle;
      last = *s;
      between = *there;
    } else {
      high = middle;
    }
  }
  // It surpasses them from within its element, or what it changes into has done so before.
  if (high == step_ || !point_.supports(last)) return false;
  if (low > plane_slack) {
    push(last.ruling());
  } else {  // where the trace stands already
    last = point_.at;
    between = *third;
  }
  arc_.n = last.n;
  arc_.contacts = {last.contact[0], last.contact[1], between};
  return true;
}

/// Puts the arc's last contacts on borders of their elements that are so near that, the elements
/// being flat there, the direction does not tell them from where they are.
void Trace::settle_flat_ends() {
  Ruling& last = arc_.pieces.back().rulings.back();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> border = at_level_border(geometry_, last.contact[i], last.n);
    if (!border) continue;
    last.contact[i] = *border;
    last.point[i] = geometry_.point(*border);
  }
}

/// Where a contact has changed its element: ends the arc if beyond the two another one is in line
/// with them from there on.
bool Trace::ends_widened() {
  const std::optional<CommonSupport> wide = widened(geometry_, point_.query(), point_.at);
  if (!wide) return false;
  settle_flat_ends();
  arc_.n = point_.at.n;
  const Ruling& last = arc_.pieces.back().rulings.back();
  arc_.contacts = {last.contact[0], last.contact[1], wide->contact[0], wide->contact[1]};
  return true;
}

/// The third contact of a plane is in a face, and in the plane too is a vertex of it at which one
/// of the other two is: support values do not tell the two places apart.
bool Trace::is_at_own_vertex(const CommonSupport& plane) const {
  const std::optional<EdgeBeside> beside = tied_edge(geometry_, plane.contact[2], plane.n);
  if (!beside) return false;
  const Contact vertex = geometry_.canonical(beside->edge);
  return vertex.kind == SourceKind::vertex &&
         (same_element(vertex, plane.contact[0]) || same_element(vertex, plane.contact[1]));
}

/// A contact surpasses the two at `next`: ends the arc in the plane of the three.
Trace::Pace Trace::surpassed(const CommonSupport& next, const Contact& winner) {
  if (ends_in_line(winner)) return ended(TracedArc::End::plane);
  std::optional<CommonSupport> plane = common_plane(system_, point_.query(), next, winner);
  if (plane) {
    for (std::size_t i = 0; i < 2; ++i) {
      // In a pole, from where the curve comes.
      Contact& c = plane->contact[i];
      if (pole_side(geometry_, c)) c = in_element(geometry_, c, point_.at.contact[i]).value_or(c);
    }
    plane->evaluate(geometry_);
  }
  const double there = plane ? point_.length_to(*plane) : 0;
  if (!plane || is_at_own_vertex(*plane) || there < -plane_slack ||
      there > point_.length_to(next) + plane_slack) {
    return shorter("no common plane with a contact that surpasses two");
  }
  if (step_ > border_step && there > plane_slack &&
      !point_.is_followed(point_.at.ruling(), plane->ruling())) {
    return shorter("the rulings before a common plane are not found");
  }
  std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
  if (there <= 0 && rulings.size() > 1) rulings.pop_back();
  push(plane->ruling());
  arc_.n = plane->n;
  arc_.contacts.assign(plane->contact.begin(), plane->contact.end());
  return ended(TracedArc::End::plane);
}

/// Ends the arc in the plane of the two contacts and a third one, which surpasses the one of them
/// by less than support values tell: within the step, or behind, where it went unseen.
bool Trace::ends_in_tie(const CommonSupport& next, std::size_t contact, const Contact& third) {
  const std::optional<CommonSupport> plane = common_plane(system_, point_.query(), next, third);
  if (!plane || same_element(plane->contact[2], plane->contact[contact])) return false;
  const double apart = glm::distance(plane->jet[2].x, plane->jet[contact].x);
  const double there = point_.length_to(*plane);
  if (there > point_.length_to(next) || there < -apart) return false;
  std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
  const auto is_beyond = [&](const Ruling& r) {
    return point_.length_along(r.n, r.point[0], r.point[1]) >= there;
  };
  while (rulings.size() > 1 && is_beyond(rulings.back())) rulings.pop_back();
  push(plane->ruling());
  arc_.n = plane->n;
  arc_.contacts.assign(plane->contact.begin(), plane->contact.end());
  return true;
}

/// Beside an edge across which its face is level, a face's contact gives way to one on the edge
/// before it reaches it, and one on the edge to one in the face before it slides into it. Where the
/// two are so near that support values do not tell which is higher, their common plane does. What
/// is too near for a plane is one place, where the contact goes on in the other element.
std::optional<Trace::Pace> Trace::beside_edge(const CommonSupport& next,
                                              const std::optional<ElementChange>& event) {
  if (event) {
    const auto i = std::size_t(event->contact);
    const std::optional<Contact> inside =
        tied_inside(geometry_, next.contact[i], event->exit, next.n);
    if (inside && ends_in_tie(next, i, *inside)) return ended(TracedArc::End::plane);
    return std::nullopt;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<EdgeBeside> beside = tied_edge(geometry_, next.contact[i], next.n);
    if (!beside || beside->edge.kind != SourceKind::edge) continue;
    if (ends_in_tie(next, i, beside->edge)) return ended(TracedArc::End::plane);
    const double apart = glm::distance(geometry_.point(beside->edge), next.jet[i].x);
    if (apart > plane_slack) continue;
    ElementChange change;
    change.contact = int(i);
    change.exit = beside->exit;
    change.support = next;
    change.support.contact[i] =
        expressed_in(geometry_, beside->edge, next.contact[i]).value_or(next.contact[i]);
    put_on_border(geometry_, change);
    point_.at = change.support;
    push(point_.at.ruling());
    has_moved_ = true;
    return exchange(change);
  }
  return std::nullopt;
}

/// The contact has come from an edge into a face that is level across it, where the system is
/// singular: moves it to where the direction, by the third derivative, puts it in the face.
bool Trace::enter_level(std::size_t contact) {
  const Contact border = point_.at.contact[contact];
  const std::optional<Contact> inside = inside_level(geometry_, border, point_.at.n);
  if (!inside) return false;
  const Ruling first = point_.at.ruling();
  const CommonSupport before = point_.at;
  point_.at.contact[contact] = *inside;
  point_.at.evaluate(geometry_);
  if (!point_.settle() || !same_element(point_.at.contact[contact], border)) {
    point_.at = before;
    return false;
  }
  begin_piece(first);
  push(point_.at.ruling());
  return true;
}

/// The border of contact i's element, and the exit there, for which it heads and which the
/// direction does not tell from where it is.
std::optional<Trace::BorderExit> Trace::level_exit(std::size_t i) const {
  const Contact& c = point_.at.contact[i];
  const std::optional<Contact> border = at_level_border(geometry_, c, point_.at.n);
  if (!border || glm::distance(geometry_.point(*border), geometry_.point(c)) < told_distance) {
    return std::nullopt;
  }
  for (const ContactExit& exit : exits(geometry_, c)) {
    const Contact there = at_exit(*border, exit);
    const bool is_on = there.u == border->u && there.v == border->v;
    if (!leads_over_border(exit) || !is_on) continue;
    const LinearEquation margin = exit_margin(geometry_, point_.at, int(i), exit);
    if (margin.residual > 0 && glm::dot(margin.parameter[i], point_.tangent.parameter[i]) < 0) {
      return BorderExit{*border, exit};
    }
  }
  return std::nullopt;
}

/// Tells the contact, at the end of an edge, as one at the vertex there, if the other one is at a
/// vertex from which a straight edge leads to that: the direction turns about the edge, and slides
/// nothing along the other one.
void Trace::settle_at_segment(std::size_t i) {
  const Contact& other = point_.at.contact[1 - i];
  Contact& own = point_.at.contact[i];
  if (own.kind != SourceKind::edge || other.kind != SourceKind::vertex) return;
  const Contact vertex = snapped(geometry_, own, told_distance);
  if (vertex.kind != SourceKind::vertex) return;
  for (const Contact& piece : piece_ends(geometry_, vertex)) {
    if (!geometry_.is_straight(piece)) continue;
    if (same_element(geometry_.straight_end(piece, 1 - int(piece.u)), other)) {
      own = vertex;
      return;
    }
  }
}

/// Takes the contact over the exit at which it stands.
bool Trace::hop(std::size_t i, const ContactExit& exit) {
  const std::optional<Contact> over = beyond(geometry_, point_.at.contact[i], exit);
  if (over) point_.at.contact[i] = *over;
  return over.has_value();
}

/// Where a contact ends, its element becoming flat, but another one near by ties with it: goes on
/// from there, over level ground.
bool Trace::hops_ahead() {
  const CommonSupport start = point_.at;
  const std::size_t faster =
      glm::length(point_.tangent.x[0]) >= glm::length(point_.tangent.x[1]) ? 0 : 1;
  for (const std::size_t i : {faster, 1 - faster}) {
    if (hops_ >= hop_limit) return false;
    const std::optional<LevelStep> ahead =
        tied_ahead(geometry_, start.contact[i], point_.tangent.parameter[i], start.n);
    if (!ahead) continue;
    ++hops_;
    for (const WayCrossing& crossing : ahead->way) {
      point_.at.contact[i] = crossing.from;
      point_.at.evaluate(geometry_);
      push(point_.at.ruling());
      point_.at.contact[i] = crossing.to;
      point_.at.evaluate(geometry_);
      begin_piece(point_.at.ruling());
    }
    point_.at.contact[i] = ahead->to;
    point_.at.evaluate(geometry_);
    point_.tangent = CurveTangent();
    if (!point_.settle()) return false;
    push(point_.at.ruling());
    if (!ahead->way.empty()) begin_piece(point_.at.ruling());
    step_ = level_hop_step;
    return true;
  }
  return false;
}

/// On to the next element, at the exit where the contact stands. It, and the other contact, may be
/// at one more exit, as far as the direction tells.
Trace::Pace Trace::exchange(const ElementChange& event) {
  const auto i = std::size_t(event.contact);
  const std::array<std::optional<BorderExit>, 2> level = {level_exit(0), level_exit(1)};
  const SourceKind kind = point_.at.contact[i].kind;
  Ruling& last = arc_.pieces.back().rulings.back();
  for (std::size_t k = 0; k < 2; ++k) {
    if (level[k]) point_.at.contact[k] = level[k]->contact;
    if (k != i && !level[k]) continue;
    // The piece ends with the contact on its exit, which a step too short to count has not told.
    last.contact[k] = point_.at.contact[k];
    last.point[k] = geometry_.point(last.contact[k]);
  }
  bool leads_on = hop(i, event.exit);
  if (leads_on && level[1 - i]) leads_on = hop(1 - i, level[1 - i]->exit);
  if (leads_on && !level[1 - i]) settle_at_segment(1 - i);
  if (!leads_on) return lost("a separating curve has no next element");
  const Contact& next = point_.at.contact[i];
  if (level[i] && next.kind == SourceKind::edge && (next.u == 0 || next.u == 1)) {
    hop(i, {ContactExit::Kind::end, int(next.u)});
  }
  point_.at.evaluate(geometry_);
  const bool other_kind = kind != point_.at.contact[i].kind;
  if (other_kind && has_moved_ && ends_widened()) return ended(TracedArc::End::plane);
  if (event.exit.kind == ContactExit::Kind::face && enter_level(i)) return Pace::on;
  // Onto an edge that begins without a bend.
  if (event.exit.kind == ContactExit::Kind::edge && passage_.is_singular(int(i)) && leave()) {
    return Pace::on;
  }
  const std::array<Contact, CommonSupport::capacity> before = point_.at.contact;
  if (!point_.settle()) return lost("a separating curve has no tangent");
  end_on_joins(before);
  point_.head_into(i);
  continue_in_piece();
  step_ = std::max(0.5 * step_, shortest_step);
  return Pace::on;
}

Trace::Pace Trace::advance() {
  if (const std::optional<Pace> pace = near_merging()) return *pace;
  for (const Landmark& landmark : landmarks_) {
    if (arrives(landmark)) return ended(TracedArc::End::plane);
  }
  if (const std::optional<Pace> pace = reaches_flat_ends()) return *pace;
  std::optional<CommonSupport> next = point_.stepped(step_);
  const std::optional<CurveTangent> turned =
      next ? system_.tangent(*next, &point_.tangent) : std::nullopt;
  const double cosine = turned ? glm::dot(turned->n, point_.tangent.n) +
                                     glm::dot(turned->x[0], point_.tangent.x[0]) +
                                     glm::dot(turned->x[1], point_.tangent.x[1])
                               : 0;
  if (cosine < turn_limit || point_.distance_to(*next) > (1 + correction_limit) * step_) {
    // The nearer the contacts are to merging, the worse the system is conditioned.
    const double apart = point_.apart();
    if (point_.rate_apart() < 0 && apart < 2 * merging_distance(geometry_) &&
        step_ < stuck_share * apart && ends_in(merged_end(point_))) {
      return Pace::ended;
    }
    return shorter("a separating curve cannot be followed");
  }
  if (const auto [contact, side] = changes_.pole_crossed(*next); contact >= 0) {
    return pass_pole(contact, side) ? Pace::on
                                    : shorter("a separating curve cannot be followed past a pole");
  }
  bool known = true;
  const std::optional<ElementChange> event = changes_.first(*next, step_, known);
  if (!known && !lenient_) {
    if (step_ > border_step) {
      return shorter("a separating curve cannot be followed over a border");
    }
    lenient_ = true;
  }
  if (event) next = event->support;
  if (is_closing(*next, step_)) {
    close();
    return ended(TracedArc::End::closed);
  }
  if (!event && goes_off_edges(*next)) return Pace::on;
  const Support top = point_.query()(next->n, next->contact[0]);
  if (top.h > glm::dot(next->jet[0].x, next->n) + geometry_.tie()) {
    return surpassed(*next, top.contact);
  }
  if (const std::optional<Pace> pace = beside_edge(*next, event)) return *pace;
  if (step_ > border_step && !point_.is_followed(point_.at.ruling(), next->ruling())) {
    return shorter("the rulings between two of a separating curve are not found");
  }
  const bool moved = point_.length_to(*next) > margin_slack;
  idle_ = moved ? 0 : idle_ + 1;
  if (idle_ > idle_limit) return lost("a separating curve stays on a border");
  point_.at = *next;
  if (moved) push(point_.at.ruling());
  has_moved_ = has_moved_ || moved;
  if (event) return exchange(*event);
  if (moved && !home_) {
    home_ = point_.at;
    home_piece_ = arc_.pieces.size() - 1;
    home_ruling_ = arc_.pieces.back().rulings.size() - 1;
  }
  point_.tangent = *turned;
  step_ = std::min(longest_step, cosine > turn_small ? step_growth * step_ : step_);
  return Pace::on;
}

TracedArc Trace::run(const Progress& progress, bool aside) {
  if (aside || passage_.is_singular(0) || passage_.is_singular(1)) {
    if (!leave() && !(aside && leave(true))) {
      lost("a separating curve cannot be followed from a pole or a flat point");
    }
  } else if (point_.settle()) {
    begin_piece(point_.at.ruling());
  } else {
    lost("a separating curve has no tangent");
  }
  Pace pace = arc_.pieces.empty() ? Pace::ended : Pace::on;
  for (int k = 0; pace != Pace::ended; ++k) {
    if (k % 64 == 0) progress.check();
    pace = k < step_limit ? advance() : lost("a separating curve has no end");
  }
  if (!is_sound()) lost("a separating curve is not finite");
  for (ArcPiece& piece : arc_.pieces) divide_flat_ends(system_, piece.rulings);
  drop_empty_pieces(geometry_, arc_.pieces);
  if (arc_.end == TracedArc::End::closed && arc_.pieces.front().rulings.size() < 2) {
    lost("a separating curve closes where it stands");
  }
  return std::move(arc_);
}

}  // namespace

TracedArc trace_arc(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
                    std::span<const Landmark> landmarks, const Progress& progress, bool aside) {
  return Trace(system, query, start, landmarks).run(progress, aside);
}

}  // namespace taut
