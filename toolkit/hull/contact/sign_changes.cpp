#include "taut/hull/contact/sign_changes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace taut {
namespace {

/// Intervals whose ends are compared by sign.
constexpr int samples_along = 64;
/// Steps of a ternary search for a change of sign.
constexpr int dip_limit = 40;
/// What stays below this everywhere vanishes.
constexpr double least_extent = 1e-9;
/// How far rounding may move a root off the end at which it is.
constexpr double root_slack = 1e-11;

double sample(int k) { return double(k) / samples_along; }

/// Where a function of one sign at both ends and about a dip between them has the other one, if
/// ternary search finds that.
std::optional<double> across_dip(const SideFunction& f, double a, double b) {
  const double first = f(a);
  for (int i = 0; i < dip_limit; ++i) {
    const double s = a + (b - a) / 3;
    const double t = b - (b - a) / 3;
    const double at_s = f(s);
    const double at_t = f(t);
    if ((at_s < 0) != (first < 0)) return s;
    if ((at_t < 0) != (first < 0)) return t;
    (std::abs(at_s) < std::abs(at_t) ? b : a) = std::abs(at_s) < std::abs(at_t) ? t : s;
  }
  return std::nullopt;
}

}  // namespace

bool vanishes(const SideFunction& f) {
  double extent = 0;
  for (int k = 0; k <= samples_along; ++k) extent = std::max(extent, std::abs(f(sample(k))));
  return !(extent > least_extent);
}

std::vector<double> sign_changes(const SideFunction& f) {
  std::vector<double> values(samples_along + 1);
  for (int k = 0; k <= samples_along; ++k) values[std::size_t(k)] = f(sample(k));
  const auto value = [&](int k) { return values[std::size_t(std::clamp(k, 0, samples_along))]; };
  const auto changes = [&](int k) { return (value(k) < 0) != (value(k + 1) < 0); };
  std::vector<double> roots;
  for (int k = 0; k <= samples_along; ++k) {
    if (changes(k)) roots.push_back(bisected(f, sample(k), sample(k + 1)));
    if (changes(k - 1) || changes(k) || std::abs(value(k - 1)) < std::abs(value(k)) ||
        std::abs(value(k + 1)) < std::abs(value(k))) {
      continue;
    }
    const double a = sample(std::max(k - 1, 0));
    const double b = sample(std::min(k + 1, samples_along));
    if (const std::optional<double> across = across_dip(f, a, b)) {
      roots.push_back(bisected(f, a, *across));
      roots.push_back(bisected(f, *across, b));
    }
  }
  return roots;
}

double bisected(const SideFunction& f, double a, double b, int steps) {
  const bool negative = f(a) < 0;
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (a + b);
    ((f(middle) < 0) == negative ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

bool is_within(double root) { return root >= -root_slack && root <= 1 + root_slack; }

double placed(double root) {
  if (root < root_slack) return 0;
  return root > 1 - root_slack ? 1 : root;
}

}  // namespace taut
