#include "taut/hull/solve/region_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/hull/contact/local_curvature.h"

namespace taut {
namespace {

/// Places of a region at which it is looked, along each of the patch's parameters between its ends;
/// and where one of them is deep.
constexpr int region_places = 3;
constexpr int closer_region_places = 6;
/// How far beside an outline it is looked, in the patch's parameters, and as a share of a smaller
/// region's extent in them.
constexpr double beside_outline = 3e-3;
/// The least share, of the way to a region's middle and to the next places of its outline, up to
/// which it is followed how far it bends up.
constexpr double least_share = 1.0 / 4096;
/// How much higher a curve rises over its tangent where its curvature vanishes linearly, as a share
/// of that at the start times the square of the length to where it does: the most is at twice that.
constexpr double linear_bend = 2.0 / 3;
/// Cosine of the turn from which on an outline has a corner.
constexpr double corner_cosine = 0.9;

/// How far smooth parts of an outline may be from the polygon that stands for it.
double sag_of(const RegionOutline& outline) {
  double most = 0;
  for (const std::vector<dvec2>& loop : outline) {
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
      const dvec2 before = loop[(k + 1) % n] - loop[k];
      const dvec2 after = loop[(k + 2) % n] - loop[(k + 1) % n];
      const double lengths = glm::length(before) * glm::length(after);
      if (glm::dot(before, after) <= corner_cosine * lengths) continue;
      const double turned = std::abs(before.x * after.y - before.y * after.x) / lengths;
      most = std::max(most, 0.25 * turned * std::max(glm::length(before), glm::length(after)));
    }
  }
  return most;
}

/// The box about an outline in the patch's parameters, within the patch.
std::array<dvec2, 2> extent_of(const RegionOutline& outline) {
  dvec2 lower(1), upper(0);
  for (const std::vector<dvec2>& loop : outline) {
    for (const dvec2& uv : loop) {
      lower = glm::min(lower, uv);
      upper = glm::max(upper, uv);
    }
  }
  return {glm::max(lower, dvec2(0)), glm::min(upper, dvec2(1))};
}

const ArcPiece& piece_of(const HullBoundary& boundary, const TrimStretch& s) {
  return boundary.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)];
}

Contact contact(const PatchRegion& region, const dvec2& uv) {
  return {region.instance, SourceKind::face, region.patch, uv.x, uv.y};
}
}  // namespace

/// Places as near to the outline as that may be off are as deep as the arcs there.
double RegionDepths::of(const HullBoundary& boundary, const PatchRegion& region) {
  double of_arcs = 0;
  for (const std::vector<TrimStretch>& loop : region.loops) {
    for (const TrimStretch& s : loop) {
      if (s.arc >= 0) of_arcs = std::max(of_arcs, piece_of(boundary, s).tolerant);
    }
  }
  const RegionOutline outline = outline_of(system_, boundary, region);
  // How what stands for others ripples, places do not tell.
  const Contact any = contact(region, {0, 0});
  const bool ripples = geometry_.patch(any).stand_in;
  double rippled = 0, bent = 0;
  if (ripples) {
    const double deviation = geometry_.part(any).deviation_bound();
    rippled = geometry_.scene().frame().length_to_frame(deviation);
  } else {
    bent = bounds_.known(std::min(deepest_bend(outline, region), bounds_.resolution()));
  }
  const double deepest = deepest_in(outline, region, of_arcs > 0 || bent > 0);
  return std::max({of_arcs, bent, bounds_.elsewhere(deepest), rippled});
}

/// Inside the outline; if that is tolerant or a place is deep, it is looked closer, most about
/// the deepest place.
double RegionDepths::deepest_in(const RegionOutline& outline, const PatchRegion& region,
                                bool closer) {
  const std::array<dvec2, 2> extent = extent_of(outline);
  const dvec2& lower = extent[0];
  const dvec2 size = glm::max(extent[1] - lower, dvec2(0));
  const double beside = std::min(
      beside_outline, std::max(beside_outline * std::min(size.x, size.y), sag_of(outline)));
  double deepest = 0;
  dvec2 at(0.5);
  const auto look = [&](const dvec2& uv) {
    const bool is_inside =
        std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) > 0 && depth_in(outline, uv) >= beside * 0.5;
    if (!is_inside) return;
    const double found = own_depth(region, uv, std::max(deepest, bounds_.tie()));
    if (found > deepest) at = uv;
    deepest = std::max(deepest, found);
  };
  const auto look_at_grid = [&](int places) {
    for (int k = 0; k < places * places; ++k) {
      look(lower + size * ((dvec2(k % places, k / places) + 0.5) / double(places)));
    }
  };
  look_at_grid(region_places);
  if (!closer && deepest <= bounds_.tie()) return deepest;
  look_at_grid(closer_region_places);
  for (const std::vector<dvec2>& loop : outline) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const dvec2& from = loop[k];
      const dvec2 along = loop[(k + 1) % loop.size()] - from;
      const double length = glm::length(along);
      if (!(length > 0)) continue;
      const dvec2 inwards = dvec2(-along.y, along.x) / length;
      look(from + 0.5 * along + beside * inwards);
    }
  }
  dvec2 step = size / double(closer_region_places);
  for (int k = 0; k < DepthBounds::closer_looks; ++k) {
    step *= 0.5;
    const dvec2 middle = at;
    for (const double side : {-1.0, 1.0}) {
      look(middle + dvec2(side * step.x, 0));
      look(middle + dvec2(0, side * step.y));
    }
  }
  return deepest;
}

/// Where a region bends up at its outline it is no part of a convex surface: how deep the places
/// there are if the bend vanishes linearly as far away as it is found to end.
double RegionDepths::deepest_bend(const RegionOutline& outline, const PatchRegion& region) const {
  const auto [lower, upper] = extent_of(outline);
  const dvec2 middle = 0.5 * (lower + upper);
  double deepest = 0;
  for (const std::vector<dvec2>& loop : outline) {
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
      const double bends = upward_curvature(region, loop[k]);
      if (bends <= 0) continue;
      double longest = 0;
      for (const dvec2& to : {middle, loop[(k + n - 1) % n], loop[(k + 1) % n]}) {
        longest = std::max(longest, bend_length(region, loop[k], to));
      }
      deepest = std::max(deepest, linear_bend * bends * longest * longest);
    }
  }
  return deepest;
}

/// How far a region bends up on the way from a place to another.
double RegionDepths::bend_length(const PatchRegion& region, const dvec2& from,
                                 const dvec2& to) const {
  const auto bends_at = [&](double share) {
    return upward_curvature(region, glm::mix(from, to, share)) > 0;
  };
  double share = least_share;
  while (share < 1 && bends_at(share)) share *= 2;
  double step = 0.25 * share;
  for (int k = 0; k < DepthBounds::closer_looks; ++k, step *= 0.5) {
    if (share < 1 && !bends_at(share - step)) share -= step;
  }
  return glm::distance(point(region, from), point(region, glm::mix(from, to, share)));
}

/// The larger principal curvature, positive towards the outside; 0 where the parameters fail.
double RegionDepths::upward_curvature(const PatchRegion& region, const dvec2& uv) const {
  const Contact c = contact(region, uv);
  const std::optional<SurfaceCurvature> bent = surface_curvature(geometry_, c);
  if (!bent) return 0;
  const ContactJet j = geometry_.jet(c);
  const double outwards = glm::dot(bent->n, glm::cross(j.dx[0], j.dx[1])) * region.sign;
  return outwards > 0 ? bent->flat : -bent->steep;
}

dvec3 RegionDepths::point(const PatchRegion& region, const dvec2& uv) const {
  return geometry_.point(contact(region, uv));
}

/// Of the patch by its own normal, if it is deeper than that.
double RegionDepths::own_depth(const PatchRegion& region, const dvec2& uv, double least) {
  const Contact c = contact(region, uv);
  const ContactJet j = geometry_.jet(c);
  const dvec3 n = double(region.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
  if (n == dvec3(0.0)) return 0;
  const double h = glm::dot(j.x, n);
  const double highest = query_.highest_above(h + least, n, c);
  return highest > h + least ? highest - h : 0;
}

}  // namespace taut
