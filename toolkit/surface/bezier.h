#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// The two parameter directions of a surface.
enum class Direction { u, v };

/// A rational Bezier curve c(t), t in [0, 1].
///
/// Control points are homogeneous, (w x, w y, w z, w) with w > 0; there are degree + 1 of them.
struct BezierCurve {
  std::vector<dvec4> points;  ///< homogeneous

  /// -1 without points.
  int degree() const { return static_cast<int>(points.size()) - 1; }
};

/// A rational tensor-product Bezier patch S(u, v), (u, v) in [0, 1]^2.
///
/// Control points are homogeneous, (w x, w y, w z, w) with w > 0, and stand along v within along u:
/// point (i, j) is points[i * (degree_v + 1) + j].
struct BezierPatch {
  int degree_u = 0;           ///< along u
  int degree_v = 0;           ///< along v
  std::vector<dvec4> points;  ///< homogeneous, (degree_u + 1) (degree_v + 1)

  /// Control point (i, j), 0 <= i <= degree_u, 0 <= j <= degree_v.
  const dvec4& at(int i, int j) const { return points[index(i, j)]; }
  /// Control point (i, j), likewise.
  dvec4& at(int i, int j) { return points[index(i, j)]; }
  /// Place of control point (i, j) in the list.
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(degree_v + 1) +
           static_cast<std::size_t>(j);
  }
};

/// The Euclidean point of a homogeneous one.
inline dvec3 euclidean(const dvec4& p) { return dvec3(p) / p.w; }

/// The homogeneous point of a Euclidean one with weight w.
inline dvec4 homogeneous(const dvec3& p, double w = 1) { return {w * p, w}; }

/// All weights equal: the curve or patch is polynomial.
bool is_polynomial(const std::vector<dvec4>& points);

/// @throws InvalidInput if degrees are below 1 or above max_degree, the number of points does not
/// match, a number is not finite, or a weight is not positive or differs from another by more than
/// max_weight_ratio; `name` begins the message
void validate(const BezierCurve& curve, const std::string& name);
void validate(const BezierPatch& patch, const std::string& name);
/// The parts of it that B-splines share: the degree, and the numbers of homogeneous points.
void validate_degree(int degree, const std::string& name);
void validate_points(const std::vector<dvec4>& points, const std::string& name);

/// @name Evaluation
/// Points and derivatives with respect to the parameters, at any (u, v) in [0, 1]^2.
/// Error of a point: at most (4 degree_u + 4 degree_v + 8) rounding units of the largest control
/// point's coordinate when weights are equal (Bernstein sums of positive weights).
/// @{

/// A point of a curve and its derivatives: to the third.
struct CurveJet {
  dvec3 c;     ///< the point
  dvec3 ct;    ///< dc/dt
  dvec3 ctt;   ///< d2c/dt2
  dvec3 cttt;  ///< d3c/dt3
};
/// A point of a patch and its derivatives: to the first.
struct PatchJet1 {
  dvec3 S;   ///< the point
  dvec3 Su;  ///< dS/du
  dvec3 Sv;  ///< dS/dv
};
/// To the second.
struct PatchJet2 : PatchJet1 {
  dvec3 Suu;  ///< d2S/du2
  dvec3 Suv;  ///< d2S/du dv
  dvec3 Svv;  ///< d2S/dv2
};
/// To the third.
struct PatchJet3 : PatchJet2 {
  dvec3 Suuu;  ///< d3S/du3
  dvec3 Suuv;  ///< d3S/du2 dv
  dvec3 Suvv;  ///< d3S/du dv2
  dvec3 Svvv;  ///< d3S/dv3
};

dvec3 point(const BezierCurve& curve, double t);
CurveJet jet(const BezierCurve& curve, double t);
dvec3 point(const BezierPatch& patch, double u, double v);
PatchJet1 jet1(const BezierPatch& patch, double u, double v);
PatchJet2 jet2(const BezierPatch& patch, double u, double v);
PatchJet3 jet3(const BezierPatch& patch, double u, double v);
/// @}

/// Unit surface normal, in the direction of Su x Sv.
///
/// Where the patch degenerates (a collapsed edge, parallel tangents) it is the limit along the
/// line to the patch's centre; the zero vector if there is none (the patch is a curve or a point).
dvec3 unit_normal(const BezierPatch& patch, double u, double v);

/// @name Exact changes of representation
/// The curve or patch stays as it is up to the rounding of convex combinations.
/// @{
BezierCurve elevated(const BezierCurve& curve, int degree);
BezierPatch elevated(const BezierPatch& patch, int degree_u, int degree_v);
/// The part over an interval within [0, 1], reparametrised to [0, 1].
BezierCurve restricted(const BezierCurve& curve, Interval t);
BezierPatch restricted(const BezierPatch& patch, Interval u, Interval v);
BezierCurve reversed(const BezierCurve& curve);
/// Exchanges u and v.
BezierPatch transposed(const BezierPatch& patch);
/// @}

/// The four borders of a patch.
enum class Side { u0, u1, v0, v1 };
inline constexpr std::array<Side, 4> all_sides = {Side::u0, Side::u1, Side::v0, Side::v1};

/// The side's free parameter is v.
inline bool along_v(Side side) { return side == Side::u0 || side == Side::u1; }
/// The other parameter is one there, rather than zero.
inline bool at_upper_end(Side side) { return side == Side::u1 || side == Side::v1; }
/// The side across from it.
inline Side opposite(Side side) { return Side(int(side) ^ 1); }
/// (u, v) of the side's point with the free parameter t.
inline dvec2 on_side(Side side, double t) {
  const double fixed = at_upper_end(side) ? 1 : 0;
  return along_v(side) ? dvec2(fixed, t) : dvec2(t, fixed);
}

/// The border as a curve, in the direction of the growing free parameter.
BezierCurve border(const BezierPatch& patch, Side side);

/// Bounds on the derivatives of the *homogeneous* patch: the largest norms of the space part and
/// the weight part, separately, over [0, 1]^2. From differences of the control net; rounding
/// included.
struct HomogeneousBound {
  double space = 0;   ///< of (w x, w y, w z)
  double weight = 0;  ///< of w
};
/// Of d^2/du^2 or d^2/dv^2 over the patch.
HomogeneousBound second_derivative_bound(const BezierPatch& patch, Direction direction);
/// Of d^2/dt^2 over the curve.
HomogeneousBound second_derivative_bound(const BezierCurve& curve);
/// Of the mixed fourth derivative d^4/(du^2 dv^2).
HomogeneousBound mixed_derivative_bound(const BezierPatch& patch);

}  // namespace taut
