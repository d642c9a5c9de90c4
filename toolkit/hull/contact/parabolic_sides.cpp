#include "taut/hull/contact/parabolic_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/local_curvature.h"

namespace taut {
namespace {

/// Places along a side in which a direction is compared.
constexpr int compared_along = 64;

double compared(int k) { return double(k) / compared_along; }

/// The determinant of the second form along Su x Sv itself: a polynomial, where the patch is one.
double determinant_on(const ContactGeometry& geometry, const Contact& patch, Side side, double t) {
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, on_side_of(patch, side, t));
  return b ? b->gauss_curvature() * std::pow(b->area, 4) : 0;
}

/// The second form at a side, in the parameters and relative to the unit normal.
struct SideForm {
  SideForm(const ContactGeometry& geometry, const Contact& patch, Side side, double t) {
    const Contact c = on_side_of(patch, side, t);
    const ContactJet j = geometry.jet(c);
    const dvec3 n = unit_normal(geometry, c);
    along = glm::dot(along_v(side) ? j.dyy : j.dxx, n);
    across = glm::dot(along_v(side) ? j.dxx : j.dyy, n);
    mixed = glm::dot(j.dxy, n);
  }
  /// The form in the direction across, moved along the side by `shear`.
  double level(double shear) const { return across + shear * (2 * mixed + shear * along); }
  double twist(double shear) const { return mixed + shear * along; }

  double along, across, mixed;
};

/// How far a direction across a side runs along it.
struct Shear {
  double start = 0, slope = 0;
  double operator()(double t) const { return start + slope * t; }
};

/// The asymptotic directions across the side in two of its points, joined by linear functions:
/// those that may be asymptotic all along it.
std::vector<Shear> possible_shears(const ContactGeometry& geometry, const Contact& patch,
                                   Side side) {
  // Away from the ends, the middle and the quarters, where symmetric models have their events.
  constexpr std::array<double, 2> places = {21.0 / compared_along, 43.0 / compared_along};
  std::array<std::array<double, 2>, 2> shears{};
  for (std::size_t i = 0; i < 2; ++i) {
    const SideForm form(geometry, patch, side, places[i]);
    const double square = form.mixed * form.mixed - form.along * form.across;
    const double q = -form.mixed - std::copysign(std::sqrt(std::max(0.0, square)), form.mixed);
    shears[i] = {form.across / q, q / form.along};
  }
  std::vector<Shear> result = {{}};
  for (const double first : shears[0]) {
    for (const double second : shears[1]) {
      if (!std::isfinite(first) || !std::isfinite(second)) continue;
      const double slope = (second - first) / (places[1] - places[0]);
      result.push_back({first - slope * places[0], slope});
    }
  }
  return result;
}

/// A direction across each point of the side in which the patch is level, linear along the side.
/// Catmull-Clark surfaces are level across boundaries in the direction of their lattice, of which
/// tapered pieces have such an image.
std::optional<Shear> level_shear(const ContactGeometry& geometry, const Contact& patch, Side side) {
  // Roots of quadratics are extrapolated.
  constexpr double noise_factor = 64;
  const auto is_level = [&](const Shear& shear) {
    for (int k = 0; k <= compared_along; ++k) {
      const double s = shear(compared(k));
      const double noise = (1 + s * s) * noise_factor * geometry.rounding();
      if (!(std::abs(SideForm(geometry, patch, side, compared(k)).level(s)) <= noise)) return false;
    }
    return true;
  };
  const std::vector<Shear> shears = possible_shears(geometry, patch, side);
  const auto found = std::find_if(shears.begin(), shears.end(), is_level);
  return found == shears.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

Contact on_side_of(Contact patch, Side side, double t) {
  const dvec2 uv = on_side(side, t);
  patch.u = uv.x;
  patch.v = uv.y;
  return patch;
}

std::optional<Contact> straight_piece(const ContactGeometry& geometry, const Contact& patch,
                                      Side side) {
  const int piece = geometry.patch(patch).borders[std::size_t(side)].piece;
  if (piece < 0 || geometry.part(patch).pieces()[std::size_t(piece)].edge < 0) return std::nullopt;
  const Contact edge{patch.instance, SourceKind::edge, piece, 0, 0};
  return geometry.is_straight(edge) ? std::optional(edge) : std::nullopt;
}

SideFunction parabolic_along(const ContactGeometry& geometry, const Contact& patch, Side side) {
  if (const std::optional<Shear> shear = level_shear(geometry, patch, side)) {
    return [&geometry, patch, side, shear = *shear](double t) {
      return SideForm(geometry, patch, side, t).twist(shear(t));
    };
  }
  return [&geometry, patch, side](double t) { return determinant_on(geometry, patch, side, t); };
}

}  // namespace taut
