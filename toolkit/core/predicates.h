#pragma once

#include <algorithm>
#include <cmath>

#include "taut/core/geometry.h"

namespace taut {

enum class Sign : signed char { negative = -1, zero = 0, positive = 1 };

constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }

/// On which side of the oriented plane a, b, c the point d lies: the sign of det[b-a, c-a, d-a].
///
/// Positive iff d lies on the side to which (b-a) x (c-a) points, that is, iff a, b, c run
/// counter-clockwise seen from d. Zero iff all four lie in one plane, as they do if two coincide or
/// three are collinear.
///
/// Exact for all finite doubles, from the smallest subnormal to the largest. Hence antisymmetric:
/// swapping two points turns the sign, an even permutation keeps it.
/// @pre every coordinate is finite; floating point rounds to nearest, even on ties
Sign orientation(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);

/// The sense in which a, b, c run: the sign of det[b-a, c-a]. Positive iff counter-clockwise, zero
/// iff collinear. Exact as above, with the same @pre.
Sign orientation(const dvec2& a, const dvec2& b, const dvec2& c);

/// True iff a, b, c lie on one line, as they do if two coincide. Exact, with the same @pre.
bool collinear(const dvec3& a, const dvec3& b, const dvec3& c);

/// On which side of one plane many points lie: orientation(a, b, c, p), with all that does not
/// depend on p computed once, so that nearly every answer is a dot product and a comparison.
///
/// side() is exact for every finite p. The extent decides only how it is found: a tight one lets
/// the dot product settle more points, and points beyond it cost a full orientation test. If a, b,
/// c are collinear, every side is zero.
class PlaneSide {
 public:
  /// The extent is the largest |p - a|, per coordinate, of the points to be asked, the differences
  /// as computed in double. @pre a, b, c are finite; the extent is not negative
  PlaneSide(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& extent);

  /// Exactly orientation(a, b, c, p). @pre p is finite
  Sign side(const dvec3& p) const {
    const dvec3 d = p - a_;
    const double value = height(d);
    if (within_extent(d)) {
      if (value > bound_) return Sign::positive;
      if (value < -bound_) return Sign::negative;
    }
    return orientation(a_, b_, c_, p);
  }

  /// det[b-a, c-a, p-a], that is, the distance of p above the plane times |(b-a) x (c-a)|, with an
  /// error of at most determinant_bound(). @pre |p - a| <= extent, per coordinate
  double determinant(const dvec3& p) const { return height(p - a_); }

  /// Infinite if the determinant may overflow; it is then meaningless.
  double determinant_bound() const { return bound_; }

  /// (b-a) x (c-a), rounded.
  const dvec3& normal() const { return normal_; }

 private:
  double height(const dvec3& d) const {
    return (normal_.x * d.x + normal_.y * d.y) + normal_.z * d.z;
  }
  /// As a maximum, since three conditions would be three branches.
  bool within_extent(const dvec3& d) const {
    return std::max({std::abs(d.x) - extent_.x, std::abs(d.y) - extent_.y,
                     std::abs(d.z) - extent_.z}) <= 0;
  }

  dvec3 a_;
  dvec3 normal_;
  dvec3 extent_;
  double bound_;
  dvec3 b_;
  dvec3 c_;
};

/// The arithmetic that settles a test, cheapest first (see predicates.cpp).
enum class PredicateStage { floating_point, double_double, integer };

/// Which stage settles orientation() of these points; for tests and benchmarks.
PredicateStage orientation_stage(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
PredicateStage orientation_stage(const dvec2& a, const dvec2& b, const dvec2& c);

}  // namespace taut
