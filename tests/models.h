#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/surface/model.h"

namespace taut_test {

using taut::BezierCurve;
using taut::BezierPatch;
using taut::dmat3;
using taut::dvec3;
using taut::dvec4;
using taut::Model;
using taut::NurbsCurve;
using taut::NurbsSurface;

using Random = std::mt19937_64;

double uniform(Random& random, double lower, double upper);
/// Uniform in the logarithm. @pre 0 < lower < upper
double log_uniform(Random& random, double lower, double upper);
/// lower <= result <= upper
int pick(Random& random, int lower, int upper);
dvec3 random_point(Random& random);
dvec3 random_direction(Random& random);
dmat3 random_rotation(Random& random);
/// A rotation whose axis and angle are no round numbers.
dmat3 skew_rotation();

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
Model make_model(const Shape& shape);
taut::Scene make_scene(const Shape& shape, int threads = 1);

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
/// An ellipsoid's hull with a dent: a closed surface of one degree 4 revolution whose profile
/// turns inward at the top.
Shape dented();
/// The Utah teapot from the data folder.
Shape teapot();
/// @}

/// @name Random geometry of size about one
/// @{
/// Weights are log-uniform in [1 / weight_range, weight_range]; polynomial if it is one.
BezierPatch random_patch(Random& random, int degree_u, int degree_v, double weight_range);
BezierCurve random_curve(Random& random, int degree, double weight_range);
/// @}

}  // namespace taut_test
