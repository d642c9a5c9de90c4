#pragma once

#include <limits>

namespace taut {

/// Largest relative error of one rounded operation on doubles, 2^-53.
inline constexpr double rounding_unit = std::numeric_limits<double>::epsilon() / 2;

/// Two surfaces that meet along a common border are joined smoothly (G1) if their tangent planes
/// differ by at most this angle everywhere along it, in radians (0.057 degrees).
///
/// CAD kernels write borders that agree to about 1e-6 of the model and tangents to 1e-4 .. 1e-3
/// radians; a crease that a designer means is a hundred times larger. An error in this choice
/// costs accuracy nowhere: it decides only whether a border is listed as an edge.
inline constexpr double smooth_join_angle = 1e-3;

/// Two border points are the same if they differ by at most this fraction of their part's
/// diagonal. Exchanged borders agree to about that; ten times more would join the two sides of thin
/// parts and take short sides of long ones for points.
inline constexpr double join_distance = 1e-7;

/// Largest entry by which R^T R of a rotation may differ from the identity, and its determinant
/// from one. Files write matrices to nine digits or more; an error of this size scales a model by
/// half of it, invisibly in what the files themselves promise.
inline constexpr double rotation_tolerance = 1e-9;

/// A support query stops when nothing can exceed the value found by more than this fraction of the
/// scene's size (2^-43, about 1.1e-13), rounding apart.
///
/// Contact along a whole curve in general position needs cells of the size of the slack's cube
/// root; a smaller one would buy no accuracy, since the value itself is polished by Newton steps to
/// the last bits.
inline constexpr double support_slack = 1024 * rounding_unit;

/// Values of two contacts that differ by no more than this fraction of the scene's size are one:
/// ten times what a support query may miss. Elements whose control points differ by no more
/// coincide.
inline constexpr double support_tie = 1e-12;

/// What the rounding of a set of points may do to the plane of some of them, as a fraction of the
/// sum of the largest coordinates' sizes (2^-49).
///
/// A coordinate that was turned and moved in double precision has gone through some six roundings,
/// each of at most half a unit of the largest intermediate sum; twice that, for both the plane's
/// corners and the point above it, is 12 rounding units.
inline constexpr double coordinate_rounding = 16 * rounding_unit;

/// What rounding may leave of second differences that vanish, and of distances from a line or
/// plane, as a fraction of the largest coordinate (2^-47): a second difference takes four
/// coordinates.
inline constexpr double ruled_rounding = 4 * coordinate_rounding;

/// Largest angle between normals along a crest, and largest difference of heights over its tangent
/// plane as a fraction of the patch's size. Control points round a crest's normals to some 1e-15
/// and its parameter to about that; a thousand times more leaves room for files of fewer digits,
/// and a curve that misses by so little cannot be told from a crest by any support value.
inline constexpr double crest_angle = 1e-11;
inline constexpr double crest_height = 1e-12;

/// Largest angle between straight segments of two patches of which the one goes straight on in the
/// other: how far the join is off the whole segment cannot be told by any support value.
inline constexpr double same_ruling_angle = crest_angle;

/// Crests nearer to a patch's border, or to each other, than this share of the patch are the same:
/// normals turn between them by no more than crest_angle on any but degenerate patches.
inline constexpr double least_crest_share = 1e-9;

/// Patches whose control points differ by at most this fraction of their part's diagonal are the
/// same: more than what moving and rounding does to a copy, less than any gap that is meant.
inline constexpr double repeated_patch_distance = 1e-12;

/// @name Resolution
/// What is nearer than the resolution of a model may be taken for one (surface/resolution.h).
/// @{
/// Its floor where there are curves or surfaces, as a fraction of the diagonal: a tenth of
/// join_distance, at which borders were put together before, and ten times finer than float32. The
/// work on a hull grows with its logarithm.
inline constexpr double resolution_floor = 1e-8;

/// The coarsest that a model may ask for by itself, as a fraction of the diagonal: what a designer
/// means is larger.
inline constexpr double coarsest_resolution = 1e-5;

/// In half steps of the grid that coordinates were rounded to. A coordinate is off by one of them,
/// a point by sqrt(3), two points that were one, or a point and the plane of others that it lay in,
/// by 2 sqrt(3) = 3.47.
inline constexpr double grid_resolution = 4;

/// In what joined borders miss each other by. A contact may lie on either border, and so may the
/// contact at the other end of a ruling: 2; of two rulings that were one, twice that.
inline constexpr double join_resolution = 4;

/// Largest share of the resolution within which elements touch. Eight ties in a row are within it.
inline constexpr double tie_share = 1.0 / 8;

/// Share of the resolution within which an element is told to lie in the convex hull of others. Its
/// points and theirs may each be off by sqrt(3) half steps of a grid, of which grid_resolution is
/// the resolution: together by 0.866 of it.
inline constexpr double cover_share = 7.0 / 8;

/// In units of the resolution that a model has otherwise, how far copies of patches that are meant
/// to be one miss each other at most: features that are no more apart may be told apart, or not.
inline constexpr double copies_apart_limit = 4;
/// @}

/// Largest share of the diagonal that is ever put down to rounding (2^-33, about 1.2e-10): points
/// that are nearly as close as their rounding mean what they say.
inline constexpr double spurious_share = 1048576 * rounding_unit;

/// A freeform scene thinner than this in some direction, as a fraction of its size, is flat: below
/// it, facet normals are rounding noise (support values are proven to about 1e-13).
inline constexpr double flat_width = 1e-11;

/// Far from the origin, one that is thinner than this fraction of the sum of its largest
/// coordinates' sizes, unless that is more than flat_width_limit of its size: control points are
/// stored times their weights, which rounds them twice.
inline constexpr double flat_coordinate_width = 4 * rounding_unit;
inline constexpr double flat_width_limit = 1e-6;

/// Largest factor between two weights of a curve or surface. Control points whose weights differ by
/// nearly the reciprocal of the rounding unit are lost in a sum of doubles; up to here support
/// queries end as fast as ever (tried with log-uniform weights). CAD stays below a thousand.
inline constexpr double max_weight_ratio = 1e12;

/// Highest degree of a curve or surface in either direction. Exchange formats in use stop at 25.
inline constexpr int max_degree = 31;

/// Most control points that the Bezier pieces of a file may have together (2 GiB of them). A
/// B-spline of degree 31 has a thousand for each control point in the file.
inline constexpr double max_piece_points = 1 << 26;

}  // namespace taut
