#include "patterns.h"

#include <cmath>

namespace taut_test {

double cube(double x) { return x * x * x; }
double square(double x) { return x * x; }

dvec3 on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

std::vector<dvec3> ring(int count, const std::function<double(int)>& radius, double z) {
  std::vector<dvec3> points;
  for (int k = 0; k < count; ++k) points.push_back(on_circle(radius(k), 2 * pi * k / count, z));
  return points;
}

dmat3 turn_about_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

Shape with_mirror(const Shape& shape, const dmat3& mirror) { return shape + mapped(shape, mirror); }

Shape patterned(const Shape& shape, int count) {
  Shape result;
  for (int k = 0; k < count; ++k) result = result + mapped(shape, turn_about_z(2 * pi * k / count));
  return result;
}

}  // namespace taut_test
