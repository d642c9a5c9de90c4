#include "taut/hull/contact/local_curvature.h"

#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Speeds and sines of the angle between tangents below this are those of a pole.
constexpr double least_pole_speed = coordinate_rounding;
constexpr double least_pole_sine = spurious_share;

/// Symmetric 2x2 matrix.
struct Form {
  double aa, ab, bb;
};

/// Sets the two eigenvalues by their size, and the eigenvector of the smaller one. By the
/// determinant, which loses nothing where it vanishes.
dvec2 split(const Form& form, double& flat, double& steep) {
  const double mean = 0.5 * (form.aa + form.bb);
  const double half = 0.5 * (form.aa - form.bb);
  steep = mean + std::copysign(std::hypot(half, form.ab), mean);
  flat = steep == 0 ? 0 : (form.aa * form.bb - form.ab * form.ab) / steep;
  const dvec2 a(form.ab, flat - form.aa);
  const dvec2 b(flat - form.bb, form.ab);
  const dvec2 longer = glm::dot(a, a) >= glm::dot(b, b) ? a : b;
  const double length = glm::length(longer);
  return length > 0 ? longer / length : dvec2(1, 0);
}

}  // namespace

std::optional<SurfaceCurvature> surface_curvature(const ContactGeometry& geometry,
                                                  const Contact& c) {
  const PatchJet3 j = geometry.patch_jet(c);
  const dvec3 normal = glm::cross(j.Su, j.Sv);
  const double speed = glm::length(j.Su);
  SurfaceCurvature local;
  local.area = glm::length(normal);
  if (!(speed > least_pole_speed) || !(local.area > least_pole_sine * speed * glm::length(j.Sv)) ||
      !(local.area > least_pole_speed * speed)) {
    return std::nullopt;
  }
  local.x = j.S;
  local.n = normal / local.area;
  // Rates of the parameters along two orthogonal tangents of unit length, the first along Su.
  const dvec2 a(1 / speed, 0);
  const double across = local.area / speed;
  const dvec2 b(-glm::dot(j.Su, j.Sv) / (speed * speed * across), 1 / across);
  const double uu = glm::dot(j.Suu, local.n);
  const double uv = glm::dot(j.Suv, local.n);
  const double vv = glm::dot(j.Svv, local.n);
  const auto second = [&](const dvec2& p, const dvec2& q) {
    return uu * p.x * q.x + uv * (p.x * q.y + p.y * q.x) + vv * p.y * q.y;
  };
  const dvec2 e = split({second(a, a), second(a, b), second(b, b)}, local.flat, local.steep);
  if (local.steep > 0) {
    local.n = -local.n;
    local.flat = -local.flat;
    local.steep = -local.steep;
  }
  local.rate = e.x * a + e.y * b;
  local.along = unit(local.rate.x * j.Su + local.rate.y * j.Sv);
  const double u = local.rate.x;
  const double v = local.rate.y;
  const dvec3 third =
      u * u * u * j.Suuu + 3 * u * v * (u * j.Suuv + v * j.Suvv) + v * v * v * j.Svvv;
  local.cubic = glm::dot(third, local.n);
  local.third = glm::length(third);
  return local;
}

std::optional<CurveCurvature> curve_curvature(const ContactGeometry& geometry, const Contact& c) {
  const CurveJet j = geometry.curve_jet(c);
  const double speed = glm::length(j.ct);
  if (!(speed > least_pole_speed)) return std::nullopt;
  CurveCurvature local;
  local.x = j.c;
  local.along = j.ct / speed;
  local.second = j.ctt / (speed * speed);
  local.third = j.cttt / (speed * speed * speed);
  const dvec3 cross = glm::cross(local.along, local.second);
  local.curvature = glm::length(cross);
  local.binormal = unit(cross);
  local.twist = glm::dot(cross, local.third);
  return local;
}

bool ends_straight(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::edge || (c.u != 0 && c.u != 1)) return false;
  const ContactJet j = geometry.jet(c);
  const double bent = glm::length(glm::cross(unit(j.dx[0]), j.dxx));
  return bent < std::sqrt(geometry.rounding()) * glm::dot(j.dx[0], j.dx[0]);
}

}  // namespace taut
