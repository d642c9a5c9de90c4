#include "taut/hull/stitch/boundary_closure.h"

#include <algorithm>
#include <map>
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
class CurveEnds {
 public:
  CurveEnds(const HullBoundary& boundary, double distance) : vertices_(2 * boundary.curves.size()) {
    Box box;
    for (const HullCurve& c : boundary.curves) {
      for (const dvec3& p : {c.points.front(), c.points.back()}) box.include(p);
    }
    PointGrid places(box, distance);
    for (int k = 0; k < int(2 * boundary.curves.size()); ++k) {
      const HullCurve& own = boundary.curves[std::size_t(k / 2)];
      if (own.closed) continue;
      const dvec3& x = k % 2 == 0 ? own.points.front() : own.points.back();
      places.visit_near(x, [&](int other) {
        const bool meets = share_face(own, boundary.curves[std::size_t(other / 2)]);
        if (meets && k / 2 != other / 2) vertices_.unite(k, other);
      });
      places.insert(x, k);
    }
    for (int k = 0; k < int(2 * boundary.curves.size()); ++k) {
      const bool ends = !boundary.curves[std::size_t(k / 2)].closed;
      count_ += ends && vertices_.find(k) == k ? 1 : 0;
    }
  }

  /// In which a curve begins (0) or ends (1).
  int vertex(int curve, int end) { return vertices_.find(2 * curve + end); }
  int count() const { return count_; }

 private:
  DisjointSets vertices_;
  int count_ = 0;
};

/// As many curves of a face begin in a vertex as end there, with the face to their left; and where
/// there are curves, each face has some.
bool faces_close(const HullBoundary& boundary, CurveEnds& ends) {
  std::vector<std::map<int, int>> balance(boundary.faces.size());
  std::vector<bool> has_any(boundary.faces.size(), boundary.curves.empty());
  for (int c = 0; c < int(boundary.curves.size()); ++c) {
    for (const int side : {0, 1}) {
      const auto face = std::size_t(boundary.curves[std::size_t(c)].faces[std::size_t(side)]);
      has_any[face] = true;
      if (boundary.curves[std::size_t(c)].closed) continue;
      ++balance[face][ends.vertex(c, side)];
      --balance[face][ends.vertex(c, 1 - side)];
    }
  }
  return std::all_of(has_any.begin(), has_any.end(), [](bool any) { return any; }) &&
         std::all_of(balance.begin(), balance.end(), [](const std::map<int, int>& at) {
           return std::all_of(at.begin(), at.end(), [](const auto& b) { return b.second == 0; });
         });
}

/// Curves lead from each face to all others.
bool is_connected(const HullBoundary& boundary) {
  DisjointSets faces(boundary.faces.size());
  for (const HullCurve& c : boundary.curves) faces.unite(c.faces[0], c.faces[1]);
  for (int k = 1; k < int(boundary.faces.size()); ++k) {
    if (faces.find(k) != faces.find(0)) return false;
  }
  return true;
}

/// Of a face by itself. A closed scroll is an annulus, unless it is a cone.
int face_characteristic(const HullBoundary& boundary, const HullFace& face) {
  if (face.kind == FaceKind::patch) return 2 - int(face.loops.size());
  if (face.kind == FaceKind::facet) return 1;
  const std::vector<ArcPiece>& pieces = boundary.arcs[std::size_t(face.scroll.arc)].pieces;
  const bool closed =
      boundary.arcs[std::size_t(face.scroll.arc)].closed && face.scroll.count == int(pieces.size());
  const auto is_apex = [&](std::size_t i) {
    return std::all_of(pieces.begin(), pieces.end(), [&](const ArcPiece& piece) {
      return piece.rulings.front().contact[i].kind == SourceKind::vertex;
    });
  };
  const bool cone = is_apex(0) || is_apex(1);
  return closed && !cone ? 0 : 1;
}

/// V - E + F, where a face counts as its own Euler characteristic.
int euler_characteristic(const HullBoundary& boundary, const CurveEnds& ends) {
  int result = ends.count();
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
  if (!boundary.unresolved.empty()) return;
  CurveEnds ends(boundary, distance);
  if (!faces_close(boundary, ends)) {
    boundary.unresolved.push_back({dvec3(0.0), "curves of a face do not close up"});
  } else if (!is_connected(boundary) || euler_characteristic(boundary, ends) != 2) {
    boundary.unresolved.push_back(
        {dvec3(0.0), "the faces that were found do not close to a sphere"});
  }
}

}  // namespace taut
