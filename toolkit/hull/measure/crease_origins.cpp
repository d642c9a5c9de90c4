#include "taut/hull/measure/crease_origins.h"

#include <algorithm>

#include "taut/core/geometry.h"

namespace taut {
namespace {

/// How far behind a piece, in the scene's frame, which is as large as the model.
constexpr double far_behind = 4;
/// Least cosine between a normal and the direction to where it is.
constexpr double least_cosine = 0.2;

}  // namespace

CreaseOrigins::CreaseOrigins(const ContactGeometry& geometry, const HullBoundary& boundary,
                             const dvec3& inside)
    : geometry_(geometry), inside_(inside) {
  add_arcs(boundary);
  for (const HullFace& face : boundary.faces) add_face(face);
  for (auto& [key, piece] : pieces_) {
    piece.origin = origin_of(piece.seen);
    piece.seen.clear();
  }
}

const dvec3& CreaseOrigins::of(const Contact& c) const {
  const auto piece = pieces_.find(key(c));
  return piece == pieces_.end() ? inside_ : piece->second.origin;
}

const dvec3& CreaseOrigins::of(const PatchRegion& region, Side side) const {
  return of(on_edge(region, side));
}

/// That of the first of the pieces that coincide.
CreaseOrigins::Key CreaseOrigins::key(const Contact& c) const {
  const Contact first = geometry_.first(c);
  return {first.instance, first.element};
}

Contact CreaseOrigins::on_edge(const PatchRegion& region, Side side) const {
  const Contact face{region.instance, SourceKind::face, region.patch, 0, 0};
  const int piece = geometry_.patch(face).borders[std::size_t(side)].piece;
  return {region.instance, SourceKind::edge, piece, 0.5, 0};
}

void CreaseOrigins::add_arcs(const HullBoundary& boundary) {
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& r : piece.rulings) {
        for (const std::size_t i : {0u, 1u}) {
          if (r.contact[i].kind == SourceKind::edge) add(r.contact[i], r.point[i], r.n);
        }
      }
    }
  }
}

void CreaseOrigins::add_face(const HullFace& face) {
  for (const EdgeStretch& side : face.sides) {
    if (side.piece < 0) continue;
    for (const double s : {0.0, 0.5, 1.0}) {
      const Contact c = side.at(Interval{side.from, side.to}.at(s));
      add(c, geometry_.point(c), face.n);
    }
  }
  for (const PatchRegion& region : face.regions) {
    for (const std::vector<TrimStretch>& loop : region.loops) {
      for (const TrimStretch& stretch : loop) {
        if (stretch.arc >= 0 || on_edge(region, stretch.side).element < 0) continue;
        for (const double s : {0.0, 0.5, 1.0}) {
          const dvec2 uv = on_side(stretch.side, Interval{stretch.from, stretch.to}.at(s));
          const ContactJet j =
              geometry_.jet({region.instance, SourceKind::face, region.patch, uv.x, uv.y});
          const dvec3 n = double(region.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
          add(on_edge(region, stretch.side), j.x, n);
        }
      }
    }
  }
}

dvec3 CreaseOrigins::origin_of(const std::vector<Seen>& seen) const {
  dvec3 x(0.0);
  dvec3 n(0.0);
  for (const Seen& s : seen) {
    x += s.x / double(seen.size());
    n += s.n;
  }
  const dvec3 origin = x - far_behind * unit(n);
  const bool is_below = std::all_of(seen.begin(), seen.end(), [&](const Seen& s) {
    return glm::dot(s.n, unit(s.x - origin)) >= least_cosine;
  });
  return is_below ? origin : inside_;
}

}  // namespace taut
