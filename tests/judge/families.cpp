#include "families.h"

#include <cmath>
#include <utility>

#include "cages.h"
#include "freeform.h"
#include "plates.h"
#include "sweeps.h"

namespace taut_test {
namespace {

double cube(double x) { return x * x * x; }
double square(double x) { return x * x; }

dvec3 on_circle(double radius, double angle, double z = 0) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

dmat3 turn_about_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}
/// z to x, x to y, y to z.
const dmat3 z_to_x(0, 1, 0, 0, 0, 1, 1, 0, 0);
const dmat3 mirror_x(-1, 0, 0, 0, 1, 0, 0, 0, 1);
const dmat3 mirror_y(1, 0, 0, 0, -1, 0, 0, 0, 1);
const dmat3 mirror_z(1, 0, 0, 0, 1, 0, 0, 0, -1);

Shape with_mirror(const Shape& shape, const dmat3& mirror) { return shape + mapped(shape, mirror); }

/// Copies about the z axis.
Shape patterned(const Shape& shape, int count) {
  Shape result;
  for (int k = 0; k < count; ++k) result = result + mapped(shape, turn_about_z(2 * pi * k / count));
  return result;
}

std::vector<dvec3> rectangle(double a, double b) {
  return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
}

std::vector<dvec3> ring(int count, const std::function<double(int)>& radius, double z = 0) {
  std::vector<dvec3> points;
  for (int k = 0; k < count; ++k) points.push_back(on_circle(radius(k), 2 * pi * k / count, z));
  return points;
}

/// @name Prismatic parts
/// @{
Natural box_of(Random& random) {
  const double a = uniform(random, 10, 60), b = uniform(random, 10, 60), c = uniform(random, 5, 40);
  return {box(a, b, c), a * b * c};
}

Natural rounded_box(Random& random) {
  const double a = uniform(random, 20, 60), b = uniform(random, 20, 60),
               c = uniform(random, 10, 40);
  const double r = uniform(random, 1, 4);
  const double x = a - 2 * r, y = b - 2 * r, z = c - 2 * r;
  const double volume =
      x * y * z + 2 * r * (x * y + y * z + z * x) + pi * r * r * (x + y + z) + 4 * pi / 3 * cube(r);
  return {filleted_box(a, b, c, r), volume};
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
  return {shape};
}

Natural plate_with_round_corners(Random& random) {
  const double a = uniform(random, 40, 80), b = uniform(random, 30, 60), h = uniform(random, 2, 8);
  const double r = uniform(random, 3, 8);
  return {prism(rounded(rectangle(a, b), r, true), h, {a / 2, b / 2, 0}),
          h * (a * b - (4 - pi) * r * r)};
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
  return {shape};
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
  return {prism(rounded(outline, 0.3, true), uniform(random, 4, 10), dvec3(0.0))};
}

Natural bracket(Random& random) {
  const double a = uniform(random, 30, 50), b = uniform(random, 20, 40), t = uniform(random, 3, 6);
  const std::vector<dvec3> outline = {{0, 0, 0}, {a, 0, 0}, {a, t, 0},
                                      {t, t, 0}, {t, b, 0}, {0, b, 0}};
  return {prism(rounded(outline, 1, true), uniform(random, 10, 30), {t / 2, t / 2, 0})};
}

Natural connecting_rod(Random& random) {
  const double d = uniform(random, 50, 80), R = uniform(random, 10, 15), r = uniform(random, 5, 9);
  const double h = uniform(random, 6, 10), web = uniform(random, 2, 4);
  const double w = uniform(random, 2, 4);
  return {solid_cylinder(R, h) + shifted(solid_cylinder(r, h), {d, 0, 0}) +
          shifted(box(d, 2 * w, web), {0, -w, (h - web) / 2})};
}
/// @}

/// @name Turned parts
/// @{
Natural cylinder_of(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 50);
  return {solid_cylinder(r, h), pi * r * r * h};
}

Natural cone_of(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 50);
  return {solid_cone(r, h), pi * r * r * h / 3};
}

Natural frustum_of(Random& random) {
  const double R = uniform(random, 15, 25), r = uniform(random, 5, 12), h = uniform(random, 10, 50);
  return {frustum(R, r, h), pi * h * (R * R + R * r + r * r) / 3};
}

Natural ball(Random& random) {
  const double r = uniform(random, 5, 20);
  return {sphere(r), 4 * pi / 3 * cube(r)};
}

Natural ring_torus(Random& random) {
  const double R = uniform(random, 15, 30), r = uniform(random, 2, 10);
  return {torus(R, r), 2 * pi * R * R * r + pi * pi * R * r * r + 4 * pi / 3 * cube(r)};
}

Natural shaft(Random& random) {
  std::vector<dvec3> profile = {{0, 0, 0}};
  double z = 0;
  for (int k = 0; k < 3; ++k) {
    const double r = uniform(random, 5, 9) + 3 * k;
    profile.emplace_back(r, 0, z);
    z += uniform(random, 10, 20);
    profile.emplace_back(r, 0, z);
  }
  profile.emplace_back(0, 0, z);
  return {revolved_all(rounded(profile, uniform(random, 0.5, 1), false))};
}

Natural bottle(Random& random) {
  std::vector<dvec3> profile = {{uniform(random, 15, 20), 0, 0}};
  for (int k = 1; k < 7; ++k) {
    profile.emplace_back(k < 4 ? uniform(random, 14, 22) : uniform(random, 4, 9), 0, 10 * k);
  }
  return {revolved_all({segment({0, 0, 0}, profile[0]), spline(profile)})};
}

Natural cup(Random& random) {
  const double R = uniform(random, 15, 25), h = uniform(random, 20, 40), t = uniform(random, 1, 2);
  const std::vector<dvec3> profile = {{0, 0, 0},     {0.8 * R, 0, 0},     {R, 0, h},
                                      {R - t, 0, h}, {0.8 * R - t, 0, t}, {0, 0, t}};
  return {revolved_all(rounded(profile, 0.45 * t, false))};
}

Natural capsule(Random& random) {
  const double r = uniform(random, 5, 15), h = uniform(random, 10, 40);
  const std::vector<NurbsCurve> profile = {arc({0, 0, -r}, {r, 0, -r}, {r, 0, 0}),
                                           segment({r, 0, 0}, {r, 0, h}),
                                           arc({r, 0, h}, {r, 0, h + r}, {0, 0, h + r})};
  return {revolved_all(profile), pi * r * r * h + 4 * pi / 3 * cube(r)};
}

/// Two caps of one sphere's radius, rim to rim.
Natural lens(Random& random) {
  const double height = uniform(random, 0.1, 0.5), R = uniform(random, 20, 50);
  const Shape cap = scaled(shifted(spherical_cap(height), {0, 0, height - 1}), R);
  return {with_mirror(cap, mirror_z), 2 * pi * square(height * R) * (R - height * R / 3)};
}

Natural wheel(Random& random) {
  const double R = uniform(random, 25, 40), h = uniform(random, 5, 10), rim = uniform(random, 2, 3);
  const std::vector<dvec3> profile = {{0, 0, -h / 4},    {R - 6, 0, -h / 4}, {R - 6, 0, -h / 2},
                                      {R, 0, -h / 2},    {R, 0, h / 2},      {R - 6, 0, h / 2},
                                      {R - 6, 0, h / 4}, {0, 0, h / 4}};
  return {revolved_all(rounded(profile, 0.3 * rim, false))};
}

/// Bosses on a circle on a disc.
Natural bolt_circle(Random& random) {
  const double R = uniform(random, 20, 30), h = uniform(random, 3, 6), r = uniform(random, 2, 4);
  const int count = pick(random, 3, 8);
  const Shape boss = shifted(solid_cylinder(r, 2 * h), {R - r - 1, 0, 0});
  return {solid_cylinder(R, h) + patterned(boss, count)};
}

Natural bolt(Random& random) {
  const double r = uniform(random, 3, 6), h = uniform(random, 20, 40), key = uniform(random, 6, 9);
  const std::vector<dvec3> hexagon = ring(6, [&](int) { return key; });
  return {prism(rounded(hexagon, 0, true), 4, dvec3(0.0)) +
          shifted(solid_cylinder(r, h), {0, 0, -h})};
}
/// @}

/// @name Swept parts
/// @{
/// A tube of bicubic patches through rings about a curve.
Shape tube(int count, double radius, const std::function<dvec3(double)>& center) {
  std::vector<NurbsCurve> rings;
  for (int k = 0; k <= count; ++k) {
    const double t = double(k) / count;
    const auto [a, b] = taut::tangent_frame(taut::unit(center(t + 1e-4) - center(t - 1e-4)));
    std::vector<dvec3> points;
    for (int j = 0; j < 8; ++j) {
      points.push_back(center(t) + radius * (std::cos(pi / 4 * j) * a + std::sin(pi / 4 * j) * b));
    }
    rings.push_back(closed_spline(points));
  }
  return of({lofted(rings)});
}

Natural spring(Random& random) {
  const double R = uniform(random, 10, 20), r = uniform(random, 1, 2),
               pitch = uniform(random, 5, 8);
  const double turns = uniform(random, 1.5, 3);
  return {tube(int(12 * turns), r,
               [&](double t) { return on_circle(R, 2 * pi * turns * t, pitch * turns * t); })};
}

/// A ruled helical strip and its copies along the axis.
Natural thread(Random& random) {
  const double R = uniform(random, 8, 12), r = uniform(random, 6, 7), pitch = uniform(random, 2, 4);
  std::vector<dvec3> outer, inner;
  for (int k = 0; k <= 8; ++k) {
    const double angle = pi / 4 * k;
    outer.push_back(on_circle(R, angle, pitch * k / 8 + 0.5));
    inner.push_back(on_circle(r, angle, pitch * k / 8));
  }
  const Shape strip = of({ruled(spline(outer), spline(inner))});
  Shape shape;
  for (int k = 0; k < 3; ++k) shape = shape + shifted(strip, {0, 0, pitch * k});
  return {shape};
}

Natural bent_pipe(Random& random) {
  const double r = uniform(random, 3, 6), R = uniform(random, 12, 20);
  const double h = uniform(random, 10, 30), g = uniform(random, 10, 30);
  const NurbsCurve end = circle({R, 0, 0}, {r, 0, 0}, {0, 0, r});
  Shape shape = of({quarter_turn(end), extruded(end, {0, -h, 0})});
  const NurbsCurve other = circle({0, R, 0}, {0, r, 0}, {0, 0, r});
  shape.surfaces.push_back(extruded(other, {-g, 0, 0}));
  return {shape};
}

/// Between a rectangle and a circle.
Natural duct(Random& random) {
  const double a = uniform(random, 20, 30), b = uniform(random, 10, 20), r = uniform(random, 6, 9);
  const double h = uniform(random, 20, 40);
  Shape shape;
  const NurbsCurve round = circle({0, 0, h}, {r, 0, 0}, {0, r, 0});
  shape.curves = {round};
  const std::vector<dvec3> corners = {
      {a / 2, b / 2, 0}, {-a / 2, b / 2, 0}, {-a / 2, -b / 2, 0}, {a / 2, -b / 2, 0}};
  for (int k = 0; k < 4; ++k) {
    const dvec3 p = on_circle(r, pi / 2 * k, h), q = on_circle(r, pi / 2 * (k + 1), h);
    const NurbsCurve quarter = arc(p, p + q - dvec3(0, 0, h), q);
    const dvec3& corner = corners[std::size_t(k)];
    shape.surfaces.push_back(fan(quarter, corner));
    shape.surfaces.push_back(quad(corner, q, q, corners[std::size_t(k + 1) % 4]));
  }
  return {shape};
}

Natural wing(Random& random) {
  const double span = uniform(random, 60, 100), taper = uniform(random, 0.4, 0.8);
  const double sweep = uniform(random, 0, 20), thick = uniform(random, 0.1, 0.15);
  const auto section = [&](double chord, const dvec3& at, double side) {
    std::vector<dvec3> points;
    for (const double x : {1.0, 0.75, 0.5, 0.25, 0.08}) {
      points.push_back(at + chord * dvec3(x, 0, side * thick * 2.5 * std::sqrt(x) * (1 - x)));
    }
    points.push_back(at + chord * dvec3(0, 0, 0.02 * side));
    points.push_back(at);
    return spline(points);
  };
  Shape shape;
  const double chord = uniform(random, 20, 30);
  for (const double side : {1.0, -0.6}) {
    shape.surfaces.push_back(
        ruled(section(chord, dvec3(0.0), side), section(taper * chord, {sweep, span, 4}, side)));
  }
  return {shape};
}

Natural twisted_blade(Random& random) {
  const double length = uniform(random, 30, 50), twist = uniform(random, 0.3, 0.8);
  std::vector<std::vector<dvec3>> rows;
  for (int k = 0; k < 5; ++k) {
    const double angle = twist * k / 4, chord = 10 - 1.5 * k;
    std::vector<dvec3> row;
    for (int j = 0; j < 5; ++j) {
      const double x = chord * (j / 4.0 - 0.5), z = 0.6 * (1 - square(j / 2.0 - 1));
      row.emplace_back(5 + length * k / 4, std::cos(angle) * x - std::sin(angle) * z,
                       std::sin(angle) * x + std::cos(angle) * z);
    }
    rows.push_back(row);
  }
  return {of({spline(rows)})};
}

Natural propeller(Random& random) {
  const int blades = pick(random, 2, 5);
  return {patterned(twisted_blade(random).shape, blades) +
          shifted(solid_cylinder(6, 8), {0, 0, -4})};
}
/// @}

/// @name Sheets
/// @{
Natural ship(Random& random) {
  const double length = uniform(random, 60, 100), beam = uniform(random, 8, 12), depth = 10;
  std::vector<std::vector<dvec3>> rows;
  for (int k = 0; k < 5; ++k) {
    const double t = k / 4.0, width = beam * (k == 4 ? 0 : 1 - square(square(t)));
    std::vector<dvec3> row;
    for (int j = 0; j < 4; ++j) {
      const double s = j / 3.0;
      row.emplace_back(length * t + (k == 4 ? 4 * s : 0), width * std::sqrt(s), depth * (s - 1));
    }
    rows.push_back(row);
  }
  return {with_mirror(of({spline(rows)}), mirror_y)};
}

Natural fuselage(Random& random) {
  const double length = uniform(random, 60, 100);
  std::vector<dvec3> profile = {{0, 0, 0}};
  for (int k = 0; k < 6; ++k) profile.emplace_back(uniform(random, 6, 9), 0, length * k / 5);
  profile.emplace_back(0, 0, length + 5);
  return {mapped(of({revolved(spline(profile))}), z_to_x)};
}

Natural terrain(Random& random) {
  std::vector<std::vector<dvec3>> rows;
  for (int k = 0; k < 8; ++k) {
    std::vector<dvec3> row;
    for (int j = 0; j < 8; ++j) row.emplace_back(10 * k, 10 * j, uniform(random, 0, 12));
    rows.push_back(row);
  }
  return {of({spline(rows)})};
}

Natural roof(Random& random) {
  const double a = uniform(random, 20, 40), b = uniform(random, 20, 40), h = uniform(random, 5, 15);
  return {of({quad({0, 0, 0}, {a, 0, h}, {a, b, 0}, {0, b, h})}), a * b * h / 3};
}

Shape dome_patch(Random& random, double a) {
  std::vector<std::vector<dvec3>> rows;
  for (int k = 0; k < 4; ++k) {
    std::vector<dvec3> row;
    for (int j = 0; j < 4; ++j) {
      const bool inner = k % 3 != 0 && j % 3 != 0;
      row.emplace_back(a * k / 3, a * j / 3, inner ? uniform(random, 8, 14) : 0);
    }
    rows.push_back(row);
  }
  return of({spline(rows)});
}

Natural dome_of(Random& random) { return {dome_patch(random, 30)}; }
Natural mirrored_domes(Random& random) { return {with_mirror(dome_patch(random, 30), mirror_z)}; }
Natural domes_in_a_row(Random& random) {
  const Shape dome = dome_patch(random, 30);
  Shape shape;
  for (int k = 0; k < 3; ++k) shape = shape + shifted(dome, {40.0 * k, 0, 0});
  return {shape};
}
Natural car_body(Random& random) {
  std::vector<std::vector<dvec3>> rows;
  for (int k = 0; k < 7; ++k) {
    const double roof = k < 2 || k > 5 ? 8 : uniform(random, 13, 15);
    std::vector<dvec3> row;
    for (int j = 0; j < 4; ++j) {
      row.emplace_back(7 * k, j == 0 ? 0 : 6 + 2 * j, roof * (1 - square(j / 3.0)));
    }
    rows.push_back(row);
  }
  return {with_mirror(of({spline(rows)}), mirror_y)};
}
Natural freeform_body(Random& random) {
  return {scaled(blob(unsigned(pick(random, 1, 1000))), 20)};
}
Natural ellipsoid_of(Random& random) {
  const double a = uniform(random, 5, 30), b = uniform(random, 5, 30), c = uniform(random, 5, 30);
  return {ellipsoid(a, b, c), 4 * pi / 3 * a * b * c};
}
/// @}

/// @name Assemblies and copies
/// @{
Natural box_on_cylinder(Random& random) {
  const double r = uniform(random, 8, 12), h = uniform(random, 10, 20);
  return {solid_cylinder(r, h) + shifted(box(16, 16, 8), {-8, -8, h})};
}
Natural overlapping_balls(Random& random) {
  Shape shape;
  for (int k = 0; k < 5; ++k) {
    const double r = uniform(random, 4, 9);
    shape = shape + shifted(sphere(r), 12.0 * random_point(random));
  }
  return {shape};
}
Natural balls_in_a_row(Random& random) {
  const double r = uniform(random, 4, 9), d = uniform(random, 10, 20);
  Shape shape;
  for (int k = 0; k < 3; ++k) shape = shape + shifted(sphere(r), {d * k, 0, 0});
  return {shape, 2 * d * pi * r * r + 4 * pi / 3 * cube(r)};
}
Natural walls_of_nearly_one_radius(Random& random) {
  const double r = uniform(random, 8, 12), more = r * log_uniform(random, 1e-8, 1e-3);
  const double h = uniform(random, 10, 20);
  return {cylinder(r, h) + shifted(cylinder(r + more, h), {0, 0, h})};
}
Natural copies_all_but_in_place(Random& random) {
  const double off = log_uniform(random, 1e-9, 1e-3);
  const Natural one = rounded_box(random);
  return {one.shape + shifted(one.shape, off * random_direction(random))};
}
Natural copies_turned_a_little(Random& random) {
  const Natural one = capsule(random);
  const double angle = 1e-8;
  const dmat3 turn(1, 0, -angle, 0, 1, 0, angle, 0, 1);
  return {one.shape + mapped(one.shape, turn)};
}
Natural ball_of_two_seams(Random& random) {
  const double r = uniform(random, 5, 20);
  return {sphere(r) + mapped(sphere(r), random_rotation(random)), 4 * pi / 3 * cube(r)};
}
Natural overlapping_walls(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 20);
  const Shape other = mapped(cylinder(r, h), turn_about_z(uniform(random, 0.1, 1)), {0, 0, h / 2});
  return {cylinder(r, h) + other, 1.5 * pi * r * r * h};
}
/// A can with its rims as edges of their own, off the faces by little.
Natural cut_by_edges(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 20);
  const double off = log_uniform(random, 1e-9, 1e-5);
  Shape shape = solid_cylinder(r, h);
  for (const double z : {0.0, h}) {
    shape.curves.push_back(circle({off, 0, z - off}, {r, 0, 0}, {0, r, 0}));
  }
  return {shape};
}
Natural plate_of_bosses(Random& random) {
  const Plate plate = random_plate(unsigned(pick(random, 1, 1000)));
  return {plate.shape(), measures_of(plate).volume};
}
/// @}

/// @name Curves, points and cages
/// @{
Natural two_circles(Random& random) {
  const double R = uniform(random, 10, 25), r = uniform(random, 5, 25), h = uniform(random, 10, 20);
  const Shape shape = {
      {}, {circle(dvec3(0.0), {R, 0, 0}, {0, R, 0}), circle({0, 0, h}, {r, 0, 0}, {0, r, 0})}, {}};
  return {shape, pi * h * (R * R + R * r + r * r) / 3};
}
Natural wires(Random& random) {
  Shape shape;
  for (int k = 0; k < 3; ++k) {
    std::vector<dvec3> points;
    for (int j = 0; j < 6; ++j) points.push_back(20.0 * random_point(random));
    shape.curves.push_back(spline(points));
  }
  return {shape};
}
Natural points_in_a_ball(Random& random) {
  Shape shape;
  for (int k = 0; k < 500; ++k) {
    shape.points.push_back(20 * std::cbrt(uniform(random, 0, 1)) * random_direction(random));
  }
  return {shape};
}
Natural grid_of_points(Random& random) {
  const double step = uniform(random, 1, 5);
  Shape shape;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) shape.points.push_back(step * dvec3(i, j, k));
    }
  }
  return {shape, 24 * cube(step)};
}

taut::ControlCage disturbed(taut::ControlCage cage, Random& random) {
  const double size = size_of(cage);
  for (dvec3& p : cage.points) p += 0.05 * size * random_point(random);
  return cage;
}
Natural smooth_cage(Random& random) { return {{}, unknown, disturbed(cube_cage(), random)}; }
Natural loop_cage(Random& random) {
  return {{}, unknown, disturbed(tetrahedron_cage(CageScheme::loop), random)};
}
Natural ring_cage(Random& random) {
  return {{}, unknown, disturbed(torus_cage(pick(random, 4, 6), pick(random, 4, 6)), random)};
}
Natural creased_cage(Random& random) {
  taut::ControlCage cage = disturbed(cube_cage(), random);
  const double least = cage.points[0].z;
  make_sharp(
      cage, [&](const dvec3& p) { return p.z >= least; }, 2.5);
  return {{}, unknown, cage};
}
Natural open_cage(Random& random) { return {{}, unknown, disturbed(sheet_cage(4, 4), random)}; }
Natural profile_cage(Random& random) { return {{}, unknown, disturbed(l_profile_cage(), random)}; }
/// @}

}  // namespace

const char* name_of(Variant variant) {
  constexpr const char* names[] = {"clean", "turned", "float32", "decimals"};
  return names[std::size_t(variant)];
}

Natural placed(Natural natural, Variant variant, Random& random) {
  if (variant == Variant::clean) return natural;
  const dmat3 rotation = random_rotation(random);
  const dvec3 shift = 5.0 * random_point(random);
  const auto rounded_number = [&](double x) {
    return variant == Variant::float32    ? double(float(x))
           : variant == Variant::decimals ? std::round(1e6 * x) / 1e6
                                          : x;
  };
  const auto place = [&](dvec3 x) {
    x = rotation * x + shift;
    return dvec3(rounded_number(x.x), rounded_number(x.y), rounded_number(x.z));
  };
  const auto place_all = [&](auto& geometry) {
    for (dvec4& p : geometry.points) p = taut::homogeneous(place(taut::euclidean(p)), p.w);
  };
  for (NurbsSurface& surface : natural.shape.surfaces) place_all(surface);
  for (NurbsCurve& curve : natural.shape.curves) place_all(curve);
  for (dvec3& p : natural.shape.points) p = place(p);
  if (natural.cage) {
    for (dvec3& p : natural.cage->points) p = place(p);
  }
  return natural;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"box", box_of},
      {"rounded_box", rounded_box},
      {"chamfered_box", chamfered_box},
      {"plate_with_round_corners", plate_with_round_corners},
      {"filleted_plate", filleted_plate},
      {"cam", cam},
      {"gear", gear},
      {"bracket", bracket},
      {"connecting_rod", connecting_rod},
      {"cylinder", cylinder_of},
      {"cone", cone_of},
      {"frustum", frustum_of},
      {"ball", ball},
      {"torus", ring_torus},
      {"shaft", shaft},
      {"bottle", bottle},
      {"cup", cup},
      {"capsule", capsule},
      {"lens", lens},
      {"wheel", wheel},
      {"bolt_circle", bolt_circle},
      {"bolt", bolt},
      {"spring", spring},
      {"thread", thread},
      {"bent_pipe", bent_pipe},
      {"duct", duct},
      {"wing", wing},
      {"blade", twisted_blade},
      {"propeller", propeller},
      {"ship", ship},
      {"fuselage", fuselage},
      {"terrain", terrain},
      {"roof", roof},
      {"dome", dome_of},
      {"mirrored_domes", mirrored_domes},
      {"domes_in_a_row", domes_in_a_row},
      {"car_body", car_body},
      {"freeform_body", freeform_body},
      {"ellipsoid", ellipsoid_of},
      {"box_on_cylinder", box_on_cylinder},
      {"overlapping_balls", overlapping_balls},
      {"balls_in_a_row", balls_in_a_row},
      {"walls_of_nearly_one_radius", walls_of_nearly_one_radius},
      {"copies_all_but_in_place", copies_all_but_in_place},
      {"copies_turned_a_little", copies_turned_a_little},
      {"ball_of_two_seams", ball_of_two_seams},
      {"overlapping_walls", overlapping_walls},
      {"cut_by_edges", cut_by_edges},
      {"plate_of_bosses", plate_of_bosses},
      {"two_circles", two_circles},
      {"wires", wires},
      {"points_in_a_ball", points_in_a_ball},
      {"grid_of_points", grid_of_points},
      {"smooth_cage", smooth_cage},
      {"loop_cage", loop_cage},
      {"ring_cage", ring_cage},
      {"creased_cage", creased_cage},
      {"open_cage", open_cage},
      {"profile_cage", profile_cage},
  };
  return all;
}

}  // namespace taut_test
