#include "taut/surface/piecewise.h"

#include <algorithm>
#include <cstddef>

#include "taut/core/integers.h"

namespace taut {
namespace {

/// The common part of two intervals, and the same in coordinates where `piece` is [0, 1].
struct Overlap {
  Interval common, local;
  bool empty() const { return !(common.lower < common.upper && local.lower < local.upper); }
};

Overlap overlap(const Interval& piece, const Interval& range) {
  Overlap o;
  o.common = {std::max(piece.lower, range.lower), std::min(piece.upper, range.upper)};
  const double length = piece.upper - piece.lower;
  o.local = {o.common.lower == piece.lower ? 0 : (o.common.lower - piece.lower) / length,
             o.common.upper == piece.upper ? 1 : (o.common.upper - piece.lower) / length};
  return o;
}

}  // namespace

std::vector<double> piecewise_knots(const std::vector<double>& breakpoints, int degree, int inner) {
  std::vector<double> knots;
  for (std::size_t i = 0; i < breakpoints.size(); ++i) {
    const bool end = i == 0 || i + 1 == breakpoints.size();
    knots.insert(knots.end(), to_size(end ? degree + 1 : inner), breakpoints[i]);
  }
  return knots;
}

NurbsCurve joined(const std::vector<CurvePiece>& pieces) {
  NurbsCurve curve;
  curve.degree = pieces.front().bezier.degree();
  std::vector<double> breakpoints = {pieces.front().t.lower};
  for (const CurvePiece& piece : pieces) {
    curve.points.insert(curve.points.end(), piece.bezier.points.begin(), piece.bezier.points.end());
    breakpoints.push_back(piece.t.upper);
  }
  curve.knots = piecewise_knots(breakpoints, curve.degree, curve.degree + 1);
  return curve;
}

NurbsSurface joined(const std::vector<PatchPiece>& pieces) {
  const BezierPatch& first = pieces.front().bezier;
  std::vector<double> breakpoints_u = {pieces.front().u.lower};
  std::vector<double> breakpoints_v = {pieces.front().v.lower};
  for (const PatchPiece& piece : pieces) {
    // Pieces come with u outer, v inner: all v are seen in the first row.
    if (piece.u.upper > breakpoints_u.back()) breakpoints_u.push_back(piece.u.upper);
    if (piece.v.upper > breakpoints_v.back()) breakpoints_v.push_back(piece.v.upper);
  }
  NurbsSurface surface;
  surface.degree_u = first.degree_u;
  surface.degree_v = first.degree_v;
  surface.knots_u = piecewise_knots(breakpoints_u, first.degree_u, first.degree_u + 1);
  surface.knots_v = piecewise_knots(breakpoints_v, first.degree_v, first.degree_v + 1);
  surface.points.reserve(pieces.size() * first.points.size());
  const std::size_t pieces_v = breakpoints_v.size() - 1;
  for (std::size_t row = 0; row < pieces.size(); row += pieces_v) {
    for (int i = 0; i <= first.degree_u; ++i) {
      for (std::size_t k = row; k < row + pieces_v; ++k) {
        const BezierPatch& patch = pieces[k].bezier;
        const dvec4* const begin = &patch.at(i, 0);
        surface.points.insert(surface.points.end(), begin, begin + patch.degree_v + 1);
      }
    }
  }
  return surface;
}

NurbsCurve restricted(const NurbsCurve& curve, const Interval& range) {
  return restricted(decompose(curve), range);
}

NurbsCurve restricted(const std::vector<CurvePiece>& curve, const Interval& range) {
  std::vector<CurvePiece> pieces;
  for (const CurvePiece& piece : curve) {
    const Overlap t = overlap(piece.t, range);
    if (!t.empty()) pieces.push_back({restricted(piece.bezier, t.local), t.common});
  }
  if (pieces.empty()) return {curve.front().bezier.degree(), {}, {}};
  return joined(pieces);
}

NurbsSurface restricted(const NurbsSurface& surface, const Interval& u, const Interval& v) {
  std::vector<PatchPiece> pieces;
  for (const PatchPiece& piece : decompose(surface)) {
    const Overlap in_u = overlap(piece.u, u);
    const Overlap in_v = overlap(piece.v, v);
    if (in_u.empty() || in_v.empty()) continue;
    pieces.push_back({restricted(piece.bezier, in_u.local, in_v.local), in_u.common, in_v.common});
  }
  if (pieces.empty()) return {surface.degree_u, surface.degree_v, {}, {}, {}};
  return joined(pieces);
}

}  // namespace taut
