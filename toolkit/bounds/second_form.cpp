#include "taut/bounds/second_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

/// Products of bounds with three or fewer roundings each may lose this share.
constexpr double product_error = 4 * rounding_unit;

double largest_square(const Interval& x) { return std::max(x.lower * x.lower, x.upper * x.upper); }

double smallest_square(const Interval& x) {
  if (x.lower <= 0 && x.upper >= 0) return 0;
  return std::min(x.lower * x.lower, x.upper * x.upper);
}

}  // namespace

bool SecondForm::surely_saddle() const {
  const double product = std::max(
      {uu.lower * vv.lower, uu.lower * vv.upper, uu.upper * vv.lower, uu.upper * vv.upper});
  const double mixed = smallest_square(uv);
  return product + product_error * (std::abs(product) + mixed) < mixed;
}

bool SecondForm::definite() const {
  const double product = std::min(std::abs(uu.lower), std::abs(uu.upper)) *
                         std::min(std::abs(vv.lower), std::abs(vv.upper));
  return largest_square(uv) < product * (1 - product_error);
}

SecondForm second_form(NetShape shape, bool rational, std::span<const dvec4> points,
                       std::span<const dvec4> touching, const std::array<dvec3, 4>& corners,
                       double rounding) {
  // n = c1 + s (c0 - c1) + ...: coefficients are bilinear in two of the corners' differences, so
  // that a product with a vector takes three dot products instead of four.
  const dvec3 base = 0.5 * (corners[0] + corners[2]);
  const dvec3 e1 = 0.5 * (corners[1] - corners[0]);
  const dvec3 e2 = 0.5 * (corners[3] - corners[0]);
  const double length = glm::length(base) + glm::length(e1) + glm::length(e2);

  // At the touching point x, d^2 (w (S - x) . n) = (d^2 P - x d^2 w) . n. The part of x that is
  // unknown is small: that about one of the control points.
  dvec3 center(0.0);
  double offset = 0;
  double size = 0;
  for (const dvec4& p : points) size = std::max(size, glm::length(dvec3(p)));
  if (rational) {
    center = dvec3(touching[touching.size() / 2]) / touching[touching.size() / 2].w;
    for (const dvec4& p : touching) {
      const dvec3 x = dvec3(p) / p.w - center;
      offset = std::max(offset, std::abs(glm::dot(x, base)) + std::abs(glm::dot(x, e1)) +
                                    std::abs(glm::dot(x, e2)));
    }
  }
  // A second difference sums control points with weights 1, 2, 1 (mixed: four of 1), each with its
  // own error, and rounds some eight times.
  const double error = 4 * (rounding + 8 * rounding_unit * size) * length;
  struct Range {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
  };
  Range uu, uv, vv;
  const auto include = [&](Range& range, const dvec4& d) {
    const dvec3 x = dvec3(d) - d.w * center;
    const double middle = glm::dot(x, base);
    const double spread =
        std::abs(glm::dot(x, e1)) + std::abs(glm::dot(x, e2)) + std::abs(d.w) * offset;
    range.lower = std::min(range.lower, middle - spread);
    range.upper = std::max(range.upper, middle + spread);
  };
  const int row = shape.q + 1;
  const auto at = [&](int i, int j) { return points[std::size_t(i * row + j)]; };
  for (int i = 0; i <= shape.p; ++i) {
    for (int j = 0; j <= shape.q; ++j) {
      if (i + 2 <= shape.p) include(uu, at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j));
      if (j + 2 <= shape.q) include(vv, at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2));
      if (i < shape.p && j < shape.q) {
        include(uv, at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j));
      }
    }
  }
  const auto finished = [&](const Range& range, int factor) {
    if (factor == 0) return Interval{0, 0};
    return Interval{factor * (range.lower - error), factor * (range.upper + error)};
  };
  return {finished(uu, shape.p * (shape.p - 1)), finished(uv, shape.p * shape.q),
          finished(vv, shape.q * (shape.q - 1))};
}

}  // namespace taut
