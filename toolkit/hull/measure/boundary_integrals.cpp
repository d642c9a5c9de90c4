#include "taut/hull/measure/boundary_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Relative accuracy of every single rule: what contacts solved to 1e-13 can give.
constexpr double rule_accuracy = 1e-13;
/// Roundings of a second derivative, in the scene's frame, which curvature has whatever a patch's
/// size.
constexpr double curvature_rounding = 16 * rounding_unit;

}  // namespace

void add_element(Quantities& sum, const dvec3& x, const dvec3& A, double dA, double w) {
  const double flux = w * glm::dot(x, A);
  sum[volume] += flux / 3;
  sum[area] += w * dA;
  for (int i = 0; i < 3; ++i) {
    const auto k = std::size_t(i);
    sum[moment + k] += flux / 4 * x[i];
    sum[second + k] += flux / 5 * x[i] * x[i];
    sum[second + 3 + k] += flux / 5 * x[(i + 1) % 3] * x[(i + 2) % 3];
    sum[surface_moment + k] += w * dA * x[i];
    sum[vector_area + k] += w * A[i];
  }
}

void add_patch(const ContactJet& j, const dvec3& origin, int sign, Quantities& sum) {
  const dvec3 N = double(sign) * glm::cross(j.dx[0], j.dx[1]);
  const double length = glm::length(N);
  add_element(sum, j.x - origin, N, length, 1);
  if (length == 0) return;
  // H dA with H = (E n - 2 F m + G l) / (2 |N|^2), l = -Suu . N / |N| and so on: positive where the
  // surface is convex (do Carmo 1976, section 3-3).
  const double E = glm::dot(j.dx[0], j.dx[0]);
  const double F = glm::dot(j.dx[0], j.dx[1]);
  const double G = glm::dot(j.dx[1], j.dx[1]);
  const double form = E * glm::dot(j.dyy, N) - 2 * F * glm::dot(j.dxy, N) + G * glm::dot(j.dxx, N);
  sum[curvature] -= form / (2 * length * length);
}

double crease(const dvec3& x, const dvec3& tangent, const dvec3& n) {
  const double length = glm::length(tangent);
  if (length == 0) return 0;
  const dvec3 T = tangent / length;
  const dvec3 across = glm::cross(T, x);  // T x m, as long as m
  const double phi = std::atan2(glm::dot(n, across), glm::dot(n, glm::cross(across, T)));
  return 0.5 * length * phi;
}

Quantities tolerances(const Quantities& magnitude) {
  Quantities result{};
  const auto largest = [&](std::size_t from, std::size_t to) {
    double m = 0;
    for (std::size_t k = from; k < to; ++k) m = std::max(m, magnitude[k]);
    return m;
  };
  const double areas = std::max(magnitude[area], largest(vector_area, ruled));
  const double rounding = 8 * rounding_unit * std::max(areas, std::sqrt(areas));
  const auto set = [&](std::size_t from, std::size_t to) {
    const double m = rule_accuracy * largest(from, to) + rounding;
    for (std::size_t k = from; k < to; ++k) result[k] = m;
  };
  set(volume, volume + 1);
  set(curvature, curvature + 1);
  set(moment, second);
  set(second, surface_moment);
  set(surface_moment, vector_area);
  set(vector_area, ruled);
  std::fill(result.begin() + ruled, result.end(), std::numeric_limits<double>::max());
  result[area] = result[vector_area];
  result[curvature] += 8 * rounding_unit * magnitude[curvature] + curvature_rounding;
  return result;
}

}  // namespace taut
