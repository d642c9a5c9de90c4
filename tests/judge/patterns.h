#pragma once

#include <functional>
#include <vector>

#include "models.h"

/// Powers, points on circles about the z axis, mirrors and copies.
namespace taut_test {

double cube(double x);
double square(double x);

dvec3 on_circle(double radius, double angle, double z = 0);
/// So many points in equal angles, each with a radius of its own.
std::vector<dvec3> ring(int count, const std::function<double(int)>& radius, double z = 0);

dmat3 turn_about_z(double angle);
/// z to x, x to y, y to z.
inline const dmat3 z_to_x(0, 1, 0, 0, 0, 1, 1, 0, 0);
inline const dmat3 mirror_y(1, 0, 0, 0, -1, 0, 0, 0, 1);
inline const dmat3 mirror_z(1, 0, 0, 0, 1, 0, 0, 0, -1);

Shape with_mirror(const Shape& shape, const dmat3& mirror);
/// Copies in equal angles about the z axis.
Shape patterned(const Shape& shape, int count);

}  // namespace taut_test
