#include "taut/hull/solve/free_end_roots.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/contact/local_curvature.h"

namespace taut {
namespace {

constexpr int newton_limit = 20;
/// Steps of a parameter below this end Newton's method. Those below a length, if they do not get
/// shorter, are rounding: so much of a parameter at most.
constexpr double converged_step = 1e-14;
constexpr double noise_length = 1e-8;
constexpr double noise_limit = 1e-4;
/// Of central difference quotients: their error slows Newton's method by its square.
constexpr double difference = 1e-5;
/// Change of (flat, cubic) by an area, in the scene's frame, that makes a root a simple one. It is
/// rounding on a circle of flat points.
constexpr double least_change = 1e-5;

/// The cusp's two equations: the flat curvature vanishes, and so does the cubic along it. Its sense
/// is that of `along`.
std::optional<dvec2> cusp_residual(const ContactGeometry& geometry, const Contact& c,
                                   const dvec3& along) {
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, c);
  if (!b) return std::nullopt;
  return dvec2(b->flat, glm::dot(b->along, along) < 0 ? -b->cubic : b->cubic);
}

}  // namespace

double noise_step(const ContactGeometry& geometry, const Contact& c) {
  const ContactJet j = geometry.jet(c);
  double size = glm::length(j.dx[0]);
  if (j.dimension == 2) size = std::min(size, glm::length(j.dx[1]));
  return size > noise_length / noise_limit ? noise_length / std::min(size, 1.0) : noise_limit;
}

std::optional<double> root_near(const SideFunction& f, double start, double reach, double noise) {
  double t = start;
  double last = reach;
  for (int k = 0; k < newton_limit; ++k) {
    const double slope = (f(t + difference) - f(t - difference)) / (2 * difference);
    const double step = -f(t) / slope;
    t += step;
    if (!(std::abs(t - start) <= reach)) return std::nullopt;
    const double length = std::abs(step);
    if (length < converged_step || (length < noise && length > 0.5 * last)) return t;
    last = length;
  }
  return std::nullopt;
}

std::optional<Contact> cusp_near(const ContactGeometry& geometry, Contact c, double reach) {
  const dvec2 start(c.u, c.v);
  const double noise = noise_step(geometry, c);
  double last = reach;
  for (int k = 0; k < newton_limit; ++k) {
    const std::optional<SurfaceCurvature> here = surface_curvature(geometry, c);
    if (!here) return std::nullopt;
    const auto residual = [&](double du, double dv) {
      Contact moved = c;
      moved.u += du;
      moved.v += dv;
      return cusp_residual(geometry, moved, here->along);
    };
    const auto u0 = residual(-difference, 0), u1 = residual(difference, 0);
    const auto v0 = residual(0, -difference), v1 = residual(0, difference);
    if (!u0 || !u1 || !v0 || !v1) return std::nullopt;
    const dvec2 by_u = (*u1 - *u0) / (2 * difference);
    const dvec2 by_v = (*v1 - *v0) / (2 * difference);
    const dvec2 f(here->flat, here->cubic);
    const double det = by_u.x * by_v.y - by_v.x * by_u.y;
    const dvec2 step = dvec2(by_v.x * f.y - by_v.y * f.x, by_u.y * f.x - by_u.x * f.y) / det;
    c.u += step.x;
    c.v += step.y;
    if (!(glm::distance(dvec2(c.u, c.v), start) <= reach)) return std::nullopt;
    const double length = glm::length(step);
    if (length < converged_step || (length < noise && length > 0.5 * last)) {
      if (std::abs(det) < least_change * here->area) return std::nullopt;
      return c;
    }
    last = length;
  }
  return std::nullopt;
}

double twist_at(const ContactGeometry& geometry, Contact c, double t) {
  c.u = t;
  const std::optional<CurveCurvature> b = curve_curvature(geometry, c);
  return b ? b->twist : 0;
}

}  // namespace taut
