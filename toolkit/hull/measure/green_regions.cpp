#include "taut/hull/measure/green_regions.h"

#include <algorithm>

namespace taut {
namespace {

bool is_collapsed(const ContactGeometry& geometry, const PatchRegion& region, Side side) {
  const Contact c = {region.instance, SourceKind::face, region.patch, 0, 0};
  return geometry.patch(c).borders[std::size_t(side)].kind == BorderKind::collapsed;
}

/// The parameter that runs along more collapsed sides. It is ill-defined next to them, and its rate
/// along traces that end there, but integrals along it vanish with the distance; across it, they
/// would multiply its noise.
int inner_parameter(const ContactGeometry& geometry, const PatchRegion& region) {
  const auto collapsed = [&](Side side) { return is_collapsed(geometry, region, side) ? 1 : 0; };
  const int along_u = collapsed(Side::v0) + collapsed(Side::v1);
  const int along_v = collapsed(Side::u0) + collapsed(Side::u1);
  return along_v > along_u ? 1 : 0;
}

/// A place for inner integrals to begin that keeps them short along traces, or makes them vanish
/// along a border; on a collapsed side, as there the outer parameter is ill-defined. Any is right:
/// what differs depends on the outer parameter alone, and its integral around a loop is zero.
double base(const ContactGeometry& geometry, const HullBoundary& boundary,
            const PatchRegion& region, int inner) {
  const Side lower_side = inner == 0 ? Side::u0 : Side::v0;
  const Side upper_side = inner == 0 ? Side::u1 : Side::v1;
  if (is_collapsed(geometry, region, lower_side)) return 0;
  if (is_collapsed(geometry, region, upper_side)) return 1;
  bool lower = false, upper = false;
  Interval range{1, 0};
  for (const std::vector<TrimStretch>& loop : region.loops) {
    for (const TrimStretch& stretch : loop) {
      if (stretch.arc < 0) {
        lower |= stretch.side == lower_side;
        upper |= stretch.side == upper_side;
        continue;
      }
      const SeparatingArc& arc = boundary.arcs[std::size_t(stretch.arc)];
      for (const Ruling& ruling : arc.pieces[std::size_t(stretch.piece)].rulings) {
        const Contact& c = ruling.contact[std::size_t(stretch.contact)];
        const double at = inner == 0 ? c.u : c.v;
        range.lower = std::min(range.lower, at);
        range.upper = std::max(range.upper, at);
      }
    }
  }
  if (range.lower <= range.upper) return 0.5 * range.lower + 0.5 * range.upper;
  return upper && !lower ? 1 : 0;
}

}  // namespace

GreenRegions::GreenRegions(const ContactGeometry& geometry, const HullBoundary& boundary) {
  traces_.reserve(boundary.arcs.size());
  for (const SeparatingArc& arc : boundary.arcs) traces_.emplace_back(arc.pieces.size());
  for (const HullFace& face : boundary.faces) {
    for (const PatchRegion& region : face.regions) add(geometry, boundary, region);
  }
}

void GreenRegions::add(const ContactGeometry& geometry, const HullBoundary& boundary,
                       const PatchRegion& region) {
  const int number = int(regions_.size());
  const int inner = inner_parameter(geometry, region);
  regions_.push_back({&region, inner, base(geometry, boundary, region, inner)});
  for (const std::vector<TrimStretch>& loop : region.loops) {
    for (const TrimStretch& stretch : loop) {
      if (stretch.arc < 0) continue;
      traces_[std::size_t(stretch.arc)][std::size_t(stretch.piece)].push_back(
          {number, stretch.contact, stretch.reversed ? -1.0 : 1.0});
    }
  }
}

}  // namespace taut
