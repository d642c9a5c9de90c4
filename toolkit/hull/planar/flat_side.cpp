#include "taut/hull/planar/flat_side.h"

namespace taut {
namespace {

/// The edge that the side runs along; -1: it is straight.
int edge_source(const ContactGeometry& geometry, const FlatSide& side) {
  if (!side.is_curved()) return -1;
  const Contact c = side.along.at(0);
  const int edge = geometry.piece(c).edge;
  return geometry.scene().model().source_id({SourceKind::edge, c.instance, edge});
}

std::vector<dvec3> side_points(const ContactGeometry& geometry, const FlatSide& side,
                               const FlatSide& next) {
  std::vector<dvec3> points = {geometry.point(side.corner)};
  for (int i = 1; side.is_curved() && i < stretch_points; ++i)
    points.push_back(geometry.point(side.at(i)));
  points.push_back(geometry.point(next.corner));
  return points;
}

}  // namespace

std::vector<HullCurve> flat_curves(const ContactGeometry& geometry,
                                   const std::vector<FlatSide>& sides) {
  const std::size_t count = sides.size();
  const auto goes_on = [&](std::size_t k) {
    const int source = edge_source(geometry, sides[k % count]);
    return source >= 0 && source == edge_source(geometry, sides[(k + count - 1) % count]);
  };
  std::size_t first = 0;
  while (first < count && goes_on(first)) ++first;
  const bool closed = first == count;
  std::vector<HullCurve> curves;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = (first + i) % count;
    if (i == 0 || !goes_on(k)) {
      HullCurve& curve = curves.emplace_back();
      curve.source = edge_source(geometry, sides[k]);
      curve.kind = curve.source >= 0 ? HullCurveKind::edge : HullCurveKind::ruling;
      curve.faces = {0, -1};
      curve.closed = closed;
    }
    std::vector<dvec3>& points = curves.back().points;
    const std::vector<dvec3> own = side_points(geometry, sides[k], sides[(k + 1) % count]);
    points.insert(points.end(), own.begin() + (points.empty() ? 0 : 1), own.end());
  }
  return curves;
}

}  // namespace taut
