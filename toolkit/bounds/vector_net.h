#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "taut/bounds/scalar_net.h"
#include "taut/core/geometry.h"
#include "taut/surface/bezier.h"

namespace taut {

/// De Casteljau at one half, along u, of a tensor-product Bernstein net of vectors (v within u as
/// in BezierPatch). `b` becomes the upper half.
template <class Vector>
void halve_u(NetShape shape, Vector* b, Vector* lower) {
  const int row = shape.q + 1;
  std::copy(b, b + row, lower);
  for (int r = 1; r <= shape.p; ++r) {
    for (int k = 0; k < (shape.p - r + 1) * row; ++k) b[k] = 0.5 * (b[k] + b[k + row]);
    std::copy(b, b + row, lower + r * row);
  }
}

/// Halves a net along v.
template <class Vector>
void halve_v(NetShape shape, Vector* b, Vector* lower) {
  const int row = shape.q + 1;
  for (int i = 0; i <= shape.p; ++i, b += row, lower += row) {
    lower[0] = b[0];
    for (int r = 1; r <= shape.q; ++r) {
      for (int j = 0; j <= shape.q - r; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
      lower[r] = b[0];
    }
  }
}

/// The nets of the four quarters, in the order (u0,v0), (u0,v1), (u1,v0), (u1,v1).
template <class Vector>
void quarter(NetShape shape, const Vector* b, const std::array<Vector*, 4>& quarters) {
  std::copy(b, b + shape.size(), quarters[3]);
  halve_u(shape, quarters[3], quarters[1]);
  halve_v(shape, quarters[1], quarters[0]);
  halve_v(shape, quarters[3], quarters[2]);
}

/// The net over a rectangle within the unit square, in place.
template <class Vector>
void restrict_net(NetShape shape, Vector* b, const Interval& u, const Interval& v) {
  const auto line = [](Vector* c, int n, int stride, const Interval& t) {
    for (int r = 1; r <= n && t.upper < 1; ++r) {
      for (int i = n; i >= r; --i) {
        c[i * stride] = (1 - t.upper) * c[(i - 1) * stride] + t.upper * c[i * stride];
      }
    }
    const double s = t.lower / t.upper;
    for (int r = 1; r <= n && s > 0; ++r) {
      for (int i = 0; i <= n - r; ++i) {
        c[i * stride] = (1 - s) * c[i * stride] + s * c[(i + 1) * stride];
      }
    }
  };
  const int row = shape.q + 1;
  for (int j = 0; j <= shape.q; ++j) line(b + j, shape.p, row, u);
  for (int i = 0; i <= shape.p; ++i) line(b + i * row, shape.q, 1, v);
}

/// The derivative of a net with respect to u or v, as a net of the same degrees.
template <class Vector>
std::vector<Vector> derived(NetShape shape, const std::vector<Vector>& net, Direction along) {
  const int row = shape.q + 1;
  const bool of_u = along == Direction::u;
  const int degree = of_u ? shape.p : shape.q;
  const int step = of_u ? row : 1;
  std::vector<Vector> result(net.size(), Vector(0.0));
  for (int k = 0; k < shape.size(); ++k) {
    const int i = of_u ? k / row : k % row;
    const Vector& own = net[std::size_t(k)];
    Vector& to = result[std::size_t(k)];
    if (i > 0) to += double(i) * (own - net[std::size_t(k - step)]);
    if (i < degree) to += double(degree - i) * (net[std::size_t(k + step)] - own);
  }
  return result;
}

}  // namespace taut
