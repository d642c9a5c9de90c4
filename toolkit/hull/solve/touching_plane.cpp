#include "taut/hull/solve/touching_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {
namespace {

/// Steps of the method, which needs five.
constexpr int plane_steps = 40;
/// Longest step, in radians, and one that is rounding.
constexpr double longest_step = 0.25;
constexpr double shortest_step = 1e-15;
/// Width of contacts, relative to their length, below which they are in line.
constexpr double line_width = 1e-6;
/// How far parameters may leave [0, 1] by rounding.
constexpr double border_slack = 1e-9;
/// Slope in the scene's frame of a contact that is told exactly: of one that Newton's method has
/// left outside of its element, and that is moved onto its border, it is more.
constexpr double most_slope = 1e-12;
/// How often Newton's method begins anew with contacts that have left their elements.
constexpr int most_moves = 6;

class PlaneSearch {
 public:
  PlaneSearch(const ContactGeometry& geometry, const dvec3& n, const std::vector<Contact>& contacts)
      : geometry_(geometry), starts_(contacts) {
    found_.n = n;
  }

  TouchingPlane run() {
    double last = infinity;
    for (int k = 0; k < plane_steps; ++k) {
      climb_all();
      const dvec3 turn = step();
      const double length = glm::length(turn);
      if (length <= shortest_step || (k > 4 && length >= 0.5 * last && length < 1e-12)) break;
      last = length;
      found_.n = unit(found_.n + turn * std::min(1.0, longest_step / length));
    }
    climb_all();
    return found_;
  }

 private:
  void climb_all() {
    found_.contacts.clear();
    double lowest = infinity;
    double highest = -infinity;
    for (Contact& start : starts_) {
      found_.contacts.push_back(climb(geometry_, start, found_.n));
      const ClimbedContact& c = found_.contacts.back();
      start = c.contact;
      lowest = std::min(lowest, c.h);
      highest = std::max(highest, c.h);
    }
    found_.spread = highest - lowest;
  }

  /// The shortest turn that makes the heights as alike as turns do to first order.
  dvec3 step() {
    const std::array<dvec3, 2> frame = tangent_frame(found_.n);
    const auto count = Eigen::Index(found_.contacts.size());
    dvec3 middle(0.0);
    for (const ClimbedContact& c : found_.contacts) middle += c.x / double(count);
    Eigen::MatrixXd rates(count, 2);
    Eigen::VectorXd heights(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const dvec3 x = found_.contacts[std::size_t(k)].x - middle;
      rates.row(k) << glm::dot(x, frame[0]), glm::dot(x, frame[1]);
      heights[k] = -glm::dot(x, found_.n);
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(rates, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(line_width);
    found_.in_line = svd.rank() < 2;
    const Eigen::Vector2d turn = svd.solve(heights);
    return turn[0] * frame[0] + turn[1] * frame[1];
  }

  const ContactGeometry& geometry_;
  std::vector<Contact> starts_;
  TouchingPlane found_;
};

/// How far surfaces that curve as much as the scene is large rise so much over.
double risen_over(double depth) { return std::sqrt(depth); }

/// Turns a plane about the line that its contacts lie in.
class LineTurn {
 public:
  LineTurn(const ContactGeometry& geometry, const TouchingPlane& plane,
           const std::vector<Contact>& contacts, double rounding = 0)
      : geometry_(geometry),
        plane_(plane),
        contacts_(contacts),
        parted_(std::max({least_parted, parted_depths * plane.off(), rounding})) {
    for (const ClimbedContact& a : plane.contacts) {
      for (const ClimbedContact& b : plane.contacts) {
        if (glm::distance(a.x, b.x) > glm::distance(from_, to_)) {
          from_ = a.x;
          to_ = b.x;
        }
      }
    }
    across_ = glm::cross(unit(to_ - from_), plane.n);
  }

  double length() const { return glm::distance(from_, to_); }
  dvec3 turned(double angle) const {
    return std::cos(angle) * plane_.n + std::sin(angle) * across_;
  }
  double angle(const dvec3& n) const {
    return std::atan2(glm::dot(n, across_), glm::dot(n, plane_.n));
  }
  /// A contact has left the line.
  bool parts(double angle) const {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [&](const Contact& c) { return parts(c, angle); });
  }
  /// The plane at which the first leaves the line, between an angle at which none has and one at
  /// which some have; with contacts where they leave it, but for the distance.
  TouchingPlane found(double together, double apart, double depth) const {
    TouchingPlane found = plane_;
    double first = apart;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      const double own = parting_angle(contacts_[k], together, apart);
      if (std::abs(own - together) < std::abs(first - together)) first = own;
      found.contacts[k].contact = climb(geometry_, contacts_[k], turned(own)).contact;
    }
    found.n = turned(first);
    for (ClimbedContact& c : found.contacts) {
      c.contact = on_border(c.contact, found.n, risen_over(depth), depth);
    }
    take_heights(found);
    return found;
  }
  /// The same, where the contact that leaves the line tells the plane: it is tangent to the way on
  /// which it leaves. Along a straight border that is where this plane turns least.
  std::optional<TouchingPlane> tangent(TouchingPlane plane, std::size_t k, double distance,
                                       double depth) const {
    for (ClimbedContact& own : plane.contacts) {
      own.contact = on_border(own.contact, plane.n, distance, depth);
    }
    Contact& c = plane.contacts[k].contact;
    const Contact start = c;
    const std::optional<dvec3> n = settle(c);
    if (!n || glm::distance(geometry_.point(c), geometry_.point(start)) > distance) {
      return std::nullopt;
    }
    plane.n = *n;
    take_heights(plane);
    return plane;
  }

  /// The contact on a border of its element that is no farther, if that is no lower by more than
  /// the depth.
  Contact on_border(const Contact& c, const dvec3& n, double distance, double depth) const {
    const Contact there = moved_to_border(geometry_, c, distance);
    return glm::dot(geometry_.point(c) - geometry_.point(there), n) <= depth ? there : c;
  }

  /// The contact that has left the line the farthest, at an angle, or in the plane.
  std::size_t first_to_part(double apart) const {
    std::vector<ClimbedContact> there;
    for (const Contact& c : contacts_) there.push_back(climb(geometry_, c, turned(apart)));
    return farthest(there);
  }
  std::size_t first_to_part() const { return farthest(plane_.contacts); }

 private:
  bool parts(const Contact& c, double angle) const {
    return off_line(climb(geometry_, c, turned(angle)).x) > parted_;
  }
  /// The least angle found at which a contact has left the line; `apart` if it has not even there.
  double parting_angle(const Contact& c, double together, double apart) const {
    for (int k = 0; k < turn_halvings && parts(c, apart); ++k) {
      const double middle = 0.5 * (together + apart);
      (parts(c, middle) ? apart : together) = middle;
    }
    return apart;
  }

  void take_heights(TouchingPlane& plane) const {
    double lowest = infinity;
    double highest = -infinity;
    for (ClimbedContact& c : plane.contacts) {
      c.x = geometry_.point(c.contact);
      c.h = glm::dot(c.x, plane.n);
      lowest = std::min(lowest, c.h);
      highest = std::max(highest, c.h);
    }
    plane.spread = highest - lowest;
  }

  double off_line(const dvec3& x) const {
    return glm::length(glm::cross(x - from_, unit(to_ - from_)));
  }

  std::size_t farthest(const std::vector<ClimbedContact>& contacts) const {
    const auto most = std::max_element(contacts.begin(), contacts.end(),
                                       [&](const ClimbedContact& a, const ClimbedContact& b) {
                                         return off_line(a.x) < off_line(b.x);
                                       });
    return std::size_t(most - contacts.begin());
  }

  /// The normal across the line and a tangent, nearest to the plane's. None if they are parallel.
  std::optional<dvec3> across(const dvec3& tangent) const {
    const dvec3 n = glm::cross(unit(to_ - from_), tangent);
    if (glm::length(n) <= line_width * glm::length(tangent)) return std::nullopt;
    return unit(glm::dot(n, plane_.n) < 0 ? -n : n);
  }

  /// The plane in which a contact on the line leaves it, moved along the line to where that plane
  /// is a stationary one: between the ends of the border by the secant rule, or at one of them.
  std::optional<dvec3> settle(Contact& c) const {
    const auto axis = [&](const ContactJet& j) {
      const dvec3 line = unit(to_ - from_);
      return j.dimension == 2 && glm::length(glm::cross(unit(j.dx[1]), line)) >
                                     glm::length(glm::cross(unit(j.dx[0]), line))
                 ? 1U
                 : 0U;
    };
    const auto rate = [&](const ContactJet& j) {
      const std::optional<dvec3> n = across(j.dx[axis(j)]);
      return n ? glm::dot(j.dxy, *n) : 0.0;
    };
    ContactJet j = geometry_.jet(c);
    if (j.dimension == 0) return std::nullopt;
    if (j.dimension == 1) return across(j.dx[0]);
    double& along = axis(j) == 0 ? c.v : c.u;
    double last = along;
    double before = rate(j);
    along += along < 0.5 ? secant_start : -secant_start;
    for (int k = 0; k < secant_steps; ++k) {
      j = geometry_.jet(c);
      const double now = rate(j);
      const double next = now == before
                              ? along
                              : std::clamp(along - now * (along - last) / (now - before), 0.0, 1.0);
      last = std::exchange(along, next);
      before = now;
      if (std::abs(along - last) <= shortest_step) break;
    }
    j = geometry_.jet(c);
    return across(j.dx[axis(j)]);
  }

  /// First step of the secant rule, the cube root of rounding, and how many are taken.
  static constexpr double secant_start = 1e-5;
  static constexpr int secant_steps = 20;

  /// How far from the line a contact has left it, which grows with the angle: in the scene's frame,
  /// or in units of what the contacts are off their plane.
  static constexpr double least_parted = 1e-9;
  static constexpr double parted_depths = 8;
  static constexpr int turn_halvings = 50;

  const ContactGeometry& geometry_;
  const TouchingPlane& plane_;
  /// Those that have not been in the line as yet: what has is told as one of its ends.
  const std::vector<Contact>& contacts_;
  double parted_;
  dvec3 from_ = dvec3(0.0), to_ = dvec3(0.0);
  dvec3 across_ = dvec3(0.0);
};

enum class Move { none, over, lost };

/// Lets contacts that have left their elements go on in those that they have come to.
Move move_over(const ContactGeometry& geometry, CommonSupport& s) {
  Move move = Move::none;
  for (Contact& c : s.contact) {
    const Contact own = clamped(c);
    if (glm::distance(parameters(c), parameters(own)) <= border_slack) continue;
    const std::optional<Contact> there = climbed(geometry, own, s.n);
    if (!there || same_element(*there, own)) return Move::lost;
    c = geometry.first(*there);
    move = Move::over;
  }
  s.evaluate(geometry);
  return move;
}

/// No farther from the longest of the segments between them than so much.
bool are_in_line(const std::vector<ClimbedContact>& three, double distance) {
  const dvec3 a = three[1].x - three[0].x;
  const dvec3 b = three[2].x - three[0].x;
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(a - b)});
  return glm::length(glm::cross(a, b)) <= distance * longest;
}

/// How fast x . n rises along the contact's element.
double slope(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  const ContactJet j = geometry.jet(c);
  double most = 0;
  for (int k = 0; k < j.dimension; ++k) {
    most = std::max(most, std::abs(glm::dot(j.dx[std::size_t(k)], n)));
  }
  return most;
}

/// Three contacts' common plane, where Newton's method leaves them near where they begin, there
/// climbs may lead over to others, and not in line.
std::optional<TouchingPlane> solved_plane(const ContactGeometry& geometry, const dvec3& n,
                                          const std::vector<Contact>& contacts) {
  if (contacts.size() != CommonSupport::capacity) return std::nullopt;
  CommonSupport s;
  s.n = n;
  for (const Contact& c : contacts) s.add(geometry, c);
  const CommonSupport start = s;
  for (int k = 0;; ++k) {
    if (k == most_moves || !ContactSystem(geometry).solve(s)) return std::nullopt;
    const Move move = move_over(geometry, s);
    if (move == Move::none) break;
    if (move == Move::lost) return std::nullopt;
  }
  TouchingPlane found;
  found.n = s.n;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Contact c = clamped(s.contact[k]);
    const dvec3 x = geometry.point(c);
    double nearest = infinity;
    for (std::size_t other = 0; other < contacts.size(); ++other) {
      if (other != k) nearest = std::min(nearest, glm::distance(x, start.jet[other].x));
    }
    if (glm::distance(x, start.jet[k].x) > nearest) return std::nullopt;
    if (slope(geometry, c, s.n) > most_slope) return std::nullopt;
    found.contacts.push_back({c, x, glm::dot(x, s.n)});
  }
  if (are_in_line(found.contacts, geometry.tie())) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(
      found.contacts.begin(), found.contacts.end(),
      [](const ClimbedContact& a, const ClimbedContact& b) { return a.h < b.h; });
  found.spread = highest->h - lowest->h;
  return found;
}

void find_above(SupportQuery& query, TouchingPlane& plane) {
  double highest = -infinity;
  for (const ClimbedContact& c : plane.contacts) highest = std::max(highest, c.h);
  plane.above = std::max(0.0, query(plane.n, plane.contacts.front().contact).h - highest);
}

}  // namespace

TouchingPlane turned_to_part(const ContactGeometry& geometry, SupportQuery& query,
                             const TouchingPlane& plane, const std::vector<Contact>& contacts,
                             const std::vector<dvec3>& beside, double depth) {
  const LineTurn turn(geometry, plane, contacts, depth);
  std::optional<double> together, apart;
  for (const dvec3& n : beside) {
    const double angle = turn.angle(n);
    std::optional<double>& own = turn.parts(angle) ? apart : together;
    if (!own || std::abs(angle) < std::abs(*own)) own = angle;
  }
  // Next to the node rulings are known to the resolution: they may all be on the side on which a
  // contact has left the line.
  if (!together && !turn.parts(0)) together = 0;
  if (!together || !apart) return plane;
  TouchingPlane found = turn.found(*together, *apart, depth);
  find_above(query, found);
  if (std::optional<TouchingPlane> exact =
          turn.tangent(found, turn.first_to_part(*apart), risen_over(depth), depth)) {
    find_above(query, *exact);
    if (exact->off() <= std::max(found.off(), geometry.tie())) return *exact;
  }
  return found;
}

namespace {

/// How far a contact may be from a border that is as high as it is, to within a tie: c s^2 / 2 at a
/// distance of s, of the least curvature c that is told.
double level_width(const ContactGeometry& geometry) {
  return std::sqrt(2 * geometry.tie() / least_curvature);
}

/// A plane of three contacts so nearly in line that heights do not tell them apart from the line is
/// known to the root of rounding only: what the one that leaves the line tells of it instead, where
/// that plane touches as well.
TouchingPlane told_in_line(const ContactGeometry& geometry, SupportQuery& query,
                           const TouchingPlane& plane, const std::vector<Contact>& contacts) {
  if (contacts.size() != CommonSupport::capacity || plane.off() > geometry.tie()) return plane;
  const LineTurn turn(geometry, plane, contacts);
  const double width = level_width(geometry);
  if (!are_in_line(plane.contacts, width)) return plane;
  std::optional<TouchingPlane> exact =
      turn.tangent(plane, turn.first_to_part(), width, geometry.tie());
  if (!exact || !are_in_line(exact->contacts, geometry.tie())) return plane;
  exact->in_line = false;
  find_above(query, *exact);
  return exact->off() <= geometry.tie() ? *exact : plane;
}

}  // namespace

TouchingPlane touching_plane(const ContactGeometry& geometry, SupportQuery& query, dvec3 n,
                             const std::vector<Contact>& contacts) {
  const auto supporting = [&](const dvec3& start, const std::vector<Contact>& from) {
    std::optional<TouchingPlane> solved = solved_plane(geometry, start, from);
    if (solved) find_above(query, *solved);
    return solved && solved->off() <= geometry.tie() ? solved : std::nullopt;
  };
  std::optional<TouchingPlane> plane = supporting(n, contacts);
  if (!plane) {
    plane = PlaneSearch(geometry, n, contacts).run();
    find_above(query, *plane);
    // Climbs are less exact than what Newton's method makes of them.
    std::vector<Contact> reached;
    for (const ClimbedContact& c : plane->contacts) reached.push_back(c.contact);
    if (plane->off() <= geometry.tie()) {
      if (const auto solved = supporting(plane->n, reached)) plane = solved;
    }
  }
  return told_in_line(geometry, query, *plane, contacts);
}

}  // namespace taut
