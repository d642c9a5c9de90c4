#include <cmath>

#include "families.h"
#include "freeform.h"
#include "patterns.h"
#include "sweeps.h"

namespace taut_test {
namespace {

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
  return {of({quad({0, 0, 0}, {a, 0, h}, {a, b, 0}, {0, b, h})}), {a * b * h / 3, {0, 0, 4, 6}}};
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
  return {ellipsoid(a, b, c), {4 * pi / 3 * a * b * c, {1, 0, 0, 0}}};
}

}  // namespace

std::vector<Family> sheets() {
  return {
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
  };
}

}  // namespace taut_test
