#pragma once

#include <vector>

#include "shapes.h"

/// Exact arcs, sweeps and lofts of which parts are made, and B-splines.
namespace taut_test {

using namespace taut::shapes;  // NOLINT: shapes
using taut::dvec3;
using taut::dvec4;
using taut::NurbsCurve;
using taut::NurbsSurface;

/// The arc from a to b whose tangents meet in the corner, as far from either.
NurbsCurve arc(const dvec3& a, const dvec3& corner, const dvec3& b);

/// The points in order, with an arc of the radius at each point between: sides and arcs, end to
/// end. A closed outline has one at each point, and ends where it begins.
/// @pre the radius is below half of each side's length times the tangent of half its angles
std::vector<NurbsCurve> rounded(const std::vector<dvec3>& points, double radius, bool closed);

/// Clamped, uniform.
NurbsCurve spline(const std::vector<dvec3>& points, int degree = 3);
/// Periodic, uniform and cubic.
NurbsCurve closed_spline(std::vector<dvec3> points);
/// Clamped, uniform: rows of points, all of one length.
NurbsSurface spline(const std::vector<std::vector<dvec3>>& rows, int degree_u = 3,
                    int degree_v = 3);

/// Cubic, clamped and uniform across curves of one degree, with equal knots.
NurbsSurface lofted(const std::vector<NurbsCurve>& curves);
/// Segments from each point of the one to that of the other. @pre of one degree, with equal knots
NurbsSurface ruled(const NurbsCurve& a, const NurbsCurve& b);
/// Segments to a point.
NurbsSurface fan(const NurbsCurve& curve, const dvec3& apex);
/// Segments along d.
NurbsSurface extruded(const NurbsCurve& curve, const dvec3& d);
NurbsCurve moved(NurbsCurve curve, const dvec3& d);
/// A quarter of a turn about the z axis, from +x to +y, of a profile (x, 0, z).
NurbsSurface quarter_turn(const NurbsCurve& profile);
/// Bilinear.
NurbsSurface quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);

Shape of(std::vector<NurbsSurface> surfaces);
Shape revolved_all(const std::vector<NurbsCurve>& profile);
/// Walls of an outline at z = 0 up to z = h, with fans to a point inside as lids.
Shape prism(const std::vector<NurbsCurve>& outline, double h, const dvec3& inside);

}  // namespace taut_test
