#include "taut/hull/measure/interior_point.h"

namespace taut {
namespace {

/// The contact at a share of the way along a stretch of an edge.
Contact contact_on(const EdgeStretch& side, double s) {
  return side.at(Interval{side.from, side.to}.at(s));
}

}  // namespace

dvec3 interior_point(const ContactGeometry& geometry, const HullBoundary& boundary) {
  dvec3 sum(0.0);
  double count = 0;
  const auto add = [&](const dvec3& x) {
    sum += x;
    ++count;
  };
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& ruling : piece.rulings) {
        for (const dvec3& x : ruling.point) add(x);
      }
    }
  }
  for (const HullFace& face : boundary.faces) {
    for (const dvec3& x : face.points) add(x);
    // A disc's one contact spans nothing.
    for (const EdgeStretch& side : face.sides) {
      if (side.piece < 0) continue;
      for (const double s : {0.25, 0.5, 0.75}) add(geometry.point(contact_on(side, s)));
    }
    for (const PatchRegion& region : face.regions) {
      for (const std::vector<TrimStretch>& loop : region.loops) {
        for (const TrimStretch& stretch : loop) {
          if (stretch.arc >= 0) continue;
          for (const double s : {0.0, 0.25, 0.5, 0.75}) {
            const dvec2 p = on_side(stretch.side, (1 - s) * stretch.from + s * stretch.to);
            add(geometry.point({region.instance, SourceKind::face, region.patch, p.x, p.y}));
          }
        }
      }
    }
  }
  return count > 0 ? sum / count : sum;
}

}  // namespace taut
