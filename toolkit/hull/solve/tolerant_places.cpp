#include "taut/hull/solve/tolerant_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/solve/depth_bounds.h"
#include "taut/hull/solve/joint_bounds.h"
#include "taut/hull/solve/region_depths.h"

namespace taut {
namespace {

/// Parts of a facet's curved side, and of the way between two rulings, at whose ends it is looked.
constexpr int places = 8;
/// Further places, beside the ends: where one of these is moved off the curve that leads there, it
/// is passed just before.
constexpr std::array<double, 2> beside_ends = {1.0 / 128, 127.0 / 128};
/// How many times the resolution of exact models that is that rounding makes of a model's numbers.
constexpr double rounded_depths = 2;
/// Up to which share of that the grid of its numbers does not tell.
constexpr double rounded_share = 1.0 / 16;

class TolerantPlaces {
 public:
  TolerantPlaces(const ContactSystem& system, SupportQuery& query, const DepthBounds& bounds)
      : system_(system),
        geometry_(system.geometry()),
        query_(query),
        bounds_(bounds),
        is_rounded_(is_rounded(geometry_.scene(), bounds.resolution())) {}

  double of(const ArcPiece& piece) {
    double deepest = piece.tolerant;
    bool touches = true;
    for (const Ruling& r : piece.rulings) {
      deepest = std::max(deepest, depth(r, deepest));
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
      if (between.empty() || (is_exact && depth_at(between, 0.5, 0) <= geometry_.tie())) continue;
      deepest = std::max(deepest, deepest_of(between));
    }
    return std::max(bounds_.elsewhere(deepest, touches), std::min(passed, bounds_.resolution()));
  }

  double of(const HullFace& facet) {
    const double h = query_(facet.n, facet.contacts.front()).highest();
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
      const auto depth_at = [&](double share, double) {
        return depth_of(geometry_.point(side.at(glm::mix(side.from, side.to, share))));
      };
      of_sides = std::max(of_sides, deepest_along(depth_at));
      const std::size_t next = (k + 1) % facet.points.size();
      deepest = std::max({deepest, off(side.at(side.from), facet.points[k]),
                          off(side.at(side.to), facet.points[next])});
    }
    return bounds_.known(std::max(deepest, DepthBounds::near_places * of_sides), touches);
  }

 private:
  /// Of exact rulings; where none is found, of the one that is interpolated, the resolution at
  /// least: what there is may be deeper beside it.
  double depth_at(const RulingsBetween& between, double share, double least) {
    const double s = between.at_share(share);
    if (const std::optional<MovingRuling> exact = between(s)) {
      return depth(exact->at.ruling(), least);
    }
    return std::max(bounds_.resolution() / DepthBounds::near_places,
                    depth(between.interpolated(s).at.ruling(), least));
  }
  double deepest_of(const RulingsBetween& between) {
    return deepest_along(
        [&](double share, double least) { return depth_at(between, share, least); });
  }

  /// Between 0 and 1; about the deepest place it is looked closer. Less deep than the second
  /// argument of `depth_at` need not be told.
  template <class DepthAt>
  double deepest_along(const DepthAt& depth_at) const {
    double deepest = 0, at = 0.5, step = 1.0 / places;
    const auto look = [&](double share) {
      if (!(0 < share && share < 1)) return;
      const double found = depth_at(share, deepest);
      if (found > deepest) at = share;
      deepest = std::max(deepest, found);
    };
    for (int place = 1; place < places; ++place) look(double(place) / places);
    for (const double share : beside_ends) look(share);
    if (deepest <= geometry_.tie()) return deepest;
    for (int k = 0; k < DepthBounds::closer_looks; ++k) {
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
      if (system_.solve(s, stays)) deepest = std::max(deepest, depth(s.ruling(), deepest));
    }
    return deepest;
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
        if (speed > bounds_.resolution()) {
          changed += bounds_.resolution() / speed * std::abs(glm::dot(ddx[k][i], n));
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

  /// Of the lower contact, if that is deeper than `least` and the tie; else no more than these.
  double depth(const Ruling& r, double least) {
    const double lower = std::min(glm::dot(r.point[0], r.n), glm::dot(r.point[1], r.n));
    const double told = std::max(least, geometry_.tie());
    const double h = query_.highest_above(lower + told, r.n, r.contact[0]);
    return h > lower + told ? h - lower : 0;
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DepthBounds& bounds_;
  bool is_rounded_;
};

/// What it takes to look at a region: as much as at so many rulings, about.
constexpr double region_work = 4;

/// What it takes to look at all rulings and regions.
double work_of_places(const HullBoundary& boundary) {
  double work = 0;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) work += double(piece.rulings.size());
  }
  for (const HullFace& face : boundary.faces) work += region_work * double(face.regions.size());
  return work;
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
                          double resolution, const Progress& progress) {
  WorkProgress share(progress, "stitch", work_of_places(boundary));
  const DepthBounds bounds(system.geometry().tie(), resolution);
  TolerantPlaces found(system, query, bounds);
  RegionDepths regions(system, query, bounds);
  for (SeparatingArc& arc : boundary.arcs) {
    for (ArcPiece& piece : arc.pieces) {
      piece.tolerant = found.of(piece);
      share.add(double(piece.rulings.size()));
    }
  }
  bound_joints(boundary, system.geometry().tie());
  for (HullFace& face : boundary.faces) {
    if (face.kind == FaceKind::facet && !face.contacts.empty()) {
      face.tolerant = std::max(face.tolerant, found.of(face));
    }
    for (const PatchRegion& region : face.regions) {
      face.tolerant = std::max(face.tolerant, regions.of(boundary, region));
      share.add(region_work);
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
