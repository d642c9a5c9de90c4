#pragma once

#include <string>
#include <vector>

#include "taut/surface/control_cage.h"
#include "taut/surface/model.h"

namespace taut_test {

using taut::CageScheme;
using taut::ControlCage;
using taut::dvec3;

/// @name Control cages
/// @{
/// Corners at (+-1, +-1, +-1).
ControlCage cube_cage();
ControlCage tetrahedron_cage(CageScheme scheme);
/// m x n quads around a torus of radii 2 and 0.8, all regular.
ControlCage torus_cage(int m, int n);
/// The same of triangles, two for each quad, for the scheme loop: all regular.
ControlCage triangle_torus_cage(int m, int n);
/// A closed, convex body about the z axis with a vertex of the valence at its top and its bottom,
/// in no symmetric position.
ControlCage dome_cage(CageScheme scheme, int valence);
/// m x n quads of a bulging sheet over [-1, 1]^2, open.
ControlCage sheet_cage(int m, int n);
/// @}

/// A limit point of a uniformly refined cage, by OpenSubdiv's limit masks.
struct LimitPoint {
  dvec3 x;
  dvec3 normal;  ///< unit; zero where there is none
};

/// Those of all vertices that are faces' corners, after so many levels of uniform refinement.
std::vector<LimitPoint> limit_points(const ControlCage& cage, int levels);

/// The cage as a model of one part.
taut::Model cage_model(const ControlCage& cage, double accuracy = 1e-9);

}  // namespace taut_test
