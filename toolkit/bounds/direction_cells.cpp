#include "taut/bounds/direction_cells.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Cells are met within this share of a cell's face: clipping and projection round some ten times.
constexpr double position_error = 32 * rounding_unit;

struct FaceAxes {
  int own, first, second;
  double sign;
};

FaceAxes axes(int face) {
  const int own = face / 2;
  return {own, (own + 1) % 3, (own + 2) % 3, face % 2 == 0 ? 1.0 : -1.0};
}

/// Every other bit.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

std::uint32_t position(double x, int level) {
  const double cells = std::ldexp(1.0, level);
  return std::uint32_t(std::clamp(std::floor(0.5 * (x + 1) * cells), 0.0, cells - 1));
}

/// What remains of a convex cone of directions on one side of the planes that bound the pyramid
/// over a face of the cube.
class FaceClip {
 public:
  /// Corners in the face's coordinates: first, second, own.
  explicit FaceClip(const std::array<dvec3, 4>& corners) {
    std::copy(corners.begin(), corners.end(), polygon_.begin());
    count_ = 4;
  }

  void clip(const dvec3& side) {
    std::array<dvec3, 12> kept;
    std::size_t n = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const dvec3& a = polygon_[k];
      const dvec3& b = polygon_[(k + 1) % count_];
      const double fa = glm::dot(side, a) + position_error * glm::length(a);
      const double fb = glm::dot(side, b) + position_error * glm::length(b);
      if (fa >= 0) kept[n++] = a;
      if ((fa >= 0) != (fb >= 0)) kept[n++] = (fa * b - fb * a) / (fa - fb);
    }
    polygon_ = kept;
    count_ = n;
  }

  bool empty() const { return count_ == 0; }
  Box box() const {
    Box result;
    for (std::size_t k = 0; k < count_; ++k) {
      const dvec3& p = polygon_[k];
      // Inside the four planes the height is the largest coordinate, apart from rounding.
      const double height = std::max({p.z, std::abs(p.x), std::abs(p.y)});
      result.include(dvec3(p.x / height, p.y / height, 1));
    }
    return result;
  }

 private:
  std::array<dvec3, 12> polygon_;  // each of four planes adds at most one corner
  std::size_t count_ = 0;
};

}  // namespace

DirectionCell DirectionCell::of(const dvec3& n, int level) {
  const dvec3 a = glm::abs(n);
  const int own = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const int face = 2 * own + (n[own] < 0 ? 1 : 0);
  const FaceAxes f = axes(face);
  return {face, level, position(n[f.first] / a[own], level), position(n[f.second] / a[own], level)};
}

std::array<dvec3, 4> DirectionCell::corners() const {
  const FaceAxes f = axes(face);
  const double size = std::ldexp(2.0, -level);
  std::array<dvec3, 4> result;
  for (std::uint32_t k = 0; k < 4; ++k) {
    dvec3& c = result[k];
    c[f.own] = f.sign;
    const std::uint32_t first = i + k / 2;
    const std::uint32_t second = j + k % 2;
    c[f.first] = -1 + size * first;
    c[f.second] = -1 + size * second;
  }
  return result;
}

std::uint32_t DirectionCell::index() const {
  return (std::uint32_t(face) << (2 * level)) + 2 * spread(i) + spread(j);
}

void cells_met(const NormalPyramid& pyramid, bool opposite, int level,
               std::vector<DirectionCell>& cells) {
  const double sign = opposite ? -1 : 1;
  for (int face = 0; face < 6; ++face) {
    const FaceAxes f = axes(face);
    std::array<dvec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
      const dvec3 n = sign * pyramid.corners[k];
      corners[k] = {n[f.first], n[f.second], f.sign * n[f.own]};
    }
    FaceClip clip(corners);
    for (const dvec3& side : {dvec3(1, 0, 1), dvec3(-1, 0, 1), dvec3(0, 1, 1), dvec3(0, -1, 1)}) {
      if (!clip.empty()) clip.clip(side);
    }
    if (clip.empty()) continue;
    const Box box = clip.box();
    const std::uint32_t last_i = position(box.upper.x + position_error, level);
    const std::uint32_t last_j = position(box.upper.y + position_error, level);
    for (std::uint32_t i = position(box.lower.x - position_error, level); i <= last_i; ++i) {
      for (std::uint32_t j = position(box.lower.y - position_error, level); j <= last_j; ++j) {
        cells.push_back({face, level, i, j});
      }
    }
  }
}

}  // namespace taut
