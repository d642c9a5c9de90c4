#pragma once

#include <array>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/measure/quadrature.h"

namespace taut {

/// The integrals over the boundary, where x is relative to a point inside. By the divergence
/// theorem, of the fields x, x_i x and x_i x_j x with divergences 3, 4 x_i and 5 x_i x_j:
///   volume = int x . dA / 3,  moments = int x_i x . dA / 4,  int x_i x_j x . dA / 5.
enum Quantity : std::size_t {
  volume = 0,
  area = 1,
  curvature = 2,        ///< total mean curvature, int (k1 + k2) / 2 dA, creases included
  moment = 3,           ///< int x dV
  second = 6,           ///< int x_i x_j dV: xx, yy, zz, yz, zx, xy
  surface_moment = 12,  ///< int x dA
  vector_area = 15,     ///< int n dA
  ruled = 18,           ///< area of scrolls
  way = 19,             ///< of a ruling's two points, int dx: for comparison
  turning = 25,         ///< of its normal, int dn: the same
  quantities = 28
};
using Quantities = std::array<double, quantities>;
using Sums = Integrals<quantities>;

/// Adds w times the area element of size dA with unit or any normal, n dA = A.
void add_element(Quantities& sum, const dvec3& x, const dvec3& A, double dA, double w);

/// Adds the integrands over a patch per du dv, about the origin; the outward normal is along sign *
/// (Su x Sv).
void add_patch(const ContactJet& j, const dvec3& origin, int sign, Quantities& sum);

/// Half the angle of n about an edge's tangent, from the direction away from the edge's origin
/// (CreaseOrigins), times the tangent's length: between -pi/4 and pi/4 times that, since x . n > 0.
double crease(const dvec3& x, const dvec3& tangent, const dvec3& n);

/// Tolerances relative to the largest component of each kind, but not below the rounding of what
/// they are made of: lengths in the scene's frame are about one at most, derivatives are rounded as
/// these are, and areas have those of the region's size as factors. What is for comparison is taken
/// as it is.
Quantities tolerances(const Quantities& magnitude);

}  // namespace taut
