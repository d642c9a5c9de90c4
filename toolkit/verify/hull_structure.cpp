#include "taut/verify/hull_structure.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "taut/core/disjoint_sets.h"
#include "taut/core/integers.h"
#include "taut/verify/stated_bounds.h"

namespace taut {
namespace {

using DirectedCurve = HullDocument::DirectedCurve;

/// Normals of a closed scroll's first and last ruling, which are one, differ by rounding only.
constexpr double same_direction = 1e-9;

/// The ends of all curves, numbered by place.
class CurveEnds {
 public:
  CurveEnds(const HullDocument& hull, double tolerance);
  /// The vertex in which the curve begins (0) or ends (1).
  int vertex(int curve, int end) const { return vertex_[2 * to_size(curve) + to_size(end)]; }
  /// Begin and end are one vertex, and that is all there is of it, to within its bound.
  bool is_point(int curve) const { return point_[to_size(curve)]; }

 private:
  std::vector<int> vertex_;
  std::vector<bool> point_;
};

CurveEnds::CurveEnds(const HullDocument& hull, double tolerance) {
  std::vector<dvec3> ends;
  std::vector<double> reach;  // how far ends of others that are one with them may be, both together
  double farthest = 0;
  for (const HullDocument::Curve& curve : hull.curves) {
    ends.push_back(curve.points.front());
    ends.push_back(curve.points.back());
    reach.insert(reach.end(), 2, 0.5 * tolerance + bound_of(hull, curve));
    farthest = std::max(farthest, reach.back());
  }
  // Ends of two curves that no face brings together are two, be they in one place: where parts of
  // the boundary touch in a point, between facets without area.
  const auto together = [&](std::size_t a, std::size_t b) {
    const HullDocument::Curve& one = hull.curves[a / 2];
    const HullDocument::Curve& other = hull.curves[b / 2];
    return a / 2 == b / 2 || std::any_of(one.faces.begin(), one.faces.end(), [&](int f) {
             return f >= 0 && (f == other.faces[0] || f == other.faces[1]);
           });
  };
  // Sweeps along x.
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return ends[a].x != ends[b].x ? ends[a].x < ends[b].x : a < b;
  });
  DisjointSets vertices(ends.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t a = order[i];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const std::size_t b = order[k];
      if (ends[b].x - ends[a].x > reach[a] + farthest) break;
      const double near = a / 2 == b / 2 ? tolerance : reach[a] + reach[b];
      if (glm::distance(ends[a], ends[b]) <= near && together(a, b)) vertices.unite(int(a), int(b));
    }
  }
  for (int i = 0; i < int(ends.size()); ++i) vertex_.push_back(vertices.find(i));
  for (int c = 0; c < int(hull.curves.size()); ++c) {
    const std::vector<dvec3>& points = hull.curves[to_size(c)].points;
    const double near = std::max(tolerance, 2 * reach[2 * to_size(c)]);
    point_.push_back(vertex(c, 0) == vertex(c, 1) &&
                     std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
                       return glm::distance(p, points.front()) <= near;
                     }));
  }
}

/// Checks one document.
class Structure {
 public:
  Structure(const HullDocument& hull, double tolerance);
  HullStructure check() const;

 private:
  bool closes(int face) const;
  bool names_its_curves(int face) const;
  int euler() const;
  int characteristic(const HullDocument::Face& face) const;

  const HullDocument& hull_;
  double tolerance_;
  CurveEnds ends_;
  std::vector<std::vector<DirectedCurve>> curves_of_;  ///< per face, with it to the left
};

Structure::Structure(const HullDocument& hull, double tolerance)
    : hull_(hull), tolerance_(tolerance), ends_(hull, tolerance), curves_of_(hull.faces.size()) {
  for (std::size_t i = 0; i < hull.curves.size(); ++i) {
    const auto [left, right] = hull.curves[i].faces;
    if (left >= 0) curves_of_[to_size(left)].emplace_back(int(i), 1);
    if (right >= 0) curves_of_[to_size(right)].emplace_back(int(i), -1);
  }
}

HullStructure Structure::check() const {
  HullStructure result;
  const bool is_planar = hull_.dimension == 2;
  result.complete = !hull_.faces.empty() && (!is_planar || hull_.faces.size() == 1);
  for (const HullDocument::Curve& curve : hull_.curves) {
    if (curve.faces[0] < 0 || (curve.faces[1] < 0) != is_planar) result.complete = false;
  }
  result.closed = true;
  for (int f = 0; f < int(hull_.faces.size()); ++f) {
    if (!closes(f) || !names_its_curves(f)) result.closed = false;
  }
  result.euler = euler();
  return result;
}

/// As many of a face's curves begin in a vertex as end there.
bool Structure::closes(int face) const {
  std::map<int, int> balance;
  for (const auto& [curve, sense] : curves_of_[to_size(face)]) {
    balance[ends_.vertex(curve, 0)] += sense;
    balance[ends_.vertex(curve, 1)] -= sense;
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& b) { return b.second == 0; });
}

/// The curves that a face names as its outlines or sides are those that have it as a face.
bool Structure::names_its_curves(int f) const {
  const HullDocument::Face& face = hull_.faces[to_size(f)];
  std::vector<DirectedCurve> having = curves_of_[to_size(f)];
  if (face.kind == FaceKind::scroll) {
    // Its sides, each of which has it, and perhaps rulings at its ends.
    std::vector<int> sides = face.curves[0];
    sides.insert(sides.end(), face.curves[1].begin(), face.curves[1].end());
    const auto is_side = [&](int c) {
      return std::find(sides.begin(), sides.end(), c) != sides.end();
    };
    const auto has = [&](int c) {
      return std::any_of(having.begin(), having.end(), [&](const auto& d) { return d.first == c; });
    };
    return std::all_of(sides.begin(), sides.end(), has) &&
           std::all_of(having.begin(), having.end(), [&](const DirectedCurve& d) {
             return is_side(d.first) ||
                    hull_.curves[to_size(d.first)].kind == HullCurveKind::ruling;
           });
  }
  std::vector<DirectedCurve> named;
  const auto runs_on = [&](const std::vector<DirectedCurve>& outline) {
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const DirectedCurve& now = outline[k];
      const DirectedCurve& next = outline[(k + 1) % outline.size()];
      if (ends_.vertex(now.first, now.second > 0 ? 1 : 0) !=
          ends_.vertex(next.first, next.second > 0 ? 0 : 1)) {
        return false;
      }
    }
    named.insert(named.end(), outline.begin(), outline.end());
    return true;
  };
  for (const HullDocument::Loop& loop : face.loops) {
    if (!runs_on(loop.curves)) return false;
  }
  if (!runs_on(face.outline)) return false;
  std::sort(having.begin(), having.end());
  std::sort(named.begin(), named.end());
  return having == named;
}

int Structure::euler() const {
  std::map<int, int> uses;  // of vertices, by curves that have two of them
  for (int c = 0; c < int(hull_.curves.size()); ++c) {
    if (ends_.is_point(c) || ends_.vertex(c, 0) == ends_.vertex(c, 1)) continue;
    for (const int end : {0, 1}) ++uses[ends_.vertex(c, end)];
  }
  int edges = 0;
  for (int c = 0; c < int(hull_.curves.size()); ++c) {
    if (ends_.is_point(c)) continue;
    const bool closed = ends_.vertex(c, 0) == ends_.vertex(c, 1);
    if (!closed || uses.contains(ends_.vertex(c, 0))) ++edges;
  }
  int faces = 0;
  for (const HullDocument::Face& face : hull_.faces) faces += characteristic(face);
  if (hull_.dimension == 2) ++faces;  // the other side
  return int(uses.size()) - edges + faces;
}

/// Of a face of genus 0, from the number of its outlines.
int Structure::characteristic(const HullDocument::Face& face) const {
  if (face.kind == FaceKind::patch) return 2 - int(face.loops.size());
  if (face.kind == FaceKind::facet || face.rulings.size() < 2) return 1;
  // A closed scroll is a ring, or a disc about the vertex that it has on one side.
  const HullDocument::Ruling& first = face.rulings.front();
  const HullDocument::Ruling& last = face.rulings.back();
  const double near = tolerance_ + face.tolerant;
  const double turn = face.tolerant / glm::distance(first.a.p, first.b.p);
  const bool ring = glm::distance(first.n, last.n) <= std::max(same_direction, turn) &&
                    glm::distance(first.a.p, last.a.p) <= near &&
                    glm::distance(first.b.p, last.b.p) <= near;
  if (!ring) return 1;
  return 2 - (face.curves[0].empty() ? 0 : 1) - (face.curves[1].empty() ? 0 : 1);
}

}  // namespace

HullStructure hull_structure(const HullDocument& hull, double tolerance) {
  return Structure(hull, tolerance).check();
}

}  // namespace taut
