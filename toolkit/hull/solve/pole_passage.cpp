#include "taut/hull/solve/pole_passage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/geometry.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/parabolic_sides.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// Halvings of the way to a pole: a million times shorter it is.
constexpr int most_halvings = 20;
/// How far parameters may leave [0, 1] on the way by rounding.
constexpr double parameter_slack = 1e-9;
/// Bisections for the parameter about a pole, down to rounding.
constexpr int bisections = 53;
/// Radians by which a direction may miss that of a patch's side: it is extrapolated from places so
/// far from the pole that curves turn by a hundred times less over the square.
constexpr double angle_slack = 1e-6;

class Passage {
 public:
  Passage(const ContactSystem& system, const Ruling& pole, std::size_t i)
      : system_(system),
        geometry_(system.geometry()),
        pole_(pole),
        i_(i),
        side_(*pole_side(geometry_, pole.contact[i])) {}

  /// The parameter about the pole is linear in the distance from it, next to it.
  std::optional<Contact> into(const Ruling& from) {
    if (pole_side(geometry_, from.contact[i_])) return std::nullopt;
    std::optional<Ruling> near = from;
    for (int k = 0; near && distance(*near) > pole_chord; ++k) {
      near = k < most_halvings ? halfway(*near) : std::nullopt;
    }
    const std::optional<Ruling> nearer = near ? halfway(*near) : std::nullopt;
    if (!nearer) return std::nullopt;
    const double share = distance(*nearer) / (distance(*near) - distance(*nearer));
    const dvec3 before = unit(pole_.point[i_] - near->point[i_]);
    const dvec3 there = unit(pole_.point[i_] - nearer->point[i_]);
    direction_ = unit(there + share * (there - before));
    const double a = parameter(near->contact[i_]);
    const double b = parameter(nearer->contact[i_]);
    const double t = b + share * (b - a);
    const double end = std::round(t);
    return at(pole_.contact[i_],
              std::abs(t - end) < parameter_slack ? end : std::clamp(t, 0.0, 1.0));
  }

  /// Of two patches between which it runs the one that is asked for.
  std::optional<Contact> out_of(const Contact& to) const {
    const dvec3 n = pole_.n;
    std::vector<Contact> all = all_about();
    std::stable_partition(all.begin(), all.end(),
                          [&](const Contact& c) { return same_element(c, to); });
    for (const Contact& c : all) {
      const std::optional<Side> side = pole_side(geometry_, c);
      const auto angle = [&](double t) {
        const Contact there = on_side_of(c, *side, t);
        const dvec3 dx = geometry_.jet(there).dx[along_v(*side) ? 0 : 1];
        const dvec3 away = at_upper_end(*side) ? -dx : dx;
        return std::atan2(glm::dot(glm::cross(direction_, away), n), glm::dot(direction_, away));
      };
      double low = 0, high = 1;
      double before = angle(low), after = angle(high);
      const bool holds = std::abs(before) + std::abs(after) < std::numbers::pi &&
                         std::min(before, after) <= angle_slack &&
                         std::max(before, after) >= -angle_slack;
      if (!holds) continue;
      for (int k = 0; k < bisections; ++k) {
        const double middle = 0.5 * (low + high);
        ((angle(middle) > 0) == (after > before) ? high : low) = middle;
      }
      return on_side_of(c, *side, 0.5 * (low + high));
    }
    return std::nullopt;
  }

 private:
  double parameter(const Contact& c) const { return along_v(side_) ? c.v : c.u; }

  /// The pole in each of the patches around it.
  std::vector<Contact> all_about() const {
    std::vector<Contact> found = {pole_.contact[i_]};
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Contact own = found[k];
      const std::optional<Side> side = pole_side(geometry_, own);
      for (const double end : {0.0, 1.0}) {
        for (const Contact& c : about(geometry_, on_side_of(own, *side, end))) {
          const bool is_known = std::any_of(found.begin(), found.end(), [&](const Contact& other) {
            return same_element(c, other);
          });
          if (!is_known && pole_side(geometry_, c)) found.push_back(c);
        }
      }
    }
    return found;
  }
  Contact at(const Contact& c, double t) const { return on_side_of(c, side_, t); }
  double distance(const Ruling& r) const { return glm::distance(r.point[i_], pole_.point[i_]); }

  /// The ruling whose contact is halfway to the pole.
  std::optional<Ruling> halfway(const Ruling& r) const {
    CommonSupport s(geometry_, r);
    const dvec3 way = unit(pole_.point[i_] - r.point[i_]);
    const double half = 0.5 * distance(r);
    const auto equation = [&](const CommonSupport& now) {
      LinearEquation e;
      e.residual = glm::dot(now.jet[i_].x - pole_.point[i_], way) + half;
      e.add_point(now, int(i_), way);
      return e;
    };
    if (!system_.solve(s, equation)) return std::nullopt;
    const Contact own = clamped(s.contact[i_]);
    const bool stays = std::abs(own.u - s.contact[i_].u) <= parameter_slack &&
                       std::abs(own.v - s.contact[i_].v) <= parameter_slack;
    const Ruling found = s.ruling();
    return stays && distance(found) < 0.75 * distance(r) ? std::optional(found) : std::nullopt;
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  const Ruling& pole_;
  const std::size_t i_;
  const Side side_;
  dvec3 direction_ = dvec3(0.0);
};

}  // namespace

std::optional<Contact> into_pole(const ContactSystem& system, const Ruling& from,
                                 const Ruling& pole, std::size_t i) {
  return Passage(system, pole, i).into(from);
}

std::optional<PolePassage> pole_passage(const ContactSystem& system, const Ruling& from,
                                        const Ruling& pole, const Ruling& to, std::size_t i) {
  Passage passage(system, pole, i);
  const std::optional<Contact> into = passage.into(from);
  const std::optional<Contact> out_of = into ? passage.out_of(to.contact[i]) : std::nullopt;
  if (!out_of) return std::nullopt;
  return PolePassage{*into, *out_of};
}

}  // namespace taut
