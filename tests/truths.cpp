#include "truths.h"

#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>

namespace taut_test {
namespace {

constexpr real real_pi = std::numbers::pi_v<real>;
const real sqrt2 = std::sqrt(real(2));
const real sqrt3 = std::sqrt(real(3));

real cube(real x) { return x * x * x; }

struct Body {
  real volume = 0;
  real area = 0;
  /// The integral of the mean curvature: M in V + A r + M r^2 + 4 pi / 3 r^3.
  real mean_curvature = 0;

  /// All points within r of it (Steiner).
  Body grown(real r) const {
    return {volume + area * r + mean_curvature * r * r + 4 * real_pi / 3 * cube(r),
            area + 2 * mean_curvature * r + 4 * real_pi * r * r, mean_curvature + 4 * real_pi * r};
  }
};

/// Integral over [a, b] by Simpson's rule.
real integral(const std::function<real(real)>& f, real a, real b, int pairs = 400) {
  const real h = (b - a) / (2 * pairs);
  real sum = f(a) + f(b);
  for (int k = 1; k < 2 * pairs; ++k) sum += (k % 2 == 1 ? 4 : 2) * f(a + k * h);
  return sum * h / 3;
}

/// Two spheres whose centres lie d apart, d > r1 - r2: two caps and a piece of a cone.
Body of_two_spheres(real r1, real r2, real d) {
  const real s = (r1 - r2) / d;
  return {real_pi / 3 * d * (1 - s * s) * (1 - s * s) * (r1 * r1 + r1 * r2 + r2 * r2) +
              real_pi * cube(r1) * (real(2) / 3 + s - cube(s) / 3) +
              real_pi * cube(r2) * (real(2) / 3 - s + cube(s) / 3),
          real_pi * (r1 + r2) * d * (1 - s * s) + 2 * real_pi * r1 * r1 * (1 + s) +
              2 * real_pi * r2 * r2 * (1 - s)};
}

Body of_disc(real r) { return {0, 2 * real_pi * r * r, real_pi * real_pi * r}; }

Body of_oloid() {
  const real k = sqrt3 / 2;
  return {real(2) / 3 * (2 * std::comp_ellint_2(k) + std::comp_ellint_1(k)), 4 * real_pi,
          13.76442932700307L};
}

Body of_perpendicular_circles() { return {real(8) / 3, 4 + 2 * real_pi, 11.74812872262842L}; }

/// a >= b >= c, not a sphere.
Body of_ellipsoid(real a, real b, real c) {
  const real phi = std::acos(c / a);
  const real k = std::sqrt(a * a * (b * b - c * c) / (b * b * (a * a - c * c)));
  const real sine = std::sin(phi);
  const real cosine = std::cos(phi);
  return {4 * real_pi / 3 * a * b * c,
          2 * real_pi * c * c +
              2 * real_pi * a * b / sine *
                  (std::ellint_2(k, phi) * sine * sine + std::ellint_1(k, phi) * cosine * cosine)};
}

Body of_frustum(real R, real r, real h) {
  return {real_pi * h / 3 * (R * R + R * r + r * r),
          real_pi * (R * R + r * r + (R + r) * std::sqrt((R - r) * (R - r) + h * h))};
}

Body of_cap(real h) {
  return {real_pi * h * h * (3 - h) / 3, 2 * real_pi * h + real_pi * h * (2 - h)};
}

Body of_box(real a, real b, real c) {
  return {a * b * c, 2 * (a * b + b * c + c * a), real_pi * (a + b + c)};
}

/// An equilateral triangle of side a, both sides.
Body of_triangle(real a) { return {0, sqrt3 / 2 * a * a, real_pi / 2 * 3 * a}; }

Body of_tetrahedron(real a) {
  return {cube(a) / (6 * sqrt2), sqrt3 * a * a, 3 * a * (real_pi - std::acos(real(1) / 3))};
}

Body of_paraboloid() {
  const auto lifted = [](real x) {
    return integral([x](real y) { return std::sqrt(1 + 4 * x * x + 4 * y * y); }, -1, 1);
  };
  return {real(16) / 3, 4 + real(16) / 3 + integral(lifted, -1, 1)};
}

/// {x^2 - 1 <= z <= 1 - y^2} over [-1, 1]^2.
Body of_saddle() {
  return {real(16) / 3, 4 * std::sqrt(real(5)) + 2 * std::asinh(real(2)) + real(16) / 3};
}

/// Of (t, t^2, t^3), 0 <= t <= 1: the cones over it from its two ends.
Body of_twisted_cubic() {
  const auto cone = [](real end) {
    return integral(
        [end](real t) {
          const rvec3 x(t - end, t * t - end, t * t * t - end);
          return glm::length(glm::cross(x, rvec3(1, 2 * t, 3 * t * t))) / 2;
        },
        0, 1);
  };
  return {real(1) / 180, cone(0) + cone(1)};
}

/// An affine image of a capsule: two ellipsoids, the one shifted by d.
real two_ellipsoids_volume(real a, real b, real c, const rvec3& d) {
  return a * b * c * (4 * real_pi / 3 + real_pi * glm::length(d / rvec3(a, b, c)));
}

Shape spheres(double r, const std::vector<dvec3>& centers) {
  Shape shape;
  for (const dvec3& center : centers) shape = shape + shifted(sphere(r), center);
  return shape;
}

std::vector<dvec3> corners(double half) {
  std::vector<dvec3> result;
  for (int k = 0; k < 8; ++k) {
    result.push_back(half * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  }
  return result;
}

/// Takes the z axis to the y axis.
dmat3 quarter_turn() { return {1, 0, 0, 0, 0, -1, 0, 1, 0}; }

}  // namespace

std::string test_name(const Truth& truth) {
  std::string name;
  for (const char c : truth.name) name += std::isalnum(c) != 0 ? c : '_';
  return name;
}

std::vector<Truth> truths() {
  std::vector<Truth> all;
  const auto add = [&](const std::string& name, const Shape& shape, const Body& body,
                       bool fine = false) {
    all.push_back({name, shape, body.volume, body.area, 0, fine});
  };
  add("spheres 1 and 1, 3 apart", two_spheres(1, 1, 3), of_two_spheres(1, 1, 3));
  add("spheres 1 and 0.5, 3 apart", two_spheres(1, 0.5, 3), of_two_spheres(1, 0.5, 3), true);
  add("spheres 1 and 0.5, 2 apart", two_spheres(1, 0.5, 2), of_two_spheres(1, 0.5, 2));
  add("sphere and point", sphere() + Shape{{}, {}, {{0, 0, 2}}}, of_two_spheres(1, 0, 2));
  add("torus 2, 0.5", torus(2, 0.5), of_disc(2).grown(0.5), true);
  add("torus 1, 0.25", torus(1, 0.25), of_disc(1).grown(0.25));
  add("oloid", oloid(), of_oloid(), true);
  add("perpendicular circles", perpendicular_circles(), of_perpendicular_circles(), true);
  const Shape ring = torus(1, 0.25);
  add("tori like an oloid", ring + mapped(ring, quarter_turn(), {1, 0, 0}), of_oloid().grown(0.25));
  add("tori about one centre", ring + mapped(ring, quarter_turn()),
      of_perpendicular_circles().grown(0.25));
  // They touch inside patches of one of them, or of both.
  const dmat3 about_itself = {0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};
  const Shape turned = mapped(ring, about_itself);
  add("tori about one centre, one turned", ring + mapped(turned, quarter_turn()),
      of_perpendicular_circles().grown(0.25));
  const double root3 = std::sqrt(3.0);
  add("three spheres", spheres(0.5, {{0, 0, 0}, {2, 0, 0}, {1, root3, 0}}),
      of_triangle(2).grown(0.5));
  const double h = std::sqrt(0.5);
  add("four spheres", spheres(0.5, {{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}}),
      of_tetrahedron(2).grown(0.5));
  add("eight spheres", spheres(0.5, corners(1)), of_box(2, 2, 2).grown(0.5));
  add("ellipsoid", ellipsoid(3, 2, 1), of_ellipsoid(3, 2, 1), true);
  add("two ellipsoids", ellipsoid(3, 2, 1) + shifted(ellipsoid(3, 2, 1), {2, 3, 2}),
      {two_ellipsoids_volume(3, 2, 1, {2, 3, 2}), -1});
  add("cylinder", cylinder(1, 2), of_frustum(1, 1, 2), true);
  add("solid cylinder", solid_cylinder(1, 2), of_frustum(1, 1, 2), true);
  add("cone", solid_cone(1, 2), of_frustum(1, 0, 2), true);
  add("frustum", frustum(1, 0.5, 2), of_frustum(1, 0.5, 2), true);
  add("box", box(1, 2, 3), of_box(1, 2, 3), true);
  add("filleted box", filleted_box(1, 2, 3, 0.2),
      of_box(1 - 2 * real(0.2), 2 - 2 * real(0.2), 3 - 2 * real(0.2)).grown(0.2), true);
  add("cap", spherical_cap(0.6), of_cap(0.6));
  add("sphere without a cap", spherical_cap(1.4), of_cap(1.4));
  add("paraboloid", paraboloid(), of_paraboloid());
  add("bilinear saddle", bilinear_saddle(), {real(8) / 3, 8 * sqrt3}, true);
  add("saddle", saddle(), of_saddle(), true);
  add("twisted cubic", {{}, {twisted_cubic()}, {}}, of_twisted_cubic(), true);
  // No closed forms: numbers with an uncertain last digit.
  all.push_back({"teapot", teapot(), 32.67038L, 53.66226L, 2e-5L, true});
  all.push_back({"dented ellipsoid", dented_ellipsoid(), 20.0487L, 41.6055L, 2e-4L, false});
  return all;
}

}  // namespace taut_test
