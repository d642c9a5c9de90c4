#include "taut/hull/solve/tolerant_places.h"

#include <algorithm>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/result/region_outline.h"

namespace taut {
namespace {

/// Parts of a facet's curved side, and of the way between two rulings, at whose ends it is looked.
constexpr int side_places = 8;
constexpr int ruling_places = 8;
/// How many times the resolution of exact models that is that rounding makes of a model's numbers.
constexpr double rounded_depths = 2;
/// How many times deeper it may be between two places than in the deepest one.
constexpr double between_places = 1.25;
/// Places of a region at which it is looked, along each of the patch's parameters.
constexpr int region_places = 3;
/// How many slacks of its outline a place is inside: rulings may be few.
constexpr double region_slacks = 2;

class TolerantPlaces {
 public:
  TolerantPlaces(const ContactSystem& system, SupportQuery& query, double resolution)
      : system_(system), geometry_(system.geometry()), query_(query), resolution_(resolution) {
    is_rounded_ = is_rounded(geometry_.scene(), resolution_);
  }

  double of(const ArcPiece& piece) {
    double deepest = piece.tolerant;
    for (const Ruling& r : piece.rulings) deepest = std::max(deepest, depth(r));
    if (!is_rounded_ && piece.tolerant == 0 && deepest <= geometry_.tie()) return 0;
    for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
      const RulingsBetween between(system_, piece.rulings[k - 1], piece.rulings[k]);
      if (between.empty()) continue;
      for (int place = 1; place < ruling_places; ++place) {
        const double s = between.at_share(double(place) / ruling_places);
        const std::optional<MovingRuling> exact = between(s);
        // Where none is found, what there is has no depth that could be looked at.
        deepest = std::max(deepest, exact ? depth(exact->at.ruling()) : resolution_);
      }
    }
    return deepest <= geometry_.tie() ? 0 : bound_of(deepest);
  }

  double of(const HullFace& facet) {
    const double h = query_(facet.n, facet.contacts.front()).h;
    double deepest = 0;
    const auto look = [&](const dvec3& x) {
      deepest = std::max(deepest, h - glm::dot(x, facet.n));
    };
    for (const dvec3& x : facet.points) look(x);
    for (const EdgeStretch& side : facet.sides) {
      if (side.piece < 0) continue;
      for (int k = 1; k < side_places; ++k) {
        const double t = glm::mix(side.from, side.to, double(k) / side_places);
        look(geometry_.point(side.at(t)));
      }
    }
    return deepest <= geometry_.tie() ? 0 : deepest;
  }

  /// Places as near to the outline as that may be off are as deep as the arcs there.
  double of(const HullBoundary& boundary, const PatchRegion& region) {
    const RegionOutline outline = outline_of(boundary, region);
    double deepest = 0;
    for (int k = 0; k < region_places * region_places; ++k) {
      const dvec2 uv = (dvec2(k % region_places, k / region_places) + 0.5) / double(region_places);
      if (depth_in(outline, uv) < region_slacks * outline_slack) continue;
      deepest = std::max(deepest, own_depth(region, uv));
    }
    deepest = deepest <= geometry_.tie() ? 0 : bound_of(deepest);
    for (const std::vector<TrimStretch>& loop : region.loops) {
      for (const TrimStretch& s : loop) {
        if (s.arc >= 0) deepest = std::max(deepest, piece_of(boundary, s).tolerant);
      }
    }
    return deepest;
  }

 private:
  static const ArcPiece& piece_of(const HullBoundary& boundary, const TrimStretch& s) {
    return boundary.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)];
  }

  /// Of the patch by its own normal.
  double own_depth(const PatchRegion& region, const dvec2& uv) {
    const Contact c{region.instance, SourceKind::face, region.patch, uv.x, uv.y};
    const ContactJet j = geometry_.jet(c);
    const dvec3 n = double(region.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
    return n == dvec3(0.0) ? 0 : query_(n, c).h - glm::dot(j.x, n);
  }

  /// Between the places it may be deeper, as far as that is within the resolution.
  double bound_of(double deepest) const {
    return std::max(deepest, std::min(between_places * deepest, resolution_));
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

bool is_rounded(const Scene& scene, double resolution) {
  const double floor = scene.frame().length_to_frame(resolution_floor * scene.diagonal());
  return resolution > rounded_depths * floor;
}

void find_tolerant_places(const ContactSystem& system, SupportQuery& query, HullBoundary& boundary,
                          double resolution) {
  TolerantPlaces places(system, query, resolution);
  for (SeparatingArc& arc : boundary.arcs) {
    for (ArcPiece& piece : arc.pieces) piece.tolerant = places.of(piece);
  }
  for (HullFace& face : boundary.faces) {
    if (face.kind == FaceKind::facet && !face.contacts.empty()) face.tolerant = places.of(face);
    for (const PatchRegion& region : face.regions) {
      face.tolerant = std::max(face.tolerant, places.of(boundary, region));
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
