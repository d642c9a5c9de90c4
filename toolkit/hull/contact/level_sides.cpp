#include "taut/hull/contact/level_sides.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"

namespace taut {
namespace {

/// Beside an edge across which the patch is level, x . n is p s + k s^3 / 6 + m s t + l t^2 / 2, s
/// the way inwards; k, l < 0. Inside it has a maximum where s >= r = m^2 / (k l); one on the edge
/// is higher where s < 1.5 r, by |k| r^3 / 6 at most, which is no more than a tie where support
/// values do not tell. The border beside the maximum inside is then lower than that by |k| s^3 / 3,
/// no more than 6.75 ties.
constexpr double level_ties = 8;

/// How far from a border a contact may be that the direction does not tell from the border: where
/// x . n departs with the third power, its slope with the second is rounding up to there.
constexpr double border_reach = 1e-5;

/// Roundings of coordinates in a second derivative: those of cubics are some 24 coordinates.
constexpr double second_roundings = 8;

/// Roundings of coordinates in a third derivative.
constexpr double third_roundings = 64;
/// The first step, along a side, to where the third derivative vanishes, and steps at most.
constexpr double first_secant = 1e-3;
constexpr int secant_limit = 30;

/// x . n of a patch from a contact on a side inwards, where it is highest along the side: a cubic
/// in the inward parameter, of which the one along the side has the multiple `shear`.
struct InwardCubic {
  InwardCubic(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& n)
      : is_u(along_v(side)), sense(at_upper_end(side) ? -1 : 1) {
    const PatchJet3 j = geometry.patch_jet(c);
    const double along = glm::dot(is_u ? j.Svv : j.Suu, n);
    const double mixed = sense * glm::dot(j.Suv, n);
    if (along < -geometry.rounding()) shear = -mixed / along;
    const dvec3 twice = is_u ? j.Suuv : j.Suvv;
    const dvec3 once = is_u ? j.Suvv : j.Suuv;
    slope = sense * glm::dot(is_u ? j.Su : j.Sv, n) + shear * glm::dot(is_u ? j.Sv : j.Su, n);
    second = glm::dot(is_u ? j.Suu : j.Svv, n) + shear * (2 * mixed + shear * along);
    third =
        sense * glm::dot(is_u ? j.Suuu : j.Svvv, n) +
        shear * (3 * glm::dot(twice, n) + shear * (3 * sense * glm::dot(once, n) +
                                                   shear * glm::dot(is_u ? j.Svvv : j.Suuu, n)));
    noise = (1 + shear * shear) * second_roundings * geometry.rounding();
  }

  /// The contact moved inwards by so much.
  Contact inside(Contact c, double way) const {
    (is_u ? c.u : c.v) += sense * way;
    (is_u ? c.v : c.u) += shear * way;
    return c;
  }

  bool is_u;
  double sense;
  double shear = 0;
  double slope, second, third;
  double noise;  ///< of `second`
};

/// The slope of x . n at the contact is not more than this.
bool is_level(const ContactGeometry& geometry, const Contact& c, const dvec3& n, double slope) {
  const ContactJet j = geometry.jet(c);
  const auto is_small = [&](const dvec3& dx) {
    return std::abs(glm::dot(dx, n)) <= slope * glm::length(dx);
  };
  return is_small(j.dx[0]) && is_small(j.dx[1]);
}

/// The third derivative of x . n inwards from a side, n the patch's outward normal there.
double swell(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& outward) {
  return InwardCubic(geometry, c, side, aligned(unit_normal(geometry, c), outward)).third;
}

}  // namespace

Contact highest_along(const ContactGeometry& geometry, Contact c, const dvec3& n) {
  const auto is_border = [](double t) { return t == 0 || t == 1; };
  if (is_border(c.u) == is_border(c.v)) return c;
  const bool of_v = is_border(c.u);
  const ContactJet j = geometry.jet(c);
  const double second = glm::dot(of_v ? j.dyy : j.dxx, n);
  if (second >= -geometry.rounding()) return c;
  double& t = of_v ? c.v : c.u;
  t = std::clamp(t - glm::dot(j.dx[of_v ? 1 : 0], n) / second, 0.0, 1.0);
  return c;
}

bool is_level_across(const ContactGeometry& geometry, const Contact& c, Side side, const dvec3& n) {
  const double value = along_v(side) ? c.u : c.v;
  if (value != (at_upper_end(side) ? 1 : 0)) return false;
  const InwardCubic f(geometry, c, side, n);
  return std::abs(f.second) <= f.noise;
}

std::optional<Contact> at_level_border(const ContactGeometry& geometry, const Contact& c,
                                       const dvec3& n, double slope) {
  const Contact border = moved_to_border(geometry, c, border_reach);
  if (border.u == c.u && border.v == c.v) return std::nullopt;
  const bool level = is_level(geometry, border, n, std::max(slope, geometry.tie()));
  return level ? std::optional(border) : std::nullopt;
}

std::optional<Contact> on_level_edge(const ContactGeometry& geometry, const Contact& c, Side side,
                                     const dvec3& n) {
  if (c.kind != SourceKind::face) return std::nullopt;
  Contact border = moved_to_border(geometry, c, border_reach);
  if (border.u != c.u || border.v != c.v) {
    border = highest_along(geometry, border, n);
    if (!is_level(geometry, border, n, geometry.tie())) return std::nullopt;
  }
  if (!is_level_across(geometry, border, side, n)) return std::nullopt;
  const std::optional<Contact> over =
      beyond(geometry, border, {ContactExit::Kind::side, int(side)});
  return over && over->kind == SourceKind::edge ? over : std::nullopt;
}

std::optional<EdgeBeside> tied_edge(const ContactGeometry& geometry, const Contact& c,
                                    const dvec3& n) {
  if (c.kind != SourceKind::face) return std::nullopt;
  const double height = glm::dot(geometry.point(c), n);
  for (const Side side : all_sides) {
    const ContactExit exit = {ContactExit::Kind::side, int(side)};
    const Contact border = at_exit(c, exit);
    if (glm::dot(geometry.point(border), n) < height - level_ties * geometry.tie()) continue;
    const std::optional<Contact> over = beyond(geometry, border, exit);
    if (!over || over->kind != SourceKind::edge) continue;
    const std::optional<Contact> top = climbed(geometry, *over, n);
    if (!top || top->kind == SourceKind::face) continue;
    if (glm::dot(geometry.point(*top), n) >= height - geometry.tie()) {
      return EdgeBeside{exit, *top};
    }
  }
  return std::nullopt;
}

std::optional<Contact> inside_level(const ContactGeometry& geometry, Contact c, const dvec3& n) {
  for (const Side side : all_sides) {
    if (!is_level_across(geometry, c, side, n)) continue;
    const InwardCubic f(geometry, c, side, n);
    if (f.slope <= 0 || f.third >= 0) return std::nullopt;
    return f.inside(c, std::sqrt(-2 * f.slope / f.third));
  }
  return std::nullopt;
}

std::optional<Contact> tied_inside(const ContactGeometry& geometry, const Contact& edge,
                                   const ContactExit& exit, const dvec3& n) {
  if (edge.kind != SourceKind::edge || exit.kind != ContactExit::Kind::face) return std::nullopt;
  const std::optional<Contact> c = beyond(geometry, edge, exit);
  if (!c || c->kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    if (!stands_at(*c, {ContactExit::Kind::side, int(side)})) continue;
    const InwardCubic f(geometry, *c, side, n);
    if (f.third >= 0 || f.second < -f.noise) continue;
    const double way = std::max(0.0, -2 * f.second / f.third);
    if (way >= 1) continue;
    const std::optional<Contact> top = climbed(geometry, f.inside(*c, way), n);
    if (!top || top->kind != SourceKind::face) continue;
    const double height = glm::dot(geometry.point(edge), n);
    if (glm::dot(geometry.point(*top), n) >= height - geometry.tie()) return top;
  }
  return std::nullopt;
}

bool swells_beside(const ContactGeometry& geometry, const Contact& edge, const dvec3& n) {
  if (edge.kind != SourceKind::edge) return false;
  const std::vector<ContactGeometry::PieceSide>& sides = geometry.sides(edge);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const std::optional<Contact> c = beyond(geometry, edge, {ContactExit::Kind::face, int(k)});
    if (!c || c->kind != SourceKind::face || !is_level_across(geometry, *c, sides[k].side, n)) {
      continue;
    }
    if (swell(geometry, *c, sides[k].side, n) > third_roundings * geometry.rounding()) return true;
  }
  return false;
}

std::optional<Contact> swell_end(const ContactGeometry& geometry, Contact c, Side side,
                                 const dvec3& n) {
  double& t = along_v(side) ? c.v : c.u;
  const double noise = third_roundings * geometry.rounding();
  double last = t;
  double last_swell = swell(geometry, c, side, n);
  t += t < 0.5 ? first_secant : -first_secant;
  for (int k = 0; k < secant_limit; ++k) {
    const double now = swell(geometry, c, side, n);
    if (std::abs(now) <= noise) return c;
    const double change = now * (t - last) / (now - last_swell);
    last = t;
    last_swell = now;
    t -= change;
    if (!(t >= 0 && t <= 1)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace taut
