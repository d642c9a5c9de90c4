#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The curvature of a surface at a point, and its change, up to third order, in the scene's frame:
/// what tells where the surface's parabolic curve runs and where on it the cusps of Gauss are.
struct SurfaceCurvature {
  dvec3 x = dvec3(0.0);
  /// Unit normal on the side from which the surface bends away most: the outward one wherever a
  /// supporting plane can touch.
  dvec3 n = dvec3(0.0);
  /// Second derivatives of x . n by arc length in the principal directions: the one nearer to zero
  /// and the other, which is not positive.
  double flat = 0;
  double steep = 0;
  /// The flat principal direction, of either sense: unit tangent e and the parameters' rates.
  dvec3 along = dvec3(0.0);
  dvec2 rate = dvec2(0.0);
  /// Third derivative of S . n along `rate`. On the parabolic curve it vanishes in cusps of Gauss.
  double cubic = 0;
  /// Length of the third derivative of S itself, to which the rounding of `cubic` is relative.
  double third = 0;
  /// |Su x Sv|
  double area = 0;

  double gauss_curvature() const { return flat * steep; }
};

/// None where the parameters fail: tangents that vanish or are parallel.
/// @pre kind face; parameters may leave [0, 1] by a little
std::optional<SurfaceCurvature> surface_curvature(const ContactGeometry& geometry,
                                                  const Contact& c);

/// The curvature and torsion of a curve at a point, up to third order, in the scene's frame.
struct CurveCurvature {
  dvec3 x = dvec3(0.0);
  dvec3 along = dvec3(0.0);     ///< unit tangent
  dvec3 binormal = dvec3(0.0);  ///< unit; zero where the curvature vanishes
  double curvature = 0;
  dvec3 second = dvec3(0.0);  ///< second derivative over the square of the speed
  dvec3 third = dvec3(0.0);   ///< third derivative over the cube of the speed
  /// det of the first three derivatives, in units of speed: curvature^2 times torsion.
  double twist = 0;
};

/// None where the curve stands still. @pre kind edge
std::optional<CurveCurvature> curve_curvature(const ContactGeometry& geometry, const Contact& c);

/// The contact is on an edge, at the end of a piece without curvature there but for rounding.
bool ends_straight(const ContactGeometry& geometry, const Contact& c);

}  // namespace taut
