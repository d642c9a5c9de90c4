#include "taut/hull/decide/direction_cube.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/decide/direction_map.h"

namespace taut {
namespace {

const dmat3& cube_frame() {
  static const dmat3 frame = [] {
    const dvec3 a = unit(dvec3(0.8147236863931789, 0.4057919370756193, 0.3269868162937285));
    const auto [b, c] = tangent_frame(a);
    const double turn = 0.7345102;
    return dmat3(std::cos(turn) * b + std::sin(turn) * c, std::cos(turn) * c - std::sin(turn) * b,
                 a);
  }();
  return frame;
}

}  // namespace

FaceAxes face_axes(int face) {
  const int own = face / 2;
  const dmat3& e = cube_frame();
  return {face % 2 == 0 ? e[own] : -e[own], e[(own + 1) % 3], e[(own + 2) % 3]};
}

std::array<long long, 3> place_on_cube(const dvec3& d) {
  const dvec3 x = glm::transpose(cube_frame()) * d;
  const double height = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  // Corners are multiples of 2^-29, and rounding is less than 2^-50.
  const auto rounded = [&](double a) { return std::llround(std::ldexp(a / height, 40)); };
  return {rounded(x.x), rounded(x.y), rounded(x.z)};
}

dvec3 DirectionMap::direction(int face, double s, double t) {
  const FaceAxes axes = face_axes(face);
  return axes.own + s * axes.first + t * axes.second;
}

DirectionMap::Place DirectionMap::place(const dvec3& d) {
  Place place;
  double highest = 0;
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = face_axes(face);
    const double height = glm::dot(d, axes.own);
    if (!(height > highest)) continue;
    highest = height;
    place = {face, glm::dot(d, axes.first) / height, glm::dot(d, axes.second) / height};
  }
  return place;
}

std::array<dvec3, 4> DirectionMap::corners(const MapCell& cell) {
  const double size = std::ldexp(2.0, -cell.level);
  std::array<dvec3, 4> result;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t i = cell.i + k / 2;
    const std::uint32_t j = cell.j + k % 2;
    result[k] = direction(cell.face, -1 + size * i, -1 + size * j);
  }
  return result;
}

}  // namespace taut
