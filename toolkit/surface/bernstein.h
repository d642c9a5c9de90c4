#pragma once

#include <cmath>
#include <vector>

namespace taut {

/// n over k, for k from 0 to n.
inline std::vector<double> binomials(int n) {
  std::vector<double> result = {1};
  for (int k = 1; k <= n; ++k) result.push_back(std::round(result.back() * (n - k + 1) / k));
  return result;
}

/// Values, first and second derivatives of the cubic Bernstein polynomials at t, into the rows 0,
/// 1 and 2 of b: a common case, for which recurrences cost several times as much.
template <class Rows>
void cubic_bernstein(double t, Rows& b) {
  const double s = 1 - t;
  b[0][0] = s * s * s;
  b[0][1] = 3 * s * s * t;
  b[0][2] = 3 * s * t * t;
  b[0][3] = t * t * t;
  b[1][0] = -3 * s * s;
  b[1][1] = 3 * s * (s - 2 * t);
  b[1][2] = 3 * t * (2 * s - t);
  b[1][3] = 3 * t * t;
  b[2][0] = 6 * s;
  b[2][1] = 6 * t - 12 * s;
  b[2][2] = 6 * s - 12 * t;
  b[2][3] = 6 * t;
}

}  // namespace taut
