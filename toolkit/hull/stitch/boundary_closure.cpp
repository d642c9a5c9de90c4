#include "taut/hull/stitch/boundary_closure.h"

#include <algorithm>
#include <vector>

#include "taut/core/disjoint_sets.h"
#include "taut/surface/point_grid.h"

namespace taut {
namespace {

bool share_face(const HullCurve& a, const HullCurve& b) {
  return std::any_of(a.faces.begin(), a.faces.end(), [&](int face) {
    return std::find(b.faces.begin(), b.faces.end(), face) != b.faces.end();
  });
}

/// The points in which curves end, as often as the boundary passes them: ends in one place meet if
/// a chain of curves about it leads from the one to the other over faces that they share.
int vertex_count(const HullBoundary& boundary, double distance) {
  struct End {
    const HullCurve* curve;
    dvec3 x;
  };
  std::vector<End> ends;
  Box box;
  for (const HullCurve& c : boundary.curves) {
    if (c.closed) continue;
    for (const dvec3& p : {c.points.front(), c.points.back()}) {
      ends.push_back({&c, p});
      box.include(p);
    }
  }
  PointGrid places(box, distance);
  DisjointSets vertices(ends.size());
  for (int k = 0; k < int(ends.size()); ++k) {
    const End& own = ends[std::size_t(k)];
    places.visit_near(own.x, [&](int other) {
      const End& there = ends[std::size_t(other)];
      if (own.curve != there.curve && share_face(*own.curve, *there.curve)) {
        vertices.unite(k, other);
      }
    });
    places.insert(own.x, k);
  }
  int count = 0;
  for (int k = 0; k < int(ends.size()); ++k) count += vertices.find(k) == k ? 1 : 0;
  return count;
}

/// Of a face by itself. A closed scroll is an annulus, unless it is a cone.
int face_characteristic(const HullBoundary& boundary, const HullFace& face) {
  if (face.kind == FaceKind::patch) return 2 - int(face.loops.size());
  if (face.kind == FaceKind::facet) return 1;
  const SeparatingArc& arc = boundary.arcs[std::size_t(face.scroll.arc)];
  const std::array<Contact, 2>& contacts = arc.pieces.front().rulings.front().contact;
  const bool closed = arc.closed && face.scroll.count == int(arc.pieces.size());
  const bool cone = std::any_of(contacts.begin(), contacts.end(),
                                [](const Contact& c) { return c.kind == SourceKind::vertex; });
  return closed && !cone ? 0 : 1;
}

/// V - E + F, where a face counts as its own Euler characteristic.
int euler_characteristic(const HullBoundary& boundary, double distance) {
  int result = vertex_count(boundary, distance);
  for (const HullCurve& c : boundary.curves) result -= c.closed ? 0 : 1;
  for (const HullFace& face : boundary.faces) result += face_characteristic(boundary, face);
  return result;
}

/// Its corners run clockwise about its normal, by more than corners moved by so much make of it.
bool is_inside_out(const HullFace& facet, double distance) {
  double doubled = 0, perimeter = 0;
  for (std::size_t k = 0; k < facet.points.size(); ++k) {
    const dvec3& a = facet.points[k];
    const dvec3& b = facet.points[(k + 1) % facet.points.size()];
    doubled += glm::dot(glm::cross(a - facet.points[0], b - facet.points[0]), facet.n);
    perimeter += glm::distance(a, b);
  }
  return doubled < -distance * perimeter;
}

/// It is no more than a segment: none of its sides is curved and it has but two corners.
bool is_segment(const HullFace& facet) {
  return facet.points.size() < 3 &&
         std::none_of(facet.sides.begin(), facet.sides.end(),
                      [](const EdgeStretch& side) { return side.piece >= 0; });
}

}  // namespace

void check_closure(HullBoundary& boundary, double distance) {
  for (const HullCurve& c : boundary.curves) {
    if (c.faces[0] < 0 || c.faces[1] < 0) {
      boundary.unresolved.push_back({unit(c.points.front()), "a curve has no two faces"});
    }
  }
  for (const HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::facet) continue;
    if (is_segment(face)) boundary.unresolved.push_back({face.n, "a facet is but a segment"});
    if (is_inside_out(face, distance)) {
      boundary.unresolved.push_back({face.n, "a facet is turned inside out"});
    }
  }
  if (boundary.unresolved.empty() && euler_characteristic(boundary, distance) != 2) {
    boundary.unresolved.push_back(
        {dvec3(0.0), "the faces that were found do not close to a sphere"});
  }
}

}  // namespace taut
