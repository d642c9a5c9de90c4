#include "taut/hull/contact/hermite_polynomial.h"

#include <gtest/gtest.h>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: random numbers

using State = HermitePolynomial::State;

/// Polynomials of the fourth degree, one for each entry.
struct Quartics {
  std::array<State, 5> factor;

  State value(double r) const {
    State sum{};
    for (std::size_t k = 5; k-- > 0;) {
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = sum[c] * r + factor[k][c];
    }
    return sum;
  }
  State slope(double r) const {
    State sum{};
    for (std::size_t k = 5; k-- > 1;) {
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = sum[c] * r + double(k) * factor[k][c];
    }
    return sum;
  }
};

/// Five conditions, values and slopes in any order, tell a quartic.
TEST(HermitePolynomial, IsTheOneThatHasTheValues) {
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    Quartics truth{};
    for (State& s : truth.factor) {
      for (double& x : s) x = uniform(random, -1, 1);
    }
    HermitePolynomial polynomial;
    polynomial.add(1, truth.value(1), truth.slope(1));
    polynomial.add(0, truth.value(0));
    polynomial.add(0.5, truth.value(0.5), truth.slope(0.5));
    for (const double r : {0.0, 0.3, 0.5, 1.0, 1.1}) {
      for (std::size_t c = 0; c < truth.factor[0].size(); ++c) {
        EXPECT_NEAR(polynomial.value(r)[c], truth.value(r)[c], 1e-13) << r;
        EXPECT_NEAR(polynomial.slope(r)[c], truth.slope(r)[c], 1e-13) << r;
      }
    }
  }
}

}  // namespace
}  // namespace taut
