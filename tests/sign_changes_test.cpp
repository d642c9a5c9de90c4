#include "taut/hull/contact/sign_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// The polynomial with these roots.
SideFunction with_roots(std::vector<double> roots, double factor) {
  return [roots = std::move(roots), factor](double t) {
    double value = factor;
    for (const double root : roots) value *= t - root;
    return value;
  };
}

void expect_roots(const SideFunction& f, const std::vector<double>& expected) {
  const std::vector<double> found = sign_changes(f);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-12);
}

/// Of random polynomials whose roots are farther apart than samples, some of them outside.
TEST(SignChanges, AreTheRootsOfPolynomials) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> roots;
    std::vector<double> inside;
    double next = uniform(random, -0.4, 0.2);
    while (next < 1.4) {
      roots.push_back(next);
      if (next > 0 && next < 1) inside.push_back(next);
      next += uniform(random, 0.04, 0.5);
    }
    expect_roots(with_roots(roots, k % 2 == 0 ? 1 : -3), inside);
  }
}

/// Two roots between two samples, also in the first and the last interval, in dips of either sign.
TEST(SignChanges, TwoInADip) {
  Random random(2);
  for (int k = 0; k < 200; ++k) {
    const int interval = k % 8 == 0 ? 0 : k % 8 == 1 ? 63 : pick(random, 0, 63);
    const double middle = (interval + uniform(random, 0.1, 0.4)) / 64;
    const double half = log_uniform(random, 1e-5, 1e-3);
    const double outer = interval < 32 ? 0.75 : 0.25;
    const double factor = k % 2 == 0 ? 1 : -2;
    const SideFunction f = with_roots({middle - half, middle + half, outer}, factor);
    std::vector<double> expected = {middle - half, middle + half, outer};
    std::sort(expected.begin(), expected.end());
    expect_roots(f, expected);
  }
}

/// Zeros of even order, and dips that end above zero.
TEST(SignChanges, NoneWhereTheFunctionTouchesZero) {
  Random random(3);
  for (int k = 0; k < 50; ++k) {
    const double at = uniform(random, 0, 1);
    expect_roots([&](double t) { return (t - at) * (t - at); }, {});
    expect_roots([&](double t) { return -(t - at) * (t - at) - 1e-12; }, {});
    expect_roots([&](double t) { return std::pow(t - at, 4) + 1e-7; }, {});
  }
}

TEST(SignChanges, WhatVanishes) {
  for (const double size : {0.0, 1e-12, 0.9e-9}) {
    EXPECT_TRUE(vanishes([&](double t) { return size * std::sin(9 * t); })) << size;
  }
  for (const double size : {1.1e-9, 1.0}) {
    EXPECT_FALSE(vanishes([&](double t) { return -size * t; })) << size;
    EXPECT_FALSE(vanishes([&](double t) { return size * (1 - t); })) << size;
  }
  // A bump that is as wide as the samples are apart.
  EXPECT_FALSE(vanishes([](double t) { return std::max(0.0, 1.0 / 128 - std::abs(t - 0.41)); }));
}

/// Each step halves what is known of the root.
TEST(SignChanges, BisectionHalves) {
  const double root = std::sqrt(0.5);
  for (const double sign : {1.0, -1.0}) {
    const SideFunction f = [&](double t) { return sign * (t * t - 0.5); };
    for (int steps = 0; steps < 40; ++steps) {
      EXPECT_LE(std::abs(bisected(f, 0.5, 1, steps) - root), std::ldexp(0.25, -steps) + 1e-15);
      EXPECT_GT(std::abs(bisected(f, 0.5, 1, steps) - root), std::ldexp(1e-4, -steps));
    }
    EXPECT_NEAR(bisected(f, 0.5, 1), root, 1e-15);
    EXPECT_NEAR(bisected(f, 1, 0.5), root, 1e-15);
  }
}

TEST(SignChanges, RootsAtTheEnds) {
  for (const double off : {0.0, 1e-12, -1e-12}) {
    EXPECT_TRUE(is_within(off));
    EXPECT_TRUE(is_within(1 + off));
    EXPECT_EQ(placed(off), 0);
    EXPECT_EQ(placed(1 + off), 1);
  }
  EXPECT_FALSE(is_within(-1e-10));
  EXPECT_FALSE(is_within(1 + 1e-10));
  for (const double inside : {1e-10, 0.3, 1 - 1e-10}) {
    EXPECT_TRUE(is_within(inside));
    EXPECT_EQ(placed(inside), inside);
  }
}

}  // namespace
}  // namespace taut
