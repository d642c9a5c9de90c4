#pragma once

#include <algorithm>
#include <cmath>

#include "taut/core/geometry.h"
#include "taut/core/tolerances.h"
#include "taut/surface/bernstein.h"

namespace taut {

/// Degrees of a tensor-product Bernstein polynomial over [0, 1]^2. Its coefficients stand as those
/// of BezierPatch: v within u.
struct NetShape {
  int p = 0;
  int q = 0;
  int size() const { return (p + 1) * (q + 1); }
};

/// Value and derivatives of such a polynomial at a point.
struct NetJet {
  double g, gu, gv, guu, guv, gvv;
};

/// Bounds of such a polynomial's second derivatives over the unit square.
struct NetCurvature {
  double uu_min, uu_max;  ///< of d^2/du^2
  double vv_min, vv_max;
  double uv_abs;  ///< largest |d^2/(du dv)|
};

/// The operations of the support query on scalar nets, for degrees known when compiling (>= 0) or
/// not (-1). One source for both, which differ by rounding at most.
template <int P, int Q>
class ScalarNet {
 public:
  explicit ScalarNet(NetShape shape) : shape_(shape) {}

  int p() const { return P >= 0 ? P : shape_.p; }
  int q() const { return Q >= 0 ? Q : shape_.q; }
  int size() const { return (p() + 1) * (q() + 1); }

  NetJet jet(const double* b, double u, double v) const {
    double bu[3][capacity(P)];
    double bv[3][capacity(Q)];
    basis(p(), u, bu);
    basis(q(), v, bv);
    NetJet jet{};
    for (int i = 0; i <= p(); ++i, b += q() + 1) {
      double r0 = 0, r1 = 0, r2 = 0;
      for (int j = 0; j <= q(); ++j) {
        r0 += bv[0][j] * b[j];
        r1 += bv[1][j] * b[j];
        r2 += bv[2][j] * b[j];
      }
      jet.g += bu[0][i] * r0;
      jet.gu += bu[1][i] * r0;
      jet.gv += bu[0][i] * r1;
      jet.guu += bu[2][i] * r0;
      jet.guv += bu[1][i] * r1;
      jet.gvv += bu[0][i] * r2;
    }
    return jet;
  }

  double value(const double* b, double u, double v) const {
    double bu[capacity(P)];
    double bv[capacity(Q)];
    bernstein(p(), u, bu);
    bernstein(q(), v, bv);
    double g = 0;
    for (int i = 0; i <= p(); ++i, b += q() + 1) {
      double r = 0;
      for (int j = 0; j <= q(); ++j) r += bv[j] * b[j];
      g += bu[i] * r;
    }
    return g;
  }

  NetCurvature curvature(const double* b) const {
    const int row = q() + 1;
    double uu_min = p() > 1 ? infinity : 0;
    double uu_max = -uu_min;
    for (int i = 0; i + 2 <= p(); ++i) {
      for (int j = 0; j <= q(); ++j) {
        const double* c = b + i * row + j;
        const double second = c[0] - 2 * c[row] + c[2 * row];
        uu_min = std::min(uu_min, second);
        uu_max = std::max(uu_max, second);
      }
    }
    double vv_min = q() > 1 ? infinity : 0;
    double vv_max = -vv_min;
    for (int i = 0; i <= p(); ++i) {
      for (int j = 0; j + 2 <= q(); ++j) {
        const double* c = b + i * row + j;
        const double second = c[0] - 2 * c[1] + c[2];
        vv_min = std::min(vv_min, second);
        vv_max = std::max(vv_max, second);
      }
    }
    double uv = 0;
    for (int i = 0; i < p(); ++i) {
      for (int j = 0; j < q(); ++j) {
        const double* c = b + i * row + j;
        uv = std::max(uv, std::abs((c[row + 1] - c[row]) - (c[1] - c[0])));
      }
    }
    const double uu = p() * (p() - 1);
    const double vv = q() * (q() - 1);
    return {uu * uu_min, uu * uu_max, vv * vv_min, vv * vv_max, p() * q() * uv};
  }

  /// The net over [u0, u1] x [v0, v1], in place.
  void restrict(double* b, double u0, double u1, double v0, double v1) const {
    const int row = q() + 1;
    for (int j = 0; j <= q(); ++j) restrict_line(b + j, p(), row, u0, u1);
    for (int i = 0; i <= p(); ++i) restrict_line(b + i * row, q(), 1, v0, v1);
  }

  /// De Casteljau at one half, along u. `b` becomes the lower half.
  void split_u(double* b, double* upper) const {
    const int row = q() + 1;
    std::copy(b, b + size(), upper);
    for (int r = 1; r <= p(); ++r) {
      for (int i = p(); i >= r; --i) average(b + i * row, b + (i - 1) * row);
      for (int i = 0; i <= p() - r; ++i) average(upper + i * row, upper + (i + 1) * row);
    }
  }

  void split_v(double* b, double* upper) const {
    const int row = q() + 1;
    std::copy(b, b + size(), upper);
    for (int i = 0; i <= p(); ++i, b += row, upper += row) {
      for (int r = 1; r <= q(); ++r) {
        for (int j = q(); j >= r; --j) b[j] = 0.5 * (b[j - 1] + b[j]);
        for (int j = 0; j <= q() - r; ++j) upper[j] = 0.5 * (upper[j] + upper[j + 1]);
      }
    }
  }

 private:
  static constexpr int capacity(int degree) { return (degree >= 0 ? degree : max_degree) + 1; }

  static void restrict_line(double* b, int n, int stride, double lower, double upper) {
    for (int r = 1; r <= n && upper < 1; ++r) {
      for (int i = n; i >= r; --i) {
        b[i * stride] = (1 - upper) * b[(i - 1) * stride] + upper * b[i * stride];
      }
    }
    const double t = lower / upper;
    for (int r = 1; r <= n && t > 0; ++r) {
      for (int i = 0; i <= n - r; ++i) {
        b[i * stride] = (1 - t) * b[i * stride] + t * b[(i + 1) * stride];
      }
    }
  }

  void average(double* to, const double* other) const {
    for (int j = 0; j <= q(); ++j) to[j] = 0.5 * (to[j] + other[j]);
  }

  /// Bernstein values, first and second derivatives of degree n at t. The derivatives are
  /// differences of the bases of degrees n - 1 and n - 2, which the recurrence passes through.
  template <int N>
  static void basis(int n, double t, double (&b)[3][N]) {
    if constexpr (N == 4) {
      cubic_bernstein(t, b);
      return;
    }
    const double s = 1 - t;
    double w[N + 2];  // w[i] holds B_i^r
    w[0] = 1;
    for (int r = 1; r <= n - 2; ++r) raise(w, r, s, t);
    for (int i = 0; i <= n; ++i) {
      const auto low = [&](int k) { return k >= 0 && k <= n - 2 ? w[k] : 0.0; };
      b[2][i] = n > 1 ? n * (n - 1) * (low(i - 2) - 2 * low(i - 1) + low(i)) : 0.0;
    }
    if (n > 1) raise(w, n - 1, s, t);
    for (int i = 0; i <= n; ++i) {
      const auto low = [&](int k) { return k >= 0 && k <= n - 1 ? w[k] : 0.0; };
      b[1][i] = n > 0 ? n * (low(i - 1) - low(i)) : 0.0;
    }
    if (n > 0) raise(w, n, s, t);
    for (int i = 0; i <= n; ++i) b[0][i] = w[i];
  }

  template <int N>
  static void bernstein(int n, double t, double (&b)[N]) {
    b[0] = 1;
    for (int r = 1; r <= n; ++r) raise(b, r, 1 - t, t);
  }

  static void raise(double* w, int r, double s, double t) {
    w[r] = t * w[r - 1];
    for (int i = r - 1; i > 0; --i) w[i] = s * w[i] + t * w[i - 1];
    w[0] *= s;
  }

  NetShape shape_;
};

/// Calls visit with the shape's operations, those of common degrees compiled for them.
template <class Visit>
auto with_scalar_net(NetShape shape, Visit visit) {
  if (shape.p == 3 && shape.q == 3) return visit(ScalarNet<3, 3>(shape));
  if (shape.p == 2 && shape.q == 2) return visit(ScalarNet<2, 2>(shape));
  // Quads of the triangles of Loop's surfaces.
  if (shape.p == 4 && shape.q == 4) return visit(ScalarNet<4, 4>(shape));
  // Patches next to the creases of cages.
  if (shape.p == 3 && shape.q == 6) return visit(ScalarNet<3, 6>(shape));
  if (shape.p == 6 && shape.q == 3) return visit(ScalarNet<6, 3>(shape));
  return visit(ScalarNet<-1, -1>(shape));
}

}  // namespace taut
