#pragma once

#include <span>

#include "taut/bounds/scalar_net.h"
#include "taut/core/geometry.h"

namespace taut {

/// Bounds of the second derivatives Suu . n, Suv . n, Svv . n (times the weight, where rational)
/// over a rectangle of a patch and all n of a pyramid whose planes touch it.
struct SecondForm {
  Interval uu, uv, vv;

  /// Certain: negative or positive definite everywhere.
  bool surely_negative() const { return uu.upper < 0 && vv.upper < 0 && definite(); }
  bool surely_positive() const { return uu.lower > 0 && vv.lower > 0 && definite(); }
  /// False is certain: nowhere negative or positive semidefinite.
  bool may_be_negative() const { return uu.lower <= 0 && vv.lower <= 0 && !surely_saddle(); }
  bool may_be_positive() const { return uu.upper >= 0 && vv.upper >= 0 && !surely_saddle(); }
  /// Certain: the determinant is negative everywhere.
  bool surely_saddle() const;

 private:
  bool definite() const;
};

/// From the control points of the rectangle (homogeneous, v within u): a polynomial of second
/// derivatives lies between its coefficients, and each is linear in n, so the corners decide.
///
/// `touching`: control points of a rectangle (often the same one) that holds every point at which a
/// plane with a normal from the pyramid touches. At such a point x the second derivatives of
/// w (S - x) . n are those wanted. For polynomial patches `touching` does not matter.
/// @pre `corners` are a parallelogram's, in order; `rounding` bounds the error of a control point
SecondForm second_form(NetShape shape, bool rational, std::span<const dvec4> points,
                       std::span<const dvec4> touching, const std::array<dvec3, 4>& corners,
                       double rounding);

}  // namespace taut
