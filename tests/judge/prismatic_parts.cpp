#include "families.h"
#include "patterns.h"
#include "sweeps.h"

namespace taut_test {
namespace {

std::vector<dvec3> rectangle(double a, double b) {
  return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
}

Natural box_of(Random& random) {
  const double a = uniform(random, 10, 60), b = uniform(random, 10, 60), c = uniform(random, 5, 40);
  return {box(a, b, c), {a * b * c, {0, 0, 6, 12}, (a + b + c) / 2}};
}

/// All twelve edges are cut by planes, all corners by triangles.
Natural chamfered_box(Random& random) {
  const dvec3 half(uniform(random, 10, 30), uniform(random, 10, 30), uniform(random, 5, 20));
  const double cut = uniform(random, 1, 3);
  // The corner of a face next to the one that the signs tell.
  const auto corner = [&](int axis, const dvec3& sign) {
    dvec3 p = half - dvec3(cut);
    p[axis] = half[axis];
    return sign * p;
  };
  Shape shape;
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const auto signs = [&](double s, double si, double sj) {
      dvec3 sign(0.0);
      sign[axis] = s, sign[i] = si, sign[j] = sj;
      return sign;
    };
    for (const int s : {-1, 1}) {
      shape.surfaces.push_back(quad(corner(axis, signs(s, -1, -1)), corner(axis, signs(s, 1, -1)),
                                    corner(axis, signs(s, 1, 1)), corner(axis, signs(s, -1, 1))));
      for (const int t : {-1, 1}) {
        shape.surfaces.push_back(quad(corner(i, signs(-1, s, t)), corner(i, signs(1, s, t)),
                                      corner(j, signs(1, s, t)), corner(j, signs(-1, s, t))));
      }
    }
  }
  for (int octant = 0; octant < 8; ++octant) {
    const dvec3 sign(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    shape.surfaces.push_back(
        quad(corner(0, sign), corner(1, sign), corner(2, sign), corner(0, sign)));
  }
  return {shape, {unknown, {0, 0, 26, 48}}};
}

Natural plate_with_round_corners(Random& random) {
  const double a = uniform(random, 40, 80), b = uniform(random, 30, 60), h = uniform(random, 2, 8);
  const double r = uniform(random, 3, 8);
  return {prism(rounded(rectangle(a, b), r, true), h, {a / 2, b / 2, 0}),
          {h * (a * b - (4 - pi) * r * r), {0, 4, 6, 24}}};
}

/// Round corners and a fillet about the upper side.
Natural filleted_plate(Random& random) {
  const double a = uniform(random, 40, 80), b = uniform(random, 30, 60), h = uniform(random, 4, 8);
  const double R = uniform(random, 5, 9), r = uniform(random, 1, 3);
  Shape shape;
  const dvec3 middle(a / 2, b / 2, 0);
  const NurbsCurve wall = segment({R, 0, 0}, {R, 0, h - r});
  const NurbsCurve fillet = arc({R, 0, h - r}, {R, 0, h}, {R - r, 0, h});
  const std::vector<dvec3> centers = {{a - R, b - R, 0}, {R, b - R, 0}, {R, R, 0}, {a - R, R, 0}};
  for (int k = 0; k < 4; ++k) {
    const Shape corner = of({quarter_turn(wall), quarter_turn(fillet)});
    shape = shape + mapped(corner, turn_about_z(pi / 2 * k), centers[std::size_t(k)]);
    const dvec3 out = on_circle(1, pi / 2 * (k + 1));
    const dvec3 along = centers[std::size_t(k + 1) % 4] - centers[std::size_t(k)];
    const dvec3 from = centers[std::size_t(k)];
    const auto at = [&](double x, double z) { return from + x * out + dvec3(0, 0, z); };
    shape.surfaces.push_back(extruded(segment(at(R, 0), at(R, h - r)), along));
    shape.surfaces.push_back(extruded(arc(at(R, h - r), at(R, h), at(R - r, h)), along));
    shape.surfaces.push_back(
        fan(segment(at(R - r, h), at(R - r, h) + along), middle + dvec3(0, 0, h)));
  }
  return {shape, {unknown, {4, 8, 6, 40}}};
}

Natural cam(Random& random) {
  std::vector<dvec3> points = ring(9, [&](int) { return uniform(random, 14, 22); });
  return {prism({closed_spline(points)}, uniform(random, 5, 12), dvec3(0.0))};
}

Natural gear(Random& random) {
  const int teeth = pick(random, 8, 14);
  const double R = uniform(random, 20, 40), depth = uniform(random, 2, 4);
  std::vector<dvec3> outline;
  for (int k = 0; k < teeth; ++k) {
    const double pitch = 2 * pi / teeth;
    outline.push_back(on_circle(R - depth, pitch * k));
    outline.push_back(on_circle(R, pitch * (k + 0.2)));
    outline.push_back(on_circle(R, pitch * (k + 0.5)));
    outline.push_back(on_circle(R - depth, pitch * (k + 0.7)));
  }
  return {prism(rounded(outline, 0.3, true), uniform(random, 4, 10), dvec3(0.0)),
          {unknown, {0, 2 * teeth, 2 * teeth + 2, 12 * teeth}}};
}

Natural bracket(Random& random) {
  const double a = uniform(random, 30, 50), b = uniform(random, 20, 40), t = uniform(random, 3, 6);
  const std::vector<dvec3> outline = {{0, 0, 0}, {a, 0, 0}, {a, t, 0},
                                      {t, t, 0}, {t, b, 0}, {0, b, 0}};
  return {prism(rounded(outline, 1, true), uniform(random, 10, 30), {t / 2, t / 2, 0}),
          {unknown, {0, 5, 7, 30}}};
}

Natural connecting_rod(Random& random) {
  const double d = uniform(random, 50, 80), R = uniform(random, 10, 15), r = uniform(random, 5, 9);
  const double h = uniform(random, 6, 10), web = uniform(random, 2, 4);
  const double w = uniform(random, 2, 4);
  return {solid_cylinder(R, h) + shifted(solid_cylinder(r, h), {d, 0, 0}) +
              shifted(box(d, 2 * w, web), {0, -w, (h - web) / 2}),
          {unknown, {0, 2, 4, 12}}};
}

}  // namespace

Natural rounded_box(Random& random) {
  const double a = uniform(random, 20, 60), b = uniform(random, 20, 60),
               c = uniform(random, 10, 40);
  const double r = uniform(random, 1, 4);
  const double x = a - 2 * r, y = b - 2 * r, z = c - 2 * r;
  const double volume =
      x * y * z + 2 * r * (x * y + y * z + z * x) + pi * r * r * (x + y + z) + 4 * pi / 3 * cube(r);
  return {filleted_box(a, b, c, r), {volume, {8, 12, 6, 48}, (x + y + z) / 2 + 2 * r}};
}

std::vector<Family> prismatic_parts() {
  return {
      {"box", box_of},
      {"rounded_box", rounded_box},
      {"chamfered_box", chamfered_box},
      {"plate_with_round_corners", plate_with_round_corners},
      {"filleted_plate", filleted_plate},
      {"cam", cam},
      {"gear", gear},
      {"bracket", bracket},
      {"connecting_rod", connecting_rod},
  };
}

}  // namespace taut_test
