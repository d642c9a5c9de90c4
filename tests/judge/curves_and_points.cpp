#include <cmath>

#include "families.h"
#include "patterns.h"
#include "sweeps.h"

namespace taut_test {
namespace {

Natural two_circles(Random& random) {
  const double R = uniform(random, 10, 25), r = uniform(random, 5, 25), h = uniform(random, 10, 20);
  const Shape shape = {
      {}, {circle(dvec3(0.0), {R, 0, 0}, {0, R, 0}), circle({0, 0, h}, {r, 0, 0}, {0, r, 0})}, {}};
  return {shape, {pi * h * (R * R + R * r + r * r) / 3, {0, 1, 2, 2}}};
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
  return {shape, {24 * cube(step), {0, 0, 6, 12}}};
}

}  // namespace

std::vector<Family> curves_and_points() {
  return {
      {"two_circles", two_circles},
      {"wires", wires},
      {"points_in_a_ball", points_in_a_ball},
      {"grid_of_points", grid_of_points},
  };
}

}  // namespace taut_test
