#pragma once

#include <vector>

#include "reference.h"

namespace taut_test {

/// A patch's point and derivatives in long double, from Bernstein sums of the homogeneous points
/// and their differences.
struct ReferenceJet {
  rvec3 S, Su, Sv, Suu, Suv, Svv;

  rvec3 normal() const { return glm::cross(Su, Sv); }
};

inline real bernstein(int n, int i, real t) {
  if (i < 0 || i > n) return 0;
  real value = 1;
  for (int k = 1; k <= i; ++k) value = value * real(n - i + k) / k * t;
  for (int k = 0; k < n - i; ++k) value *= 1 - t;
  return value;
}

/// The k-th derivative, k <= 2.
inline real bernstein_derivative(int n, int i, int k, real t) {
  if (k == 0) return bernstein(n, i, t);
  return n *
         (bernstein_derivative(n - 1, i - 1, k - 1, t) - bernstein_derivative(n - 1, i, k - 1, t));
}

inline ReferenceJet reference_jet(const taut::BezierPatch& patch, real u, real v) {
  const auto sum = [&](int k, int l) {
    rvec4 result(0);
    for (int i = 0; i <= patch.degree_u; ++i) {
      for (int j = 0; j <= patch.degree_v; ++j) {
        result += bernstein_derivative(patch.degree_u, i, k, u) *
                  bernstein_derivative(patch.degree_v, j, l, v) * rvec4(patch.at(i, j));
      }
    }
    return result;
  };
  const rvec4 p = sum(0, 0);
  const rvec4 pu = sum(1, 0);
  const rvec4 pv = sum(0, 1);
  const rvec4 puu = sum(2, 0);
  const rvec4 puv = sum(1, 1);
  const rvec4 pvv = sum(0, 2);
  ReferenceJet j;
  j.S = rvec3(p) / p.w;
  j.Su = (rvec3(pu) - pu.w * j.S) / p.w;
  j.Sv = (rvec3(pv) - pv.w * j.S) / p.w;
  j.Suu = (rvec3(puu) - puu.w * j.S - 2 * pu.w * j.Su) / p.w;
  j.Suv = (rvec3(puv) - puv.w * j.S - pu.w * j.Sv - pv.w * j.Su) / p.w;
  j.Svv = (rvec3(pvv) - pvv.w * j.S - 2 * pv.w * j.Sv) / p.w;
  return j;
}

}  // namespace taut_test
