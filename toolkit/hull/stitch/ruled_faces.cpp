#include "taut/hull/stitch/ruled_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

/// Sine of the angle between planes, and distance between ends of segments, that are one: borders
/// of faces that meet are off each other by no more than join_distance.
constexpr double same_ruling = 1e-6;
/// Places of a segment at which it is looked whether it lies in a patch, as shares.
constexpr std::array inside_segment = {0.25, 0.5, 0.75};

int source_of(const ContactGeometry& geometry, const Contact& c) {
  return geometry.scene().model().source_id({SourceKind::face, c.instance, geometry.patch(c).face});
}

/// Whether the patch lies in the facet's plane: as many of its points do as its degrees ask for.
bool is_in_plane(const ContactGeometry& geometry, Contact c, const HullFace& facet) {
  const double allowed = geometry.tie() + geometry.scene().frame().length_to_frame(geometry.bent());
  const BezierPatch& bezier = geometry.patch(c).bezier;
  for (int i = 0; i <= bezier.degree_u; ++i) {
    for (int j = 0; j <= bezier.degree_v; ++j) {
      c.u = double(i) / bezier.degree_u;
      c.v = double(j) / bezier.degree_v;
      if (std::abs(glm::dot(geometry.point(c), facet.n) - facet.offset) > allowed) return false;
    }
  }
  return true;
}

/// Plane patches, which are ruled, on facets.
void label_facets(const ContactGeometry& geometry, HullBoundary& boundary) {
  const Model& model = geometry.scene().model();
  for (const int i : geometry.scene().distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int p = 0; p < int(part.patches().size()); ++p) {
      const Patch& patch = part.patches()[std::size_t(p)];
      if (!geometry.lines(patch).both() && !patch.ruled()) continue;
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

/// A contact of a patch that is on its border, but for rounding, as one of that.
Contact on_border(const ContactGeometry& geometry, const Contact& c) {
  const bool is_inside = c.kind == SourceKind::face;
  return geometry.first(is_inside ? snapped(geometry, c, same_ruling) : geometry.canonical(c));
}

/// Where the contact is on borders of ruled patches: as ones of these.
std::vector<Contact> on_ruled_patches(const ContactGeometry& geometry, const Contact& c) {
  const Contact own = on_border(geometry, c);
  std::vector<Contact> found;
  if (own.kind != SourceKind::edge) return found;
  for (const ContactGeometry::PieceSide& side : geometry.ruled_sides(own)) {
    found.push_back(on_side(own, side));
  }
  return found;
}

/// The segment between two contacts of one patch is, to within rounding, what the patch has between
/// them, with the ruling's normal.
bool is_in_patch(const ContactGeometry& geometry, const Contact& a, const Contact& b,
                 const dvec3& n) {
  if (!same_element(a, b)) return false;
  return std::all_of(inside_segment.begin(), inside_segment.end(), [&](double s) {
    const dvec2 uv = glm::mix(parameters(a), parameters(b), s);
    const Contact c{a.instance, a.kind, a.element, uv.x, uv.y};
    const dvec3 x = glm::mix(geometry.point(a), geometry.point(b), s);
    return glm::distance(geometry.point(c), x) <= same_ruling &&
           glm::length(glm::cross(unit_normal(geometry, c), n)) <= same_ruling;
  });
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

/// The face in which the segment lies: in a patch that has both its ends, or along the rulings of
/// one that has either.
int source_along(const ContactGeometry& geometry, const Ruling& r) {
  const std::array<std::vector<Contact>, 2> ends = {on_ruled_patches(geometry, r.contact[0]),
                                                    on_ruled_patches(geometry, r.contact[1])};
  for (const Contact& a : ends[0]) {
    for (const Contact& b : ends[1]) {
      if (is_in_patch(geometry, a, b, r.n)) return source_of(geometry, a);
    }
  }
  for (const std::size_t end : {0, 1}) {
    for (const Contact& c : ends[end]) {
      const int source = source_along(geometry, c, r, end);
      if (source >= 0) return source;
    }
  }
  return -1;
}

/// A contact is a vertex, beside which any face may be, or where edges meet in a kink, about which
/// n turns.
bool ends_at_joint(const ContactGeometry& geometry, const Ruling& r) {
  return std::any_of(r.contact.begin(), r.contact.end(), [&](const Contact& c) {
    const Contact on = on_border(geometry, c);
    return on.kind == SourceKind::vertex ||
           (on.kind == SourceKind::edge && (on.u == 0 || on.u == 1));
  });
}

/// That of the ruling in the middle, if all between the ends are of some, too.
int source_along(const ContactSystem& system, const ArcPiece& piece) {
  const int source = source_along(system.geometry(), middle_ruling(system, piece));
  if (source < 0) return -1;
  const bool all =
      std::all_of(piece.rulings.begin() + 1, piece.rulings.end() - 1, [&](const Ruling& r) {
        return ends_at_joint(system.geometry(), r) || source_along(system.geometry(), r) >= 0;
      });
  return all ? source : -1;
}

/// It is one ruling, to within a distance.
bool is_short(const ArcPiece& piece, double distance) {
  const Ruling& first = piece.rulings.front();
  return std::all_of(piece.rulings.begin(), piece.rulings.end(), [&](const Ruling& r) {
    return glm::distance(r.point[0], first.point[0]) <= distance &&
           glm::distance(r.point[1], first.point[1]) <= distance;
  });
}

/// The face on which a scroll lies, from its pieces that are not short; none if all are. Contacts
/// that are known to so much only may be one where they go as far as that tells on a surface that
/// curves as the scene is large.
std::optional<int> source_of_scroll(const ContactSystem& system,
                                    const std::vector<const ArcPiece*>& pieces, bool as_known) {
  std::optional<int> own;
  for (const ArcPiece* piece : pieces) {
    const double known = as_known ? std::sqrt(2 * piece->tolerant) : 0;
    if (is_short(*piece, std::max(same_ruling, known))) continue;
    const int source = source_along(system, *piece);
    own = !own || source == *own ? source : -1;
  }
  return own;
}

}  // namespace

void label_ruled_faces(const ContactGeometry& geometry, HullBoundary& boundary) {
  label_facets(geometry, boundary);
  const ContactSystem system(geometry);
  for (HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::scroll) continue;
    const std::vector<ArcPiece>& all = boundary.arcs[std::size_t(face.scroll.arc)].pieces;
    std::vector<const ArcPiece*> pieces;
    pieces.reserve(std::size_t(face.scroll.count));
    for (int k = 0; k < face.scroll.count; ++k) {
      pieces.push_back(&all[std::size_t(face.scroll.first + k) % all.size()]);
    }
    std::optional<int> own = source_of_scroll(system, pieces, true);
    if (!own) own = source_of_scroll(system, pieces, false);
    face.source = own.value_or(-1);
  }
}

}  // namespace taut
