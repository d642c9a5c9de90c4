#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "models.h"
#include "reference.h"

namespace taut_test {

/// A shape whose convex hull is known by a formula.
struct Truth {
  std::string name;
  Shape shape;
  real volume = 0;
  /// Negative where it is unknown.
  real area = -1;
  /// What volume and area may be off by where they are no closed forms.
  real uncertainty = 0;
  /// Its mesh stays small at a tolerance of 1e-5 of the diagonal.
  bool fine = false;
};

/// For messages of GoogleTest.
inline void PrintTo(const Truth& truth, std::ostream* stream) { *stream << truth.name; }

/// Of letters and digits, for names of GoogleTest.
std::string test_name(const Truth& truth);

/// All of them, with their closed forms evaluated in `real`.
std::vector<Truth> truths();

}  // namespace taut_test
