#pragma once

#include <limits>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// Lower bound of the distance of the origin from the convex hull of unit vectors, at most one.
/// Not positive if they lie in no open half-space, or hardly.
///
/// This depth turns gaps into distances. Let P be a polytope inside a convex body H, v a vertex of
/// P and n_1 .. n_k directions whose cone holds the unit vector n, n = sum l_i n_i with l_i >= 0.
/// The support function is convex and homogeneous, so
///     h_H(n) - v.n <= sum l_i (h_H(n_i) - v.n_i) <= max_i (h_H(n_i) - v.n_i) * sum l_i,
/// and sum l_i <= 1 / depth, because n.m = sum l_i n_i.m >= depth * sum l_i for the unit vector m
/// that attains the depth. With the normals of the facets about v these cones cover all directions
/// as v runs over the vertices, also if the normals are rounded (the dual surface still winds once
/// about the origin while all depths are positive). So
///     max_n h_H(n) - h_P(n) <= max_v max_i (h_H(n_i) - v.n_i) / depth_v,
/// and the left side is the Hausdorff distance of P and H.
///
/// Method: the point of least norm by Gilbert, Johnson and Keerthi 1988, any iterate of which gives
/// a bound; narrow cones are answered by their mean.
double cone_depth(std::span<const dvec3> directions);

/// A depth, and the unit vector m over which all directions are at least so high; zero if there are
/// none.
struct ConeDepth {
  double depth = 1;         ///< in [0, 1]
  dvec3 axis = dvec3(0.0);  ///< that attains it
};
/// cone_depth() with the vector that attains it.
ConeDepth deepest_axis(std::span<const dvec3> directions);

/// What a gap at a vertex whose cone is so deep bounds the distance by; infinite where the normals
/// prove nothing.
inline double distance_bound(double gap, double depth) {
  return depth > 0 ? gap / depth : std::numeric_limits<double>::infinity();
}

}  // namespace taut
