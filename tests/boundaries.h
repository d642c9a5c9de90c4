#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/hull_boundary.h"

namespace taut_test {

/// A scene with the exact boundary of its hull, put together by hand.
struct KnownBoundary {
  taut::Scene scene;
  taut::HullBoundary boundary;
};

/// Four free points about (5, 6, 7) and `shift`: 4 facets, 6 rulings.
KnownBoundary tetrahedron_boundary(const taut::dvec3& shift = taut::dvec3(0.0));

/// Spheres of radius 1 and 0.5 about the origin and (0, 0, 3), turned by `rotation`, then shifted:
/// 2 patches, 1 closed scroll of four pieces, 2 closed bitangents.
KnownBoundary two_spheres_boundary(const taut::dmat3& rotation = taut::dmat3(1.0),
                                   const taut::dvec3& shift = taut::dvec3(0.0));

/// The lateral surface of a cylinder of radius 1 and height 2: 2 facets, 1 closed scroll on the
/// surface, with contacts on its borders; the lower circle is two curves, the upper one a single
/// closed one.
KnownBoundary cylinder_boundary();

}  // namespace taut_test
