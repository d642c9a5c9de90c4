#include "taut/hull/solve/tolerant_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/local_curvature.h"
#include "taut/hull/contact/region_outline.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// Parts of a facet's curved side, and of the way between two rulings, at whose ends it is looked.
constexpr int places = 8;
/// Further places, beside the ends: where one of these is moved off the curve that leads there, it
/// is passed just before.
constexpr std::array<double, 2> beside_ends = {1.0 / 128, 127.0 / 128};
/// How often the step to the places next to the deepest one is halved.
constexpr int closer_looks = 5;
/// How many times the resolution of exact models that is that rounding makes of a model's numbers.
constexpr double rounded_depths = 2;
/// Up to which share of that the grid of its numbers does not tell.
constexpr double rounded_share = 1.0 / 16;
/// How many times deeper it may be elsewhere than in the deepest place that was found.
constexpr double other_places = 1.25;
/// How many times deeper it may be beside the deepest place, where it was looked closer: what a
/// parabola over the last steps tops it by.
constexpr double near_places = 1.001;
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

class TolerantPlaces {
 public:
  TolerantPlaces(const ContactSystem& system, SupportQuery& query, double resolution)
      : system_(system), geometry_(system.geometry()), query_(query), resolution_(resolution) {
    is_rounded_ = is_rounded(geometry_.scene(), resolution_);
  }

  double of(const ArcPiece& piece) {
    double deepest = piece.tolerant;
    bool touches = true;
    for (const Ruling& r : piece.rulings) {
      deepest = std::max(deepest, depth(r));
      for (std::size_t i = 0; i < 2; ++i) {
        deepest = std::max(deepest, off(r.contact[i], r.point[i]));
        touches = touches && !rises(r.contact[i], r.n);
      }
    }
    double passed = 0;
    if (deepest > geometry_.tie()) {
      for (const Ruling* end : {&piece.rulings.front(), &piece.rulings.back()}) {
        passed = std::max(passed, depth_passed(*end));
      }
    }
    const bool is_exact = !is_rounded_ && piece.tolerant == 0 && deepest <= geometry_.tie();
    for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
      const RulingsBetween between(system_, piece.rulings[k - 1], piece.rulings[k]);
      if (between.empty() || (is_exact && depth_at(between, 0.5) <= geometry_.tie())) continue;
      deepest = std::max(deepest, deepest_of(between));
    }
    return std::max(bound_of(deepest, touches), std::min(passed, resolution_));
  }

  double of(const HullFace& facet) {
    const double h = query_(facet.n, facet.contacts.front()).h;
    double deepest = 0;
    bool touches = true;
    const auto depth_of = [&](const dvec3& x) { return h - glm::dot(x, facet.n); };
    for (const dvec3& x : facet.points) deepest = std::max(deepest, depth_of(x));
    for (std::size_t k = 0; k < facet.contacts.size(); ++k) {
      const Contact& c = facet.contacts[k];
      touches = touches && !rises(c, facet.n);
      deepest = std::max(deepest, depth_of(geometry_.point(c)));
      if (k < facet.points.size()) deepest = std::max(deepest, off(c, facet.points[k]));
    }
    double of_sides = 0;
    for (std::size_t k = 0; k < facet.sides.size(); ++k) {
      const EdgeStretch& side = facet.sides[k];
      if (side.piece < 0) continue;
      const auto depth_at = [&](double share) {
        return depth_of(geometry_.point(side.at(glm::mix(side.from, side.to, share))));
      };
      of_sides = std::max(of_sides, deepest_along(depth_at));
      const std::size_t next = (k + 1) % facet.points.size();
      deepest = std::max({deepest, off(side.at(side.from), facet.points[k]),
                          off(side.at(side.to), facet.points[next])});
    }
    return known(std::max(deepest, near_places * of_sides), touches);
  }

  /// Places as near to the outline as that may be off are as deep as the arcs there.
  double of(const HullBoundary& boundary, const PatchRegion& region) {
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
    const double bent = ripples ? 0 : std::min(deepest_bend(outline, region), resolution_);
    const double deepest = deepest_in(outline, region, of_arcs > 0 || known(bent, true) > 0);
    const double deviation = ripples ? deviation_of(geometry_.part(any)) : 0;
    return std::max({of_arcs, known(bent, true), bound_of(deepest, true), deviation});
  }

 private:
  static const ArcPiece& piece_of(const HullBoundary& boundary, const TrimStretch& s) {
    return boundary.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)];
  }

  /// Inside the outline; if that is tolerant or a place is deep, it is looked closer, most about
  /// the deepest place.
  double deepest_in(const RegionOutline& outline, const PatchRegion& region, bool closer) {
    const auto [lower, upper] = extent_of(outline);
    const dvec2 size = glm::max(upper - lower, dvec2(0));
    const double beside = std::min(
        beside_outline, std::max(beside_outline * std::min(size.x, size.y), sag_of(outline)));
    double deepest = 0;
    dvec2 at(0.5);
    const auto look = [&](const dvec2& uv) {
      const bool is_inside =
          std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) > 0 && depth_in(outline, uv) >= beside * 0.5;
      const double found = is_inside ? own_depth(region, uv) : 0;
      if (found > deepest) at = uv;
      deepest = std::max(deepest, found);
    };
    const auto look_at_grid = [&](int places) {
      for (int k = 0; k < places * places; ++k) {
        look(lower + size * ((dvec2(k % places, k / places) + 0.5) / double(places)));
      }
    };
    look_at_grid(region_places);
    if (!closer && deepest <= geometry_.tie()) return deepest;
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
    for (int k = 0; k < closer_looks; ++k) {
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
  /// there are, or may be, within the resolution, if the bend vanishes linearly as far away as it
  /// is found to end.
  double deepest_bend(const RegionOutline& outline, const PatchRegion& region) {
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
  double bend_length(const PatchRegion& region, const dvec2& from, const dvec2& to) const {
    const auto bends_at = [&](double share) {
      return upward_curvature(region, glm::mix(from, to, share)) > 0;
    };
    double share = least_share;
    while (share < 1 && bends_at(share)) share *= 2;
    double step = 0.25 * share;
    for (int k = 0; k < closer_looks; ++k, step *= 0.5) {
      if (share < 1 && !bends_at(share - step)) share -= step;
    }
    return glm::distance(point(region, from), point(region, glm::mix(from, to, share)));
  }

  /// The larger principal curvature, positive towards the outside; 0 where the parameters fail.
  double upward_curvature(const PatchRegion& region, const dvec2& uv) const {
    const Contact c = contact(region, uv);
    const std::optional<SurfaceCurvature> bent = surface_curvature(geometry_, c);
    if (!bent) return 0;
    const ContactJet j = geometry_.jet(c);
    const double outwards = glm::dot(bent->n, glm::cross(j.dx[0], j.dx[1])) * region.sign;
    return outwards > 0 ? bent->flat : -bent->steep;
  }

  static Contact contact(const PatchRegion& region, const dvec2& uv) {
    return {region.instance, SourceKind::face, region.patch, uv.x, uv.y};
  }
  dvec3 point(const PatchRegion& region, const dvec2& uv) const {
    return geometry_.point(contact(region, uv));
  }

  /// Of the patch by its own normal.
  double own_depth(const PatchRegion& region, const dvec2& uv) {
    const Contact c = contact(region, uv);
    const ContactJet j = geometry_.jet(c);
    const dvec3 n = double(region.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
    return n == dvec3(0.0) ? 0 : query_(n, c).h - glm::dot(j.x, n);
  }

  /// Of exact rulings; where none is found, of the one that is interpolated, the resolution at
  /// least: what there is may be deeper beside it.
  double depth_at(const RulingsBetween& between, double share) {
    const double s = between.at_share(share);
    if (const std::optional<MovingRuling> exact = between(s)) return depth(exact->at.ruling());
    return std::max(resolution_ / near_places, depth(between.interpolated(s).at.ruling()));
  }
  double deepest_of(const RulingsBetween& between) {
    return deepest_along([&](double share) { return depth_at(between, share); });
  }

  /// Between 0 and 1; about the deepest place it is looked closer.
  template <class DepthAt>
  double deepest_along(const DepthAt& depth_at) const {
    double deepest = 0, at = 0.5, step = 1.0 / places;
    const auto look = [&](double share) {
      if (!(0 < share && share < 1)) return;
      const double found = depth_at(share);
      if (found > deepest) at = share;
      deepest = std::max(deepest, found);
    };
    for (int place = 1; place < places; ++place) look(double(place) / places);
    for (const double share : beside_ends) look(share);
    if (deepest <= geometry_.tie()) return deepest;
    for (int k = 0; k < closer_looks; ++k) {
      step *= 0.5;
      const double middle = at;
      look(middle - step);
      look(middle + step);
    }
    return deepest;
  }

  /// Of exact rulings that have one of its contacts: what leads to a ruling that is moved off its
  /// curve may pass it as far.
  double depth_passed(const Ruling& r) {
    double deepest = 0;
    for (const std::size_t i : {0u, 1u}) {
      if (r.contact[i].kind != SourceKind::edge) continue;
      CommonSupport s(geometry_, r);
      const double at = r.contact[i].u;
      const auto stays = [&](const CommonSupport& now) {
        LinearEquation e;
        e.residual = now.contact[i].u - at;
        e.parameter[i] = {1, 0};
        return e;
      };
      if (system_.solve(s, stays)) deepest = std::max(deepest, depth(s.ruling()));
    }
    return deepest;
  }

  double deviation_of(const Part& part) const {
    return geometry_.scene().frame().length_to_frame(part.deviation_bound());
  }

  /// What is so deep: none, if that is not known from none and contacts are where planes touch.
  double known(double deepest, bool touches) const {
    if (deepest <= geometry_.tie()) return touches ? 0 : geometry_.tie();
    return deepest;
  }
  /// Elsewhere it may be deeper, as far as that is within the resolution.
  double bound_of(double deepest, bool touches) const {
    const double own = known(deepest, touches);
    return std::max(near_places * own, std::min(other_places * own, resolution_));
  }

  /// The surface or edge rises from there over the plane: to where it touches one that is parallel
  /// it is farther than the resolution, however little it rises on the way.
  bool rises(const Contact& c, const dvec3& n) const {
    const ContactJet j = geometry_.jet(c);
    const std::array<std::array<dvec3, 2>, 2> ddx = {{{j.dxx, j.dxy}, {j.dxy, j.dyy}}};
    const dvec2 t = parameters(c);
    for (std::size_t k = 0; k < std::size_t(j.dimension); ++k) {
      const double slope = glm::dot(j.dx[k], n);
      double changed = 0;  // over the resolution
      for (std::size_t i = 0; i < std::size_t(j.dimension); ++i) {
        const double speed = glm::length(j.dx[i]);
        if (speed > resolution_) {
          changed += resolution_ / speed * std::abs(glm::dot(ddx[k][i], n));
        }
      }
      const double at = t[int(k)];
      const double upwards = std::max(at < 1 ? slope : 0, at > 0 ? -slope : 0);
      if (upwards > changed + geometry_.tie()) return true;
    }
    return false;
  }

  /// Contacts that are one to within the resolution have one point.
  double off(const Contact& c, const dvec3& x) const {
    return glm::distance(geometry_.point(c), x);
  }

  double depth(const Ruling& r) {
    const double h = query_(r.n, r.contact[0]).h;
    return h - std::min(glm::dot(r.point[0], r.n), glm::dot(r.point[1], r.n));
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  double resolution_;
  bool is_rounded_ = false;
};

}  // namespace

namespace {

/// What pieces miss each other by where one follows the other is within the bounds of both.
void bound_joints(SeparatingArc& arc, double tie) {
  for (std::size_t k = arc.closed ? 0 : 1; k < arc.pieces.size(); ++k) {
    ArcPiece& before = arc.pieces[(k == 0 ? arc.pieces.size() : k) - 1];
    ArcPiece& after = arc.pieces[k];
    for (std::size_t i = 0; i < 2; ++i) {
      const double missed =
          glm::distance(before.rulings.back().point[i], after.rulings.front().point[i]);
      if (missed <= tie) continue;
      for (ArcPiece* piece : {&before, &after}) piece->tolerant = std::max(piece->tolerant, missed);
    }
  }
}

/// What the end of an arc misses corners of the facet by in which it ends is within the bounds of
/// both.
void bound_ends(HullBoundary& boundary, double tie) {
  for (SeparatingArc& arc : boundary.arcs) {
    for (const std::size_t end : {0u, 1u}) {
      if (arc.closed || arc.facet[end] < 0) continue;
      HullFace& facet = boundary.faces[std::size_t(arc.facet[end])];
      ArcPiece& piece = end == 0 ? arc.pieces.front() : arc.pieces.back();
      for (const dvec3& x : (end == 0 ? piece.rulings.front() : piece.rulings.back()).point) {
        double missed = infinity;
        for (const dvec3& corner : facet.points)
          missed = std::min(missed, glm::distance(x, corner));
        if (missed <= tie) continue;
        piece.tolerant = std::max(piece.tolerant, missed);
        facet.tolerant = std::max(facet.tolerant, missed);
      }
    }
  }
}

/// From one ruling to the next: n and both contacts.
using Step = std::array<dvec3, 3>;

Step step_between(const Ruling& from, const Ruling& to) {
  return {to.n - from.n, to.point[0] - from.point[0], to.point[1] - from.point[1]};
}
double dot(const Step& a, const Step& b) {
  return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

/// n and both contacts go on to the left of contact a's way, as they do on a convex hull.
bool goes_on(const Ruling& from, const Ruling& to, double tie) {
  const dvec3 across = to.point[1] - to.point[0] + from.point[1] - from.point[0];
  const dvec3 on = unit(glm::cross(across, from.n + to.n));
  const Step step = step_between(from, to);
  return glm::dot(step[0], on) > 0 && glm::dot(step[1], on) >= -tie &&
         glm::dot(step[2], on) >= -tie;
}

/// Where rulings turn back, along a surface so nearly flat that rounding tells in which order they
/// follow each other, contacts are not known to be where planes touch.
void bound_turns(SeparatingArc& arc, double tie) {
  Step last{};
  Ruling from = arc.pieces.front().rulings.front();
  for (ArcPiece& piece : arc.pieces) {
    for (const Ruling& to : piece.rulings) {
      const Step step = step_between(from, to);
      const double length = std::sqrt(dot(step, step));
      if (length > tie) {
        const double back = -tie * (length + std::sqrt(dot(last, last)));
        const bool turns = dot(step, last) < back && !goes_on(from, to, tie);
        if (turns) piece.tolerant = std::max(piece.tolerant, tie);
        last = step;
      }
      from = to;
    }
  }
}

}  // namespace

bool is_rounded(const Scene& scene, double resolution) {
  const double floor = scene.frame().length_to_frame(resolution_floor * scene.diagonal());
  const std::vector<Part>& parts = scene.model().parts();
  const bool is_coarse = resolution > rounded_depths * floor;
  return std::any_of(parts.begin(), parts.end(), [&](const Part& p) {
    const double step = scene.frame().length_to_frame(p.coordinate_grid().step);
    return p.cages().empty() && (is_coarse || step > rounded_share * floor);
  });
}

void find_tolerant_places(const ContactSystem& system, SupportQuery& query, HullBoundary& boundary,
                          double resolution) {
  TolerantPlaces found(system, query, resolution);
  for (SeparatingArc& arc : boundary.arcs) {
    for (ArcPiece& piece : arc.pieces) piece.tolerant = found.of(piece);
    bound_joints(arc, system.geometry().tie());
    bound_turns(arc, system.geometry().tie());
  }
  bound_ends(boundary, system.geometry().tie());
  for (HullFace& face : boundary.faces) {
    if (face.kind == FaceKind::facet && !face.contacts.empty()) {
      face.tolerant = std::max(face.tolerant, found.of(face));
    }
    for (const PatchRegion& region : face.regions) {
      face.tolerant = std::max(face.tolerant, found.of(boundary, region));
    }
    if (face.kind != FaceKind::scroll) continue;
    const std::vector<ArcPiece>& pieces = boundary.arcs[std::size_t(face.scroll.arc)].pieces;
    for (int k = 0; k < face.scroll.count; ++k) {
      const std::size_t piece = std::size_t(face.scroll.first + k) % pieces.size();
      face.tolerant = std::max(face.tolerant, pieces[piece].tolerant);
    }
  }
}

}  // namespace taut
