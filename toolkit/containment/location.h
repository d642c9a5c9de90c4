#pragma once

#include "taut/core/geometry.h"

namespace taut {

/// Where a point lies with respect to a closed body.
enum class Location {
  inside,   ///< proven to be inside, farther from the boundary than the tolerance
  on,       ///< not proven to be farther from the boundary than the tolerance
  outside,  ///< proven to be outside, farther from the boundary than the tolerance
};

/// Distance of a point from the boundary of a body, negative inside, in model units.
struct SignedDistance {
  /// The distance found: exact up to rounding where the right piece of the boundary was.
  double value = 0;
  /// Proven bounds of the true distance, rounding included: lower <= value <= upper up to rounding.
  double lower = 0;
  double upper = 0;  ///< see lower

  /// Largest amount by which `value` may be off.
  double error_bound() const { return std::max(upper - value, value - lower); }
  /// What the bounds prove of a point that is on the boundary within the tolerance.
  Location location(double tolerance) const {
    if (lower > tolerance) return Location::outside;
    return upper < -tolerance ? Location::inside : Location::on;
  }
};

/// Points within this share of the diagonal of a boundary are on it unless told otherwise.
inline constexpr double default_on_tolerance = 1e-13;

/// Distances are sought until they are certified to this share of the diagonal.
inline constexpr double default_distance_accuracy = 1e-12;

/// What questions took.
struct ContainmentCounts {
  long points = 0;  ///< that were asked for
  /// Points that the exact search had to decide.
  long searched = 0;
  long support_queries = 0;  ///< made for them

  /// Adds all counts.
  ContainmentCounts& operator+=(const ContainmentCounts& other) {
    points += other.points;
    searched += other.searched;
    support_queries += other.support_queries;
    return *this;
  }
};

}  // namespace taut
