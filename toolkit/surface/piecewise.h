#pragma once

#include <vector>

#include "taut/surface/nurbs.h"

namespace taut {

/// Knots of n Bezier pieces: all breakpoints with the multiplicity `inner`, but degree + 1 at the
/// ends. With inner = degree neighbours share their common control points, with degree + 1 each has
/// its own.
std::vector<double> piecewise_knots(const std::vector<double>& breakpoints, int degree, int inner);

/// @name B-splines made of Bezier pieces
/// Each piece keeps its own control points, so that nothing is said about how they join;
/// decompose() gives the same pieces.
/// @pre the pieces are of one degree and in the order of decompose(), without gaps; at least one
/// @{
NurbsCurve joined(const std::vector<CurvePiece>& pieces);
NurbsSurface joined(const std::vector<PatchPiece>& pieces);
/// @}

/// @name The part over a range
/// The Bezier pieces, cut at the ends of the range, joined. No valid curve or surface, but one
/// without points, where the range is too short to be told apart within a piece.
/// @pre validate() passes; the range lies in the domain and is not empty
/// @{
NurbsCurve restricted(const NurbsCurve& curve, const Interval& range);
/// The part of a curve given by its pieces.
NurbsCurve restricted(const std::vector<CurvePiece>& curve, const Interval& range);
NurbsSurface restricted(const NurbsSurface& surface, const Interval& u, const Interval& v);
/// @}

}  // namespace taut
