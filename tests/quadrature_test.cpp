#include "taut/hull/measure/quadrature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/core/integers.h"

namespace taut {
namespace {

/// With n nodes integrals of polynomials are exact to degree 2 n - 1, and no further.
template <int n>
void expect_gauss_rule() {
  const GaussRule<n>& rule = GaussRule<n>::get();
  for (int degree = 0; degree < 2 * n; ++degree) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(rule.node[i], degree);
    EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-15) << degree;
  }
  for (std::size_t i = 0; i + 1 < n; ++i) EXPECT_LT(rule.node[i], rule.node[i + 1]);
  // Of Legendre's polynomials each has one coefficient.
  for (int degree = 0; degree < n; ++degree) {
    for (int k = 0; k < rule.watched; ++k) {
      double coefficient = 0;
      for (std::size_t i = 0; i < n; ++i) {
        coefficient += rule.highest[to_size(k)][i] *
                       std::legendre(static_cast<unsigned>(degree), 2 * rule.node[i] - 1);
      }
      EXPECT_NEAR(coefficient, degree == n - rule.watched + k ? 1 : 0, 1e-13);
    }
  }
}

TEST(Quadrature, RulesAreExactForPolynomials) {
  expect_gauss_rule<4>();
  expect_gauss_rule<5>();
  expect_gauss_rule<12>();
  expect_gauss_rule<20>();
}

/// Sums of integrals over [a, b], with the number of samples that they took.
template <std::size_t count, class Function>
Integrals<count> integrated(const Function& f, double share, double a, double b, int& samples) {
  Integrals<count> sum;
  samples = 0;
  const auto counted = [&](double x, double /*weight*/, std::array<double, count>& sample) {
    ++samples;
    sample = f(x);
  };
  const auto tolerance = [&](std::array<double, count> magnitude) {
    for (double& m : magnitude) m *= share;
    return magnitude;
  };
  integrate<10>(counted, tolerance, a, b, sum);
  return sum;
}

/// The estimates are no less than the errors, and hold what was asked for.
TEST(Quadrature, ErrorsAreEstimated) {
  for (const double share : {1e-6, 1e-9, 1e-12}) {
    int samples = 0;
    const auto f = [](double x) {
      return std::array{std::exp(x), 1 / (1 + 25 * x * x), std::cos(20 * x)};
    };
    const auto sum = integrated<3>(f, share, -1, 2, samples);
    const std::array truth = {std::exp(2.0) - std::exp(-1.0),
                              (std::atan(10.0) + std::atan(5.0)) / 5,
                              (std::sin(40.0) + std::sin(20.0)) / 20};
    EXPECT_GT(samples, 10);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(double(sum.value[c]), truth[c], sum.error[c] + 1e-14);
      EXPECT_LE(sum.error[c], 1000 * share);
      EXPECT_NEAR(double(sum.value[c]), truth[c], 10 * share + 1e-14);
    }
  }
}

TEST(Quadrature, SmoothFunctionsTakeNoHalving) {
  int samples = 0;
  const auto cubic = [](double x) { return std::array{x * x * x - x}; };
  EXPECT_NEAR(double(integrated<1>(cubic, 1e-12, 1, 3, samples).value[0]), 16, 1e-13);
  EXPECT_EQ(samples, 10);
  // Backwards it has the other sign, and as many samples.
  EXPECT_NEAR(double(integrated<1>(cubic, 1e-12, 3, 1, samples).value[0]), -16, 1e-13);
  EXPECT_EQ(samples, 10);
}

/// Halving ends at a thirty-second of the interval; the error there is told, if not proven.
TEST(Quadrature, SingularitiesEnd) {
  int samples = 0;
  double nearest = 1;
  const auto root = [&](double x) {
    nearest = std::min(nearest, x);
    return std::array{std::sqrt(x)};
  };
  const Integrals<1> sum = integrated<1>(root, 1e-14, 0, 1, samples);
  EXPECT_DOUBLE_EQ(nearest, GaussRule<10>::get().node[0] / 32);
  EXPECT_NEAR(double(sum.value[0]), 2.0 / 3, 1e-6);
  EXPECT_GE(2 * sum.error[0], std::abs(double(sum.value[0]) - 2.0 / 3));
}

/// Weights are those with which samples count; sums are added with a factor.
TEST(Quadrature, WeightsAndSumsAdd) {
  double weighed = 0;
  Integrals<2> sum;
  const auto f = [&](double x, double weight, std::array<double, 2>& sample) {
    sample = {x * x, 1};
    weighed += weight * sample[0];
  };
  integrate<6>(
      f, [](const auto& magnitude) { return magnitude; }, 1.0, 4.0, sum);
  EXPECT_NEAR(weighed, 21, 1e-13);
  EXPECT_NEAR(double(sum.value[0]), 21, 1e-13);
  Integrals<2> all{{1, 2}, {0.5, 0.25}};
  const double rest = all.error[0] + 2 * sum.error[0];
  all.add(-2, sum);
  EXPECT_NEAR(double(all.value[0]), -41, 1e-12);
  EXPECT_NEAR(double(all.value[1]), -4, 1e-12);
  EXPECT_DOUBLE_EQ(all.error[0], rest);
}

}  // namespace
}  // namespace taut
