#include "taut/hull/contact/level_sides.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_forms.h"

namespace taut {
namespace {

/// How far from a border a contact may be that the direction does not tell from the border: where
/// x . n departs with the third power, its slope with the second is rounding up to there.
constexpr double border_reach = 1e-5;

/// Roundings of coordinates in a second derivative: those of cubics are some 24 coordinates.
constexpr double second_roundings = 8;

/// The slope of x . n at the contact is not more than this.
bool is_level(const ContactGeometry& geometry, const Contact& c, const dvec3& n, double slope) {
  const ContactJet j = geometry.jet(c);
  const auto is_small = [&](const dvec3& dx) {
    return std::abs(glm::dot(dx, n)) <= slope * glm::length(dx);
  };
  return is_small(j.dx[0]) && is_small(j.dx[1]);
}

}  // namespace

bool is_level_across(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& n) {
  const double value = along_v(side) ? c.u : c.v;
  if (value != (at_upper_end(side) ? 1 : 0)) return false;
  // Where x . n is highest along the side, whose parameter has the multiple `shear` of the inward
  // one.
  const bool is_u = along_v(side);
  const double sense = at_upper_end(side) ? -1 : 1;
  const PatchJet3 j = geometry.patch_jet(c);
  const double along = glm::dot(is_u ? j.Svv : j.Suu, n);
  const double mixed = sense * glm::dot(j.Suv, n);
  const double shear = along < -geometry.rounding() ? -mixed / along : 0;
  const double second = glm::dot(is_u ? j.Suu : j.Svv, n) + shear * (2 * mixed + shear * along);
  return std::abs(second) <= (1 + shear * shear) * second_roundings * geometry.rounding();
}

std::optional<Contact> at_level_border(const ContactGeometry& geometry, const Contact& c,
                                       const dvec3& n, double slope) {
  const Contact border = moved_to_border(geometry, c, border_reach);
  if (border.u == c.u && border.v == c.v) return std::nullopt;
  const bool level = is_level(geometry, border, n, std::max(slope, geometry.tie()));
  return level ? std::optional(border) : std::nullopt;
}

}  // namespace taut
