#include "taut/io/obj/trim_sense.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace taut {
namespace {

/// lower + upper - knot, in an order that keeps the ends and what lies within them or beyond.
double mirrored(double knot, const Interval& domain) {
  const auto [lower, upper] = domain;
  // Halves, whose sum cannot overflow where the ends are finite.
  const double image = 2 * (lower / 2 + (upper / 2 - knot / 2));
  if (knot == lower) return upper;
  if (knot == upper) return lower;
  if (knot < lower) return std::max(image, upper);
  if (knot > upper) return std::min(image, lower);
  return std::clamp(image, lower, upper);
}

NurbsCurve reversed(const NurbsCurve& curve) {
  NurbsCurve result = curve;
  std::reverse(result.points.begin(), result.points.end());
  std::reverse(result.knots.begin(), result.knots.end());
  for (double& knot : result.knots) knot = mirrored(knot, curve.domain());
  return result;
}

}  // namespace

bool runs_counter_clockwise(const TrimLoop& loop) {
  constexpr int chords_per_degree = 8;
  Box box;
  std::vector<dvec3> points;
  for (const NurbsCurve& curve : loop.curves) {
    for (const CurvePiece& piece : decompose(curve)) {
      const int chords = chords_per_degree * curve.degree;
      for (int i = 0; i <= chords; ++i) {
        points.push_back(point(piece.bezier, static_cast<double>(i) / chords));
        box.include(points.back());
      }
    }
  }
  // In a frame in which no product over- or underflows.
  const dvec3 center = box.center();
  const double size = diagonal(box);
  if (!(size > 0)) return false;
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec3 a = (points[i] - center) / size;
    const dvec3 b = (points[(i + 1) % points.size()] - center) / size;
    area += a.x * b.y - a.y * b.x;
  }
  return area > 0;
}

TrimLoop reversed(const TrimLoop& loop) {
  TrimLoop result;
  for (auto curve = loop.curves.rbegin(); curve != loop.curves.rend(); ++curve) {
    result.curves.push_back(reversed(*curve));
  }
  return result;
}

}  // namespace taut
