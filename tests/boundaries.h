#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut_test {

/// A scene with the exact boundary of its hull, put together by hand.
struct KnownBoundary {
  taut::Scene scene;
  taut::HullBoundary boundary;
};

/// A stretch of a patch's border.
taut::TrimStretch on_border(taut::Side side, double from, double to);

/// Of a whole patch: its four sides, counter-clockwise in (u, v).
std::vector<taut::TrimStretch> whole_outline();

/// The sign that turns Su x Sv of a patch of the only instance outward, for a point inside, in the
/// scene's frame.
int outward_sign(const taut::ContactGeometry& geometry, int patch, const taut::dvec3& inside);

/// Four free points about (5, 6, 7) and `shift`: 4 facets, 6 rulings.
KnownBoundary tetrahedron_boundary(const taut::dvec3& shift = taut::dvec3(0.0));

/// Spheres of radius 1 and 0.5 about the origin and (0, 0, 3), turned by `rotation`, then shifted:
/// 2 patches, 1 closed scroll of four pieces, 2 closed bitangents.
KnownBoundary two_spheres_boundary(const taut::dmat3& rotation = taut::dmat3(1.0),
                                   const taut::dvec3& shift = taut::dvec3(0.0));

/// The lateral surface of a cylinder of radius 1 and height 2: 2 facets bounded by circles, 1
/// closed scroll on the surface, with contacts on its borders; the lower circle is two curves, the
/// upper one a single closed one.
KnownBoundary cylinder_boundary(const taut::dmat3& rotation = taut::dmat3(1.0),
                                const taut::dvec3& shift = taut::dvec3(0.0));

/// The part of the unit sphere above z = 1 - height, at most half of it: 1 patch, 1 facet bounded
/// by its rim, an edge; no arcs.
KnownBoundary cap_boundary(double height, const taut::dmat3& rotation = taut::dmat3(1.0),
                           const taut::dvec3& shift = taut::dvec3(0.0));

/// The outer half of a torus, 1 patch, and the 2 facets that touch it along its rims.
KnownBoundary half_torus_boundary(double R, double r);

/// The same of all of it, with seams for the rims.
KnownBoundary torus_boundary(double R, double r);

/// z = x^2 + y^2 over [-1, 1]^2: 1 patch, 4 facets between a parabola and its chord, and a square.
KnownBoundary paraboloid_boundary();

}  // namespace taut_test
