#pragma once

#include <algorithm>
#include <cmath>

#include "taut/bounds/scalar_net.h"

namespace taut {

/// max over d in [lower, upper] of slope d + curvature d^2 / 2.
inline double quadratic_max(double slope, double curvature, double lower, double upper) {
  const auto value = [&](double d) { return d * (slope + 0.5 * curvature * d); };
  if (curvature < 0) return value(std::clamp(-slope / curvature, lower, upper));
  return std::max(value(lower), value(upper));
}

/// What a second-order bound says about a cell: no value exceeds `bound`; `along_u` and `along_v`
/// are the two directions' shares.
struct SecondOrderBound {
  double bound;
  double along_u;
  double along_v;
};

/// Curvatures along u and v with a part each of the mixed one: for all (du, dv)
///     uu_max du^2 + 2 uv_abs |du dv| + vv_max dv^2 <= u du^2 + v dv^2,
/// by 2 |du dv| <= r du^2 + dv^2 / r. Where both curvatures are negative, r = sqrt(uu_max / vv_max)
/// keeps them so exactly if uv_abs^2 < uu_max vv_max; where one is, the largest r that keeps it so
/// leaves the other the least.
struct SharedCurvature {
  double u, v;  ///< of the two directions
  /// Upper bound of the two directions' shares over the unit square where slopes vanish.
  double loss() const { return 0.5 * (std::max(u, 0.0) + std::max(v, 0.0)); }
};

inline SharedCurvature shared_curvature(const NetCurvature& c) {
  double r = 1;
  if (c.uv_abs > 0) {
    if (c.uu_max < 0 && c.vv_max < 0) {
      r = std::sqrt(c.uu_max / c.vv_max);
    } else if (c.uu_max < 0) {
      r = -c.uu_max / c.uv_abs;
    } else if (c.vv_max < 0) {
      r = -c.uv_abs / c.vv_max;
    }
  }
  return {c.uu_max + c.uv_abs * r, c.vv_max + c.uv_abs / r};
}

/// Taylor's bound about (u, v) over the unit square:
///     g(x) <= g + gu du + gv dv + (uu_max du^2 + 2 uv_abs |du dv| + vv_max dv^2) / 2,
/// with the mixed term shared out, so that the two directions separate and each is maximised
/// exactly.
inline SecondOrderBound second_order_bound(const NetJet& jet, const NetCurvature& c, double u,
                                           double v) {
  const SharedCurvature shared = shared_curvature(c);
  const double along_u = quadratic_max(jet.gu, shared.u, -u, 1 - u);
  const double along_v = quadratic_max(jet.gv, shared.v, -v, 1 - v);
  return {jet.g + along_u + along_v, along_u, along_v};
}

/// A cell is split where its curvature exceeds the other direction's by more than this.
inline constexpr double compactness = 16;

/// Whether a cell of that size on which the bound fails is split along u: where the bound loses
/// most, but cells are kept compact, in the measure of their curvature, since bounds of second
/// derivatives loosen with both sizes.
inline bool splits_along_u(const NetCurvature& c, const SecondOrderBound& b, double size_u,
                           double size_v) {
  const double uu = std::max(std::abs(c.uu_min), std::abs(c.uu_max)) + c.uv_abs;
  const double vv = std::max(std::abs(c.vv_min), std::abs(c.vv_max)) + c.uv_abs;
  if (uu > compactness * vv || vv > compactness * uu) return uu > vv;
  if (b.along_u != b.along_v) return b.along_u > b.along_v;
  return size_u >= size_v;
}

/// Newton's step for the maximum of g over the unit square, with coordinates that press against a
/// side kept there. Where g is not concave in both free directions, they are stepped along one
/// after the other, to an end where g is convex. Returns the gain that the second-order model
/// predicts.
inline double newton_step(const NetJet& j, double& u, double& v) {
  const auto pressed = [](double x, double slope) {
    return (x <= 0 && slope <= 0) || (x >= 1 && slope >= 0);
  };
  const auto along = [](double x, double slope, double curvature) {
    if (curvature < 0) return std::clamp(x - slope / curvature, 0.0, 1.0) - x;
    const auto gain = [&](double d) { return d * (slope + 0.5 * curvature * d); };
    const double up = gain(1 - x);
    const double down = gain(-x);
    return std::max(up, down) <= 0 ? 0.0 : up >= down ? 1 - x : -x;
  };
  const bool free_u = !pressed(u, j.gu);
  const bool free_v = !pressed(v, j.gv);
  const double det = j.guu * j.gvv - j.guv * j.guv;
  double du = 0;
  double dv = 0;
  if (free_u && free_v && j.guu < 0 && det > 0) {
    du = (j.guv * j.gv - j.gvv * j.gu) / det;
    dv = (j.guv * j.gu - j.guu * j.gv) / det;
    if (u + du < 0 || u + du > 1) {
      du = std::clamp(u + du, 0.0, 1.0) - u;
      dv = along(v, j.gv + j.guv * du, j.gvv);
    } else if (v + dv < 0 || v + dv > 1) {
      dv = std::clamp(v + dv, 0.0, 1.0) - v;
      du = along(u, j.gu + j.guv * dv, j.guu);
    }
  } else if (j.guu <= j.gvv) {
    if (free_u) du = along(u, j.gu, j.guu);
    if (free_v) dv = along(v, j.gv + j.guv * du, j.gvv);
  } else {
    if (free_v) dv = along(v, j.gv, j.gvv);
    if (free_u) du = along(u, j.gu + j.guv * dv, j.guu);
  }
  u = std::clamp(u + du, 0.0, 1.0);
  v = std::clamp(v + dv, 0.0, 1.0);
  return j.gu * du + j.gv * dv + 0.5 * (j.guu * du * du + 2 * j.guv * du * dv + j.gvv * dv * dv);
}

}  // namespace taut
