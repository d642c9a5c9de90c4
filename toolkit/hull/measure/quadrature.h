#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace taut {

/// Gauss-Legendre nodes and weights on [0, 1], exact to degree 2 n - 1, with the values that tell a
/// sampled function's Legendre coefficients of the four highest degrees below n.
template <int n>
struct GaussRule {
  static_assert(n >= 4);
  static constexpr int watched = 4;

  std::array<double, n> node{};
  std::array<double, n> weight{};
  /// highest[k][i]: weight of sample i in the coefficient of degree n - watched + k.
  std::array<std::array<double, n>, watched> highest{};

  GaussRule() {
    using Real = long double;
    for (int i = 0; i < n; ++i) {
      // Newton's method from Tricomi's estimate; six steps double the digits to more than any type
      // has.
      Real x = std::cos(std::numbers::pi_v<Real> * (i + Real(0.75)) / (n + Real(0.5)));
      std::array<Real, std::size_t(n) + 1> P{};
      Real slope = 0;
      for (int step = 0; step < 6; ++step) {
        P[0] = 1;
        P[1] = x;
        for (int k = 2; k <= n; ++k) {
          const auto at = std::size_t(k);
          P[at] = ((2 * k - 1) * x * P[at - 1] - (k - 1) * P[at - 2]) / k;
        }
        slope = n * (x * P[n] - P[n - 1]) / (x * x - 1);
        x -= P[n] / slope;
      }
      const auto at = std::size_t(n - 1 - i);
      const Real w = 1 / ((1 - x * x) * slope * slope);
      node[at] = double((1 + x) / 2);
      weight[at] = double(w);
      for (int k = 0; k < watched; ++k) {
        const int degree = n - watched + k;
        highest[std::size_t(k)][at] = double((2 * degree + 1) * w * P[std::size_t(degree)]);
      }
    }
  }

  static const GaussRule& get() {
    static const GaussRule rule;
    return rule;
  }
};

/// Sums of several integrals, with estimates of their absolute errors.
template <std::size_t count>
struct Integrals {
  std::array<long double, count> value{};
  std::array<double, count> error{};

  void add(double factor, const Integrals& other) {
    for (std::size_t c = 0; c < count; ++c) {
      value[c] += factor * other.value[c];
      error[c] += std::abs(factor) * other.error[c];
    }
  }
};

/// By products.
constexpr double whole_power(double x, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2, x *= x) {
    if (exponent % 2 == 1) result *= x;
  }
  return result;
}

/// Halvings beyond 2^-5 of the whole: of integrals that are not nested, so many that singularities
/// narrower than the thinnest of models are resolved. Where they are nested, cost would grow with
/// the square.
constexpr int single_halvings = 64;

/// An interval of integrate() that is halved so often; `before`: how many times its tolerance the
/// error of the one that it is half of was. Takes halvings from those that are left.
template <int n, std::size_t count, class Function, class Tolerance>
void integrate_part(const Function& f, const Tolerance& tolerance, double a, double b,
                    Integrals<count>& sum, int& halvings, int depth, double before) {
  constexpr int usual_depth = 5;
  // An error so many times its tolerance is not noise.
  constexpr double noise_limit = 4096;

  const GaussRule<n>& rule = GaussRule<n>::get();
  std::array<std::array<double, count>, std::size_t(n)> samples{};
  for (std::size_t i = 0; i < std::size_t(n); ++i) {
    f(a + (b - a) * rule.node[i], (b - a) * rule.weight[i], samples[i]);
  }
  std::array<double, count> magnitude{};
  std::array<double, count> error{};
  for (std::size_t c = 0; c < count; ++c) {
    std::array<double, GaussRule<n>::watched> coefficient{};
    for (std::size_t i = 0; i < std::size_t(n); ++i) {
      magnitude[c] += rule.weight[i] * std::abs(samples[i][c]);
      for (std::size_t k = 0; k < coefficient.size(); ++k) {
        coefficient[k] += rule.highest[k][i] * samples[i][c];
      }
    }
    magnitude[c] *= std::abs(b - a);
    const double high = std::max(std::abs(coefficient[3]), std::abs(coefficient[2]));
    const double low = std::max(std::abs(coefficient[1]), std::abs(coefficient[0]));
    const double ratio = high < low ? std::sqrt(high / low) : 1;
    error[c] = std::abs(b - a) * 2 * high * whole_power(ratio, n + 1);
  }
  const std::array<double, count> allowed = tolerance(magnitude);
  double excess = 0;
  for (std::size_t c = 0; c < count; ++c) {
    if (error[c] > excess * allowed[c]) {
      excess = allowed[c] > 0 ? error[c] / allowed[c] : std::numeric_limits<double>::infinity();
    }
  }
  const bool noise = depth >= 1 && excess > before / 2 && excess < noise_limit;
  const bool is_last = depth >= usual_depth && halvings <= 0;
  if (!(excess > 1) || is_last || noise) {
    for (std::size_t c = 0; c < count; ++c) {
      long double total = 0;
      for (std::size_t i = 0; i < std::size_t(n); ++i) {
        total += static_cast<long double>(rule.weight[i]) * samples[i][c];
      }
      sum.value[c] += (b - a) * total;
      sum.error[c] += error[c];
    }
    return;
  }
  if (depth >= usual_depth) --halvings;
  const double middle = 0.5 * a + 0.5 * b;
  integrate_part<n>(f, tolerance, a, middle, sum, halvings, depth + 1, excess);
  integrate_part<n>(f, tolerance, middle, b, sum, halvings, depth + 1, excess);
}

/// Adds the integrals over [a, b] of the components of a vector function to `sum`.
///
/// By Gauss-Legendre rules with n nodes, halving the interval until the error is within tolerance.
/// The error is that of the rule's aliases, the coefficients of degrees from 2 n on, extrapolated
/// geometrically from the four highest ones that the samples determine (null rules: Berntsen and
/// Espelid 1991): exact enough for analytic functions, and no more samples are needed.
///
/// `f(x, weight, sample)` fills the sample; `weight` is what it will count with.
/// `tolerance(magnitude)` gives the absolute tolerances of the components from the rule's sums of
/// their absolute values. Halving ends where it no longer helps: the error is then noise of the
/// samples. A singularity within an interval of 2^-5 of the whole is left at the accuracy reached
/// there, but for so many halvings beyond that in all.
template <int n, std::size_t count, class Function, class Tolerance>
void integrate(const Function& f, const Tolerance& tolerance, double a, double b,
               Integrals<count>& sum, int halvings = 0) {
  integrate_part<n>(f, tolerance, a, b, sum, halvings, 0, std::numeric_limits<double>::infinity());
}

}  // namespace taut
