#include <cmath>

#include "families.h"
#include "patterns.h"
#include "sweeps.h"

namespace taut_test {
namespace {

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
  return {shape, {unknown, {0, 4, 6, 16}}};
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

}  // namespace

std::vector<Family> swept_parts() {
  return {
      {"spring", spring}, {"thread", thread},       {"bent_pipe", bent_pipe}, {"duct", duct},
      {"wing", wing},     {"blade", twisted_blade}, {"propeller", propeller},
  };
}

}  // namespace taut_test
