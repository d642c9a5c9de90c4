#pragma once

#include <limits>
#include <string>

namespace taut_test {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What a hull's boundary is made of. Of what is expected, -1 is unknown.
struct Counts {
  int patches = -1, scrolls = -1, facets = -1, curves = -1;
};

/// "patches/scrolls/facets/curves", with "-" for unknown ones.
std::string text(const Counts& counts);
/// They differ in one that is known.
bool differ(const Counts& found, const Counts& expected);

/// What is known of a model's hull from elsewhere, in the model's units.
struct Expected {
  double volume = unknown;
  Counts counts = {};
  double mean_width = unknown;
  double area = unknown;
  /// Relative differences that measures may have.
  double accuracy = 1e-9;
};

/// "what by 1.2e-05".
std::string off_by(const char* what, double value);

}  // namespace taut_test
