#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace taut {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A closed parameter interval, lower <= upper.
struct Interval {
  double lower = 0;  ///< least value
  double upper = 1;  ///< largest value

  /// Affine map of [0, 1] onto the interval; the ends are met exactly.
  double at(double s) const {
    return s <= 0 ? lower : s >= 1 ? upper : (1 - s) * lower + s * upper;
  }
};
inline bool excludes_zero(const Interval& x) { return x.lower > 0 || x.upper < 0; }

/// Axis-parallel closed box. A default-constructed box is empty and contains nothing.
struct Box {
  dvec3 lower = dvec3(infinity);   ///< least coordinates
  dvec3 upper = dvec3(-infinity);  ///< largest coordinates

  /// It contains nothing.
  bool empty() const { return lower.x > upper.x; }
  /// Makes it contain the point.
  void include(const dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  /// Makes it contain the other box.
  void include(const Box& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
  /// Midpoint, computed without overflow. @pre not empty
  dvec3 center() const { return 0.5 * lower + 0.5 * upper; }
};

/// The gaps between two boxes along the axes, zero where they overlap. @pre neither is empty
inline dvec3 box_gaps(const Box& a, const Box& b) {
  return glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), dvec3(0.0));
}
/// The distance of a point from a box, zero inside. @pre not empty
inline double distance(const Box& box, const dvec3& x) {
  return glm::length(box_gaps(box, {x, x}));
}

/// Length of the box's diagonal, correct also where its square would over- or underflow.
/// Zero for an empty box.
double diagonal(const Box& box);

/// The vector scaled to length one, correct also where its square would over- or underflow.
/// The zero vector stays zero.
dvec3 unit(const dvec3& v);

/// The angle between two vectors, in [0, pi], without loss where it is small; 0 if one is zero.
double angle_between(const dvec3& a, const dvec3& b);

/// The distance of a point from the segment between two others, which may be one.
double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b);

/// The unit normal of the mean plane of a polygon, from whose tip it is counter-clockwise (Newell's
/// method); zero where it has no area.
dvec3 polygon_normal(const std::vector<dvec3>& points);

/// The unit normal of a plane polygon, from whose tip it is counter-clockwise, perpendicular to the
/// longest chord from its first point: as that of a sliver is not where points round. Zero where it
/// has no area.
///
/// Of a convex polygon whose points are off some plane by up to d, they are off this one's by no
/// more than 30 d, rounding of the result apart: d turns the sum of the triangles' areas by no more
/// than 4 d / length and 4 d / width of the polygon, which makes 10 d of its heights, and twice
/// that to get from there to the chord, which is half as long as it or more.
dvec3 plane_normal(const std::vector<dvec3>& points);

/// The angle by which the normals m and n of the faces to the left and right of an edge of a convex
/// polyhedron differ, about the unit vector along the edge; below zero by rounding only.
double exterior_angle(const dvec3& m, const dvec3& n, const dvec3& along);

/// The vector, or its opposite where the vector points against `side`.
inline dvec3 aligned(const dvec3& v, const dvec3& side) { return glm::dot(v, side) < 0 ? -v : v; }

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017).
std::array<dvec3, 2> tangent_frame(const dvec3& n);

/// A rigid motion x -> rotation * x + translation. @pre rotation is orthogonal with determinant 1.
struct RigidMotion {
  dmat3 rotation = dmat3(1.0);     ///< about the origin
  dvec3 translation = dvec3(0.0);  ///< after the rotation

  /// The place to which a point is moved.
  dvec3 operator()(const dvec3& x) const { return rotation * x + translation; }
  /// The motion moves nothing.
  bool at_rest() const { return rotation == dmat3(1.0) && translation == dvec3(0.0); }
};

}  // namespace taut
