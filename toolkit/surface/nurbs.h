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
  int degree = 0;
  std::vector<double> knots;
  std::vector<dvec4> points;

  Interval domain() const;
};

/// A rational tensor-product B-spline surface; control points along v within along u.
struct NurbsSurface {
  int degree_u = 0;
  int degree_v = 0;
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  std::vector<dvec4> points;

  int count_u() const { return static_cast<int>(knots_u.size()) - degree_u - 1; }
  int count_v() const { return static_cast<int>(knots_v.size()) - degree_v - 1; }
  Interval domain_u() const;
  Interval domain_v() const;
};

/// A Bezier curve and the interval of the original parameter that it covers.
struct CurvePiece {
  BezierCurve bezier;
  Interval t;
};

/// A Bezier patch and the rectangle of the original parameters that it covers.
struct PatchPiece {
  BezierPatch bezier;
  Interval u;
  Interval v;
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
