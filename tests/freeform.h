#pragma once

#include <vector>

#include "models.h"

namespace taut_test {

/// Curves and bodies whose hulls each show certain events. Bodies are closed, one surface each
/// unless said otherwise.

/// (cos t, sin 2t, cos 3t), 0 <= t <= 2 pi: four rational pieces of degree 6, joined at `start`
/// and every quarter turn from there. Its hull touches z = 1 and z = -1 in three points each, and
/// two contacts merge at t = 0 and t = pi, where its torsion vanishes.
Shape tied_curve(double start);

/// z = -(a x^4 - b x^2 y + c y^2) over [-1, 1]^2 as one patch of degree (4, 2).
/// @pre a > b^2 / (4 c): the origin is a godron on the hull, and planes touch in the pairs
/// y = (2 a / b) x^2.
Shape godron(double a, double b, double c);

/// A sheet over [-1, 1] x [-1, 1], curved as a sphere of radius two, a control point in the middle
/// of which is moved down.
Shape dented_sheet(double down);

/// @name The same surfaces and curves, written differently; of one source each as before
/// @{
/// Each Bezier patch in four, split at the parameters u and v of its unit square, and each Bezier
/// piece of a curve in two, at u.
Shape split(const Shape& shape, double u, double v);
/// Degrees raised by one along u and by two along v.
Shape with_higher_degrees(const Shape& shape);
/// Parameters reversed: u of surfaces and that of curves.
Shape with_reversed_parameters(const Shape& shape);
/// u and v of surfaces exchanged.
Shape with_exchanged_parameters(const Shape& shape);
/// @}

/// An ellipsoid's control net pressed in about a direction by a Gaussian whose width goes up and
/// down as often as there are lobes.
struct Dent {
  dvec3 direction = dvec3(1, 0, 0);
  int lobes = 2;
  double turn = 0;      ///< of the first lobe from a fixed tangent, in radians
  double depth = 0.35;  ///< as a share of the ellipsoid's radius
};

/// An ellipsoid-like body with dents: bicubic, C2 but for its two poles on the z axis, at which it
/// is G1; 16 spans around, the first from the angle `start`, 12 from pole to pole.
Shape dented_body(const std::vector<Dent>& dents, double start = 0);

/// @name Rational ellipsoids of which the inside of one patch is pressed in
/// @{
/// A patch about the equator, with a dent that is longer than wide.
Shape ellipsoid_with_a_valley();
/// An eighth, pressed in up to its three sides.
Shape ellipsoid_with_a_threefold_dent();
/// @}

/// The ellipsoid with half axes 2, 1, 0.6 bent upwards: z grows by 0.4 x^2 + 0.1 x y. Rational of
/// degree (4, 4).
Shape bean();

/// @name Bodies of revolution about the z axis
/// @{
/// Two bulges of different radius and a waist.
Shape dumbbell();
/// An arc of 2 acos(0.6) about its chord, the tips in (0, 0, -1) and (0, 0, 1).
Shape lemon();
/// The arc from (1, 0, 0), where it is upright, to the tip (0, 0, sqrt 2), without its base.
Shape ogive();
/// The half y >= 0 of a torus, open at its two ends.
Shape half_torus(double R, double r);
/// @}

}  // namespace taut_test
