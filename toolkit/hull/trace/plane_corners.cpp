#include "taut/hull/trace/plane_corners.h"

#include <cmath>
#include <optional>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {
namespace {

/// So far from the corner, in the scene's frame, heights are less than tie(): they fall with the
/// cube of the distance.
constexpr double tied_distance = 1e-5;

/// At a vertex in which an edge ends, or on one; seams are no edges.
bool is_at_edge(const ContactGeometry& geometry, const Contact& corner) {
  const Contact c = geometry.canonical(corner);
  if (c.kind != SourceKind::vertex) return c.kind == SourceKind::edge;
  const Part& part = geometry.part(c);
  return c.element < int(part.vertices().size()) - part.seam_vertex_count();
}

std::optional<Contact> plane_corner_at(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::face) return std::nullopt;
  const dvec3 x = geometry.point(c);
  for (const Contact& corner : corners_of(c)) {
    if (glm::distance(geometry.point(corner), x) <= tied_distance &&
        is_plane_corner(geometry, corner)) {
      return corner;
    }
  }
  return std::nullopt;
}

}  // namespace

std::array<Contact, 4> corners_of(Contact c) {
  std::array<Contact, 4> result;
  for (std::size_t k = 0; k < 4; ++k) {
    c.u = k % 2 == 0 ? 0 : 1;
    c.v = k < 2 ? 0 : 1;
    result[k] = c;
  }
  return result;
}

bool is_plane_corner(const ContactGeometry& geometry, const Contact& corner) {
  if (is_at_edge(geometry, corner)) return false;
  const dvec3 n = unit_normal(geometry, corner);
  if (n == dvec3(0.0)) return false;
  const ContactJet j = geometry.jet(corner);
  const double uu = glm::dot(j.dx[0], j.dx[0]);
  const double vv = glm::dot(j.dx[1], j.dx[1]);
  return std::abs(glm::dot(j.dxx, n)) <= least_curvature * uu &&
         std::abs(glm::dot(j.dxy, n)) <= least_curvature * std::sqrt(uu * vv) &&
         std::abs(glm::dot(j.dyy, n)) <= least_curvature * vv;
}

CommonSupport settled_in_plane_corners(const ContactGeometry& geometry, SupportQuery& query,
                                       const CommonSupport& s) {
  CommonSupport settled = s;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> corner = plane_corner_at(geometry, s.contact[i]);
    if (!corner) continue;
    settled.contact[i] = *corner;
    settled.n = aligned(unit_normal(geometry, *corner), s.n);
  }
  settled.evaluate(geometry);
  const bool supports = query(settled.n, settled.contact[0]).h <=
                        glm::dot(settled.jet[0].x, settled.n) + geometry.tie();
  const bool is_common = std::abs(glm::dot(settled.d(), settled.n)) <= geometry.tie();
  return supports && is_common ? settled : s;
}

}  // namespace taut
