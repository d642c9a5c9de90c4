#include "taut/hull/stitch/ruled_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

/// Sine of the angle between planes, and distance between ends of segments, that are one: borders
/// of faces that meet are off each other by no more than join_distance.
constexpr double same_ruling = 1e-6;

int source_of(const ContactGeometry& geometry, const Contact& c) {
  return geometry.scene().model().source_id({SourceKind::face, c.instance, geometry.patch(c).face});
}

/// Whether the corners and the middle of the patch lie in the facet's plane.
bool is_in_plane(const ContactGeometry& geometry, Contact c, const HullFace& facet) {
  const double allowed = geometry.tie() + geometry.scene().frame().length_to_frame(geometry.bent());
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      c.u = u;
      c.v = v;
      if (std::abs(glm::dot(geometry.point(c), facet.n) - facet.offset) > allowed) return false;
    }
  }
  return true;
}

/// Plane patches, those that are ruled in both parameters, on facets.
void label_facets(const ContactGeometry& geometry, HullBoundary& boundary) {
  const Model& model = geometry.scene().model();
  for (const int i : geometry.scene().distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int p = 0; p < int(part.patches().size()); ++p) {
      const Patch& patch = part.patches()[std::size_t(p)];
      if (!geometry.lines(patch).both()) continue;
      const Contact c{i, SourceKind::face, p, 0, 0};
      for (HullFace& face : boundary.faces) {
        if (face.kind != FaceKind::facet || face.source >= 0) continue;
        if (is_in_plane(geometry, c, face)) face.source = source_of(geometry, c);
      }
    }
  }
}

/// The face whose rulings from the contact on, from one patch to the next, make up the whole of the
/// segment, in the ruling's supporting plane. -1: it is not one face, or none.
int source_along(const ContactGeometry& geometry, const Contact& c, const Ruling& r,
                 std::size_t end) {
  const dvec3 normal = unit_normal(geometry, c);
  if (glm::length(glm::cross(normal, r.n)) > same_ruling) return -1;
  const dvec3 along = geometry.to_local(c.instance, unit(r.point[1 - end] - r.point[end]));
  const std::vector<PatchPoint> path =
      ruling_path(geometry.part(c), {c.element, {c.u, c.v}}, along, geometry.bent());
  if (path.empty()) return -1;
  const auto contact = [&](const PatchPoint& p) {
    return Contact{c.instance, c.kind, p.patch, p.uv.x, p.uv.y};
  };
  const dvec3 reached = geometry.point(contact(path.back()));
  if (glm::distance(reached, r.point[1 - end]) > same_ruling) return -1;
  const int source = source_of(geometry, c);
  const bool one = std::all_of(path.begin(), path.end(), [&](const PatchPoint& p) {
    return source_of(geometry, contact(p)) == source;
  });
  return one ? source : -1;
}

/// The face, of those that end where the segment begins, whose rulings make up the segment.
int source_along(const ContactGeometry& geometry, const Ruling& r, std::size_t end) {
  const Contact c = geometry.first(geometry.canonical(r.contact[end]));
  if (c.kind != SourceKind::edge) return -1;
  for (const ContactGeometry::PieceSide& side : geometry.ruled_sides(c)) {
    const dvec2 uv = on_side(side.side, side.reversed ? 1 - c.u : c.u);
    const int instance = side.instance < 0 ? c.instance : side.instance;
    const Contact own{instance, SourceKind::face, side.patch, uv.x, uv.y};
    const int source = source_along(geometry, own, r, end);
    if (source >= 0) return source;
  }
  return -1;
}

/// Inside of the piece, also where that has no more than the rulings at its ends.
Ruling middle_ruling(const ContactSystem& system, const ArcPiece& piece) {
  const std::size_t middle = piece.rulings.size() / 2;
  const Ruling& r = piece.rulings[middle];
  if (piece.rulings.size() != 2) return r;
  const RulingsBetween between(system, piece.rulings.front(), piece.rulings.back());
  const std::optional<MovingRuling> m = between(between.at_share(0.5));
  return m ? m->at.ruling() : r;
}

int source_along(const ContactGeometry& geometry, const Ruling& r) {
  const int source = source_along(geometry, r, 0);
  return source >= 0 ? source : source_along(geometry, r, 1);
}

/// That of the ruling in the middle, if those halfway from there to the ends are of some, too.
int source_along(const ContactSystem& system, const ArcPiece& piece) {
  const int source = source_along(system.geometry(), middle_ruling(system, piece));
  const std::size_t last = piece.rulings.size() - 1;
  for (const std::size_t k : {last / 4, last - last / 4}) {
    const bool is_inside = 0 < k && k < last;
    if (is_inside && source >= 0 && source_along(system.geometry(), piece.rulings[k]) < 0) {
      return -1;
    }
  }
  return source;
}

/// It is one ruling for all that labels tell.
bool is_short(const ArcPiece& piece) {
  const Ruling& first = piece.rulings.front();
  return std::all_of(piece.rulings.begin(), piece.rulings.end(), [&](const Ruling& r) {
    return glm::distance(r.point[0], first.point[0]) <= same_ruling &&
           glm::distance(r.point[1], first.point[1]) <= same_ruling;
  });
}

}  // namespace

void label_ruled_faces(const ContactGeometry& geometry, HullBoundary& boundary) {
  label_facets(geometry, boundary);
  const ContactSystem system(geometry);
  for (HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::scroll) continue;
    const std::vector<ArcPiece>& pieces = boundary.arcs[std::size_t(face.scroll.arc)].pieces;
    std::optional<int> own;
    for (int k = 0; k < face.scroll.count; ++k) {
      const ArcPiece& piece = pieces[std::size_t(face.scroll.first + k) % pieces.size()];
      if (is_short(piece)) continue;
      const int source = source_along(system, piece);
      own = !own || source == *own ? source : -1;
    }
    face.source = own.value_or(-1);
  }
}

}  // namespace taut
