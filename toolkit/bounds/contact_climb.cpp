#include "taut/bounds/contact_climb.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// How near to a pole, as a parameter, a climb in the direction of its normal need not go on.
constexpr double about_pole = 1e-5;
/// Parameters about a pole that are tried for the steepest way up, a patch.
constexpr int pole_samples = 8;
/// How far from a pole a climb begins at most.
constexpr double off_pole = 0.3;
/// A contact is at a pole for good if n is the pole's normal to within this.
constexpr double pole_angle = 1e-8;

/// Sine of the angle that a vector makes with the plane across n; zero of a zero vector.
double elevation(const dvec3& v, const dvec3& n) {
  const double length = glm::length(v);
  return length > 0 ? glm::dot(v, n) / length : 0;
}

/// From a pole whose normal is not n, a start of a climb on the steepest way up among all patches
/// about it, at the maximum of the parabola along it. None at a vertex of another kind, and where
/// no way leads up.
std::optional<Contact> way_off_pole(const ContactGeometry& geometry, const Contact& c,
                                    const dvec3& n) {
  const dvec3 x = geometry.point(c);
  const std::vector<Patch>& patches = geometry.part(c).patches();
  std::optional<Contact> best;
  double steepest = 0;
  for (int p = 0; p < int(patches.size()); ++p) {
    for (const Side side : all_sides) {
      if (!is_pole(geometry, {c.instance, SourceKind::face, p, 0, 0}, side)) continue;
      if (glm::distance(geometry.point(on_side(c.instance, p, side, 0.5)), x) > join_distance) {
        continue;
      }
      for (int k = 0; k <= pole_samples; ++k) {
        Contact at = on_side(c.instance, p, side, double(k) / pole_samples);
        const ContactJet j = geometry.jet(at);
        const dvec3 away = inward_derivative(j, side);
        const double slope = elevation(away, n);
        if (slope <= steepest) continue;
        const double second = glm::dot(along_v(side) ? j.dxx : j.dyy, n);
        const double rise = glm::dot(away, n);
        const double step = second < 0 ? std::min(-rise / second, off_pole) : off_pole;
        (along_v(side) ? at.u : at.v) = at_upper_end(side) ? 1 - step : step;
        steepest = slope;
        best = at;
      }
    }
  }
  return best;
}

/// Climbs; one element at a time.
class Climb {
 public:
  Climb(const ContactGeometry& geometry, const Contact& c, const dvec3& n)
      : geometry_(geometry), c_(c), n_(n) {}

  /// The highest contact that the climb has been at.
  const ClimbedContact& highest() const { return highest_; }

  std::optional<Contact> run() {
    if (c_.kind == SourceKind::face && geometry_.is_ruled(c_)) c_ = at_rest(geometry_, c_, n_);
    for (int k = 0; k < step_limit && idle_ < idle_limit; ++k) {
      const Progress progress = c_.kind == SourceKind::face   ? on_face()
                                : c_.kind == SourceKind::edge ? on_edge()
                                                              : at_vertex();
      if (progress == Progress::arrived) return c_;
      if (progress == Progress::lost) return std::nullopt;
    }
    return is_on_top() ? std::optional(c_) : std::nullopt;
  }

 private:
  enum class Progress { moved, arrived, lost };
  /// Steps, and those since the last gain. Usual are five; one or two more for each patch on the
  /// way.
  static constexpr int step_limit = 400;
  static constexpr int idle_limit = 60;
  /// Steps of the point shorter than this end the climb; the maximum is flat there.
  static constexpr double short_step = 1e-13;
  /// Steps shorter than this that do not get shorter are rounding, which poles magnify.
  static constexpr double noise_step = 1e-9;
  /// Slopes below this are rounding.
  static constexpr double flat = 1e-13;
  /// Normal curvature from which on a level point is a minimum.
  static constexpr double bent = 1e-9;
  /// Added to a tangent's length: about a pole tangents are as short as they like, their rounding
  /// is not.
  static constexpr double small_tangent = 0.01;
  /// A rise of the value that is more than rounding.
  static constexpr double least_gain = 16 * rounding_unit;
  /// Share of a patch that steps may take where the value is not concave.
  static constexpr double stride = 0.2;

  /// The jet at the contact, which becomes highest() if none was higher.
  ContactJet visit() {
    const ContactJet j = geometry_.jet(c_);
    const double h = glm::dot(j.x, n_);
    idle_ = h > highest_.h + least_gain ? 0 : idle_ + 1;
    if (h >= highest_.h - least_gain) highest_ = {c_, j.x, h};
    return j;
  }

  /// What rounding may leave of a level tangent's slope, by the tangent's length.
  double slack(double size) const { return flat * size + geometry_.rounding(); }
  bool is_bent(double second, double size) const {
    return second > bent * size * size + geometry_.rounding();
  }
  /// At the maximum along an edge, to within rounding, which near an inflection makes steps without
  /// end.
  bool is_on_top() const {
    if (c_.kind != SourceKind::edge) return false;
    const ContactJet j = geometry_.jet(c_);
    const double size = glm::length(j.dx[0]);
    return std::abs(glm::dot(j.dx[0], n_)) <= slack(size) && is_bent(-glm::dot(j.dxx, n_), size);
  }
  bool rises(const dvec3& tangent) const {
    return glm::dot(tangent, n_) > slack(glm::length(tangent));
  }

  Progress leave(const ContactExit& exit) {
    const std::optional<Contact> next = beyond(geometry_, c_, exit);
    if (!next) return Progress::lost;
    came_from_ = c_;
    c_ = *next;
    return Progress::moved;
  }
  /// Over the side, or the end, lies what the climb has just come from: the join is a ridge, or a
  /// kink.
  bool leads_back(const ContactExit& exit) const {
    if (!came_from_) return false;
    const std::optional<Contact> next = beyond(geometry_, c_, exit);
    return next && same_element(*next, *came_from_);
  }

  Progress on_face() {
    const bool at_pole_for_good = at_its_pole();
    const ContactJet j = visit();
    if (at_pole_for_good) return Progress::arrived;
    const dvec2 slope(glm::dot(j.dx[0], n_), glm::dot(j.dx[1], n_));
    const dvec2 size(glm::length(j.dx[0]), glm::length(j.dx[1]));
    std::optional<int> held;
    for (int a = 0; a < 2; ++a) {
      const std::optional<Side> side = uphill_side(a, slope[a], size[a]);
      if (!side) continue;
      if (is_pole(geometry_, c_, *side)) return off_the_pole();
      const ContactExit exit{ContactExit::Kind::side, int(*side)};
      if (!leads_back(exit)) return leave(exit);
      held = a;
    }
    const dvec2 step = step_uphill(j, slope, size, held);
    for (int a = 0; a < 2; ++a) {
      if (step[a] != 0 && at_pole(a, step[a]) && distance_to_side(a, step[a]) < pole_parameter) {
        return off_the_pole();
      }
    }
    const double length = glm::length(step * size);
    const bool noise = length < noise_step && length > 0.5 * last_length_;
    last_length_ = length;
    came_from_.reset();
    if (length <= short_step || noise) {
      if (held) return Progress::lost;
      return pole_side(geometry_, c_) ? off_the_pole() : Progress::arrived;
    }
    const bool still = glm::length(taken(step) * size) <= short_step;
    return still && ++stuck_ > 4 ? Progress::lost : Progress::moved;
  }

  /// The side on which the contact is, of the two that bound the parameter, if the value grows
  /// beyond.
  std::optional<Side> uphill_side(int parameter, double slope, double size) const {
    const double at = parameter == 0 ? c_.u : c_.v;
    const double least = slack(size + small_tangent);
    if (at <= 0 && slope < -least) return parameter == 0 ? Side::u0 : Side::v0;
    if (at >= 1 && slope > least) return parameter == 0 ? Side::u1 : Side::v1;
    return std::nullopt;
  }

  /// Newton's step where the value is concave; else uphill in each parameter but the one that is
  /// held. None over a border.
  dvec2 step_uphill(const ContactJet& j, const dvec2& slope, const dvec2& size,
                    std::optional<int> held) const {
    const double uu = glm::dot(j.dxx, n_);
    const double uv = glm::dot(j.dxy, n_);
    const double vv = glm::dot(j.dyy, n_);
    dvec2 step(0.0);
    const double det = uu * vv - uv * uv;
    if (!held && uu < 0 && det > geometry_.rounding() * std::abs(uu + vv)) {
      step = {(uv * slope.y - vv * slope.x) / det, (uv * slope.x - uu * slope.y) / det};
    } else {
      for (int a = 0; a < 2; ++a) {
        if (size[a] == 0 || a == held) continue;
        const double second = a == 0 ? uu : vv;
        // Where the value is not concave, far, off a minimum too; where it is flat, nowhere.
        const bool level = std::abs(slope[a]) <= slack(size[a] + small_tangent) &&
                           !is_bent(std::abs(second), size[a]);
        step[a] = level ? 0 : second < 0 ? -slope[a] / second : std::copysign(stride, slope[a]);
      }
    }
    for (int a = 0; a < 2; ++a) {
      if (step[a] != 0 && room_for(a, step[a]) <= 0) step[a] = 0;
    }
    return step;
  }

  /// Takes the step, half of the patch at most and up to the border. The step that was taken.
  dvec2 taken(dvec2 step) {
    const double longest = std::max(std::abs(step.x), std::abs(step.y));
    if (longest > 0.5) step *= 0.5 / longest;
    double share = 1;
    for (int a = 0; a < 2; ++a) {
      const double room = room_for(a, step[a]);
      if (std::abs(step[a]) > room) share = std::min(share, room / std::abs(step[a]));
    }
    dvec2 at(c_.u, c_.v);
    for (int a = 0; a < 2; ++a) {
      const double room = room_for(a, step[a]);
      const double end = step[a] < 0 ? 0 : 1;
      at[a] = std::clamp(at[a] + share * step[a], 0.0, 1.0);
      // The product may be rounded to less than the room, or leave of it what is rounding alone.
      const bool meets = std::abs(step[a]) > room && room / std::abs(step[a]) <= share;
      const bool all_but_meets = step[a] != 0 && std::abs(end - at[a]) < rounding_unit;
      if ((meets || all_but_meets) && !at_pole(a, step[a])) at[a] = end;
    }
    c_.u = at.x;
    c_.v = at.y;
    return share * step;
  }

  /// About a pole whose normal is n: moves there. Parameters are of no use so near to it.
  bool at_its_pole() {
    for (const Side side : all_sides) {
      const double t = along_v(side) ? c_.u : c_.v;
      if ((at_upper_end(side) ? 1 - t : t) > about_pole || !is_pole(geometry_, c_, side)) continue;
      const Contact pole = at_exit(c_, {ContactExit::Kind::side, int(side)});
      const double least = std::max(pole_angle, 2 * pole_turn(geometry_, pole));
      if (glm::length(glm::cross(unit_normal(geometry_, pole), n_)) >= least) continue;
      c_ = pole;
      return true;
    }
    return false;
  }
  /// At a pole: arrived, unless it is not the maximum.
  Progress off_the_pole() {
    if (left_pole_) return Progress::lost;
    const dvec3 normal = unit_normal(geometry_, c_);
    const double least = std::max(pole_angle, 2 * pole_turn(geometry_, c_));
    if (glm::length(glm::cross(normal, n_)) < least) return Progress::arrived;
    const std::optional<Contact> start = way_off_pole(geometry_, c_, n_);
    if (!start) return Progress::lost;
    left_pole_ = true;
    c_ = *start;
    return Progress::moved;
  }
  bool at_pole(int parameter, double step) const {
    const Side side =
        parameter == 0 ? (step < 0 ? Side::u0 : Side::u1) : (step < 0 ? Side::v0 : Side::v1);
    return is_pole(geometry_, c_, side);
  }
  double distance_to_side(int parameter, double step) const {
    const double at = parameter == 0 ? c_.u : c_.v;
    return step < 0 ? at : 1 - at;
  }
  /// How far a step may go: to the border, but only most of the way to a pole, where the parameters
  /// fail.
  double room_for(int parameter, double step) const {
    const double room = distance_to_side(parameter, step);
    return at_pole(parameter, step) ? 0.95 * room : room;
  }

  Progress on_edge() {
    const ContactJet j = visit();
    const double slope = glm::dot(j.dx[0], n_);
    const double size = glm::length(j.dx[0]);
    const bool leads_out = c_.u <= 0 ? slope < -slack(size) : c_.u >= 1 && slope > slack(size);
    const ContactExit end{ContactExit::Kind::end, c_.u <= 0 ? 0 : 1};
    if (leads_out && !leads_back(end)) return leave(end);
    const double second = glm::dot(j.dxx, n_);
    const bool level = std::abs(slope) <= slack(size) && !is_bent(std::abs(second), size);
    double step = level || leads_out ? 0
                  : second < 0       ? -slope / second
                                     : std::copysign(stride, slope);
    step = std::clamp(step, -0.5, 0.5);
    const double to = std::clamp(c_.u + step, 0.0, 1.0);
    const bool to_end = to != c_.u && (to == 0 || to == 1);
    const double length = std::abs(to - c_.u) * size;
    const bool noise = length < noise_step && length > 0.5 * last_length_;
    last_length_ = length;
    if ((length > short_step && !noise) || to_end) {
      came_from_.reset();
      c_.u = to;
      return Progress::moved;
    }
    const bool straight = !leads_out && geometry_.is_straight(c_);
    if (!straight && !leads_out && std::abs(slope) > slack(size) && second >= 0)
      return Progress::lost;
    const auto& sides = geometry_.sides(c_);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const dvec3 c = inward_derivative(geometry_.jet(on_side(c_, sides[k])), sides[k].side);
      if (rises(c)) return leave({ContactExit::Kind::face, int(k)});
    }
    if (!straight) return Progress::arrived;
    // Level: its ends are as high.
    c_ = geometry_.straight_end(c_, c_.u < 0.5 ? 0 : 1);
    return Progress::moved;
  }

  Progress at_vertex() {
    visit();
    const auto& ends = geometry_.ends(c_);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      // The other end of a straight edge is a contact of its own.
      if (geometry_.is_straight(piece_end(c_, ends[k]))) continue;
      if (rises(tangent_from(geometry_, c_, ends[k]))) {
        return leave({ContactExit::Kind::edge, int(k)});
      }
    }
    return Progress::arrived;
  }

  const ContactGeometry& geometry_;
  Contact c_;
  dvec3 n_;
  int idle_ = 0;
  int stuck_ = 0;
  bool left_pole_ = false;
  /// The contact before the last step, if that led to another element.
  std::optional<Contact> came_from_;
  double last_length_ = infinity;
  ClimbedContact highest_;
};

}  // namespace

std::optional<Contact> climbed(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  return Climb(geometry, geometry.canonical(clamped(c)), n).run();
}

ClimbedContact climb(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  Climb way(geometry, geometry.canonical(clamped(c)), n);
  way.run();
  ClimbedContact result = way.highest();
  result.contact = geometry.canonical(result.contact);
  return result;
}

}  // namespace taut
