#pragma once

#include <string>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// A rational B-spline curve on any non-decreasing knot vector: clamped or not, with multiple
/// knots, or periodic (control points and knots repeated as needed, the usual unclamped form).
///
/// Control points are homogeneous, as in BezierCurve. The number of knots is that of the points
/// plus degree plus one, and the curve's domain is [knots[degree], knots[number of points]].
struct NurbsCurve {
  int degree = 0;             ///< 1 or more
  std::vector<double> knots;  ///< not decreasing
  std::vector<dvec4> points;  ///< homogeneous

  /// Where the curve is defined.
  Interval domain() const;
};

/// A rational tensor-product B-spline surface; control points along v within along u.
struct NurbsSurface {
  int degree_u = 0;             ///< 1 or more
  int degree_v = 0;             ///< 1 or more
  std::vector<double> knots_u;  ///< not decreasing
  std::vector<double> knots_v;  ///< not decreasing
  std::vector<dvec4> points;    ///< homogeneous, count_u() * count_v()

  /// Control points along u.
  int count_u() const { return static_cast<int>(knots_u.size()) - degree_u - 1; }
  /// Control points along v.
  int count_v() const { return static_cast<int>(knots_v.size()) - degree_v - 1; }
  /// Where the surface is defined.
  Interval domain_u() const;
  /// Where the surface is defined.
  Interval domain_v() const;
};

/// A Bezier curve and the interval of the original parameter that it covers.
struct CurvePiece {
  BezierCurve bezier;  ///< over [0, 1]
  Interval t;          ///< that it covers
};

/// A Bezier patch and the rectangle of the original parameters that it covers.
struct PatchPiece {
  BezierPatch bezier;  ///< over [0, 1]^2
  Interval u;          ///< that it covers
  Interval v;          ///< that it covers
};

/// @throws InvalidInput if a degree is out of range, counts do not match, knots decrease or are
/// not finite, their range overflows, the domain is empty, a knot has multiplicity above degree +
/// 1, or control points are not as validate_points() wants them; `name` begins the message
void validate(const NurbsCurve& curve, const std::string& name);
void validate(const NurbsSurface& surface, const std::string& name);

/// The Bezier pieces over the non-empty knot spans, in ascending order of the parameter (u outer,
/// v inner). Exact up to the rounding of the blossoms' affine combinations, which are convex:
/// weights stay positive, and the pieces' control points within the convex hull of the original's.
///
/// Source: Ramshaw 1989: the Bezier points over [a, b] are the blossom's values at (a..a, b..b).
/// @pre validate() passes
std::vector<CurvePiece> decompose(const NurbsCurve& curve);
std::vector<PatchPiece> decompose(const NurbsSurface& surface);

/// The trivial B-spline form of a Bezier curve or patch, over [0, 1].
NurbsCurve as_nurbs(const BezierCurve& curve);
NurbsSurface as_nurbs(const BezierPatch& patch);

}  // namespace taut
