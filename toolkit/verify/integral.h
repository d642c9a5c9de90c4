#pragma once

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>

namespace taut {

/// Values of several integrals, and estimates of their absolute errors.
template <std::size_t count>
struct IntegralSums {
  std::array<double, count> value{};
  std::array<double, count> error{};

  void add(double weight, const IntegralSums& other) {
    for (std::size_t i = 0; i < count; ++i) {
      value[i] += weight * other.value[i];
      error[i] += std::abs(weight) * other.error[i];
    }
  }
};

/// What integrals are bisected for: the error of each stretch is to be below a share of the largest
/// integral of an |f_i| over it, or below `absolute`.
struct IntegralAccuracy {
  double relative = 0;
  double absolute = 0;
  int bisections = 0;  ///< at most so many of one integral
};

/// Adds integrals as integrate() does, with so many bisections left.
template <std::size_t count, class Function>
void integrate_stretch(const Function& f, double a, double b, const IntegralAccuracy& accuracy,
                       int& bisections_left, IntegralSums<count>& sum) {
  using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
  using Gauss = boost::math::quadrature::gauss<double, 7>;
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  IntegralSums<count> kronrod, gauss, whole;
  const auto add = [&](std::size_t node, double x) {
    const IntegralSums<count> here = f(x);
    const double weight = half * Kronrod::weights()[node];
    kronrod.add(weight, here);
    if (node % 2 == 0) gauss.add(half * Gauss::weights()[node / 2], here);
    for (std::size_t i = 0; i < count; ++i) whole.value[i] += std::abs(weight * here.value[i]);
  };
  add(0, middle);
  for (std::size_t node = 1; node < Kronrod::abscissa().size(); ++node) {
    add(node, middle - half * Kronrod::abscissa()[node]);
    add(node, middle + half * Kronrod::abscissa()[node]);
  }
  const double scale = *std::max_element(whole.value.begin(), whole.value.end());
  if (scale == 0) return;
  double worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = std::abs(kronrod.value[i] - gauss.value[i]) / scale;
    const double error = std::min(share, std::pow(200 * share, 1.5));
    kronrod.error[i] += error * scale;
    worst = std::max(worst, error);
  }
  const bool accurate = worst <= accuracy.relative || worst * scale <= accuracy.absolute;
  if (accurate || bisections_left == 0) {
    sum.add(1, kronrod);
    return;
  }
  --bisections_left;
  integrate_stretch(f, a, middle, accuracy, bisections_left, sum);
  integrate_stretch(f, middle, b, accuracy, bisections_left, sum);
}

/// Adds the integrals from a to b of f(x), which are IntegralSums whose errors count too: by the
/// 15-point Kronrod rule, the error by what the 7-point Gauss rule within it differs.
/// Source: Piessens et al., QUADPACK, 1983, section 3.4; nodes and weights are Boost's.
template <std::size_t count, class Function>
void integrate(const Function& f, double a, double b, const IntegralAccuracy& accuracy,
               IntegralSums<count>& sum) {
  int bisections_left = accuracy.bisections;
  integrate_stretch(f, a, b, accuracy, bisections_left, sum);
}

}  // namespace taut
