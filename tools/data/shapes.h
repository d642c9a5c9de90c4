#pragma once

#include <vector>

#include "taut/surface/nurbs.h"

/// Shapes whose hulls are known, as exact curves and surfaces. Their numbers come from sums,
/// products, quotients and square roots alone, so that they are the same bits everywhere.
namespace taut::shapes {

/// Geometry that can still be moved and put together before it becomes a model.
struct Shape {
  std::vector<NurbsSurface> surfaces;
  std::vector<NurbsCurve> curves;
  std::vector<dvec3> points;
};

Shape operator+(Shape a, const Shape& b);
/// Every x becomes matrix * x + translation.
Shape mapped(Shape shape, const dmat3& matrix, const dvec3& translation = dvec3(0.0));
Shape scaled(Shape shape, double factor);
Shape shifted(Shape shape, const dvec3& translation);

/// @name Curves
/// @{
/// The full circle center + a cos t + b sin t; an ellipse if a and b differ.
NurbsCurve circle(const dvec3& center, const dvec3& a, const dvec3& b);
/// The half of it from +b over a to -b.
NurbsCurve half_circle(const dvec3& center, const dvec3& a, const dvec3& b);
NurbsCurve segment(const dvec3& a, const dvec3& b);
/// (t, t^2, t^3), 0 <= t <= 1.
NurbsCurve twisted_cubic();
/// @}

/// The profile's points (x, 0, z), x >= 0, turned about the z axis once.
NurbsSurface revolved(const NurbsCurve& profile);

/// @name Shapes; about the origin, round ones about the z axis
/// @{
Shape of_patch(const BezierPatch& patch);
/// Eight rational biquadratic patches that collapse at the poles.
Shape sphere(double radius = 1);
Shape ellipsoid(double a, double b, double c);
Shape torus(double R, double r);
/// Lateral surface alone, from z = 0 to z = h: its hull is the solid's.
Shape cylinder(double r, double h);
/// Lateral surface alone, tip in (0, 0, h).
Shape cone(double r, double h);
Shape frustum(double R, double r, double h);
/// Four triangle-like patches about their common corner (0, 0, z).
Shape disc(double r, double z);
/// With the discs that close them.
Shape solid_cylinder(double r, double h);
Shape solid_cone(double r, double h);
/// Six bilinear faces, one corner in the origin.
Shape box(double a, double b, double c);
/// The box with all edges rounded: planes, quarter cylinders, eighths of spheres. It is convex.
Shape filleted_box(double a, double b, double c, double r);
/// The part of the unit sphere above z = 1 - height.
Shape spherical_cap(double height);
/// Spheres about the origin and (0, 0, d).
Shape two_spheres(double r1, double r2, double d);
/// Unit circles in orthogonal planes, each through the other's centre.
Shape oloid();
Shape perpendicular_circles();
/// z = x^2 + y^2, z = x^2 - y^2 and z = x y over [-1, 1]^2.
Shape paraboloid();
Shape saddle();
Shape bilinear_saddle();
/// A round body with a dent: a closed surface of one degree 4 revolution whose profile
/// turns inward at the top.
Shape dented();
/// The ellipsoid with half axes 3, 2, 1 about the origin, dented from +y: its points, as eight
/// rational patches in quarters of the turn u and halves of the profile v, are multiplied by
/// 1 - 0.6 a(u) b(v), where a = (1 - s^2)^2 over the two quarters with y > 0 and b = (1 - s^2)^3
/// over all of v, s the distance from the middle in quarters or halves. It stays G1. The hull
/// bridges the dent by one scroll of segments along z that dies at both ends.
Shape dented_ellipsoid();
/// @}

}  // namespace taut::shapes
