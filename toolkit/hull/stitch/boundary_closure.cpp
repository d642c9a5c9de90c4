#include "taut/hull/stitch/boundary_closure.h"

#include <algorithm>
#include <vector>

#include "taut/hull/stitch/curve_chains.h"
#include "taut/surface/point_grid.h"

namespace taut {
namespace {

/// The points in which curves end.
int vertex_count(const HullBoundary& boundary) {
  std::vector<dvec3> ends;
  Box box;
  for (const HullCurve& c : boundary.curves) {
    if (c.closed) continue;
    for (const dvec3& p : {c.points.front(), c.points.back()}) {
      ends.push_back(p);
      box.include(p);
    }
  }
  PointGrid vertices(box, same_curve_end);
  int count = 0;
  for (const dvec3& p : ends) {
    bool known = false;
    vertices.visit_near(p, [&](int) { known = true; });
    if (!known) vertices.insert(p, count++);
  }
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
int euler_characteristic(const HullBoundary& boundary) {
  int result = vertex_count(boundary);
  for (const HullCurve& c : boundary.curves) result -= c.closed ? 0 : 1;
  for (const HullFace& face : boundary.faces) result += face_characteristic(boundary, face);
  return result;
}

}  // namespace

void check_closure(HullBoundary& boundary) {
  for (const HullCurve& c : boundary.curves) {
    if (c.faces[0] < 0 || c.faces[1] < 0) {
      boundary.unresolved.push_back({unit(c.points.front()), "a curve has no two faces"});
    }
  }
  if (boundary.unresolved.empty() && euler_characteristic(boundary) != 2) {
    boundary.unresolved.push_back(
        {dvec3(0.0), "the faces that were found do not close to a sphere"});
  }
}

}  // namespace taut
