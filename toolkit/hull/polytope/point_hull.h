#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/predicates.h"
#include "taut/core/progress.h"

namespace taut {

/// Convex hull of points in space, grown by inserting points; every decision is exact.
///
/// The boundary is a closed surface of triangles, counter-clockwise from outside. Invariant: no
/// point added lies strictly above the plane of any facet, and no facet has zero area. Coplanar
/// facets may stand side by side, and a point that later ones made collinear or interior to a flat
/// part may remain a vertex; merged_polygons() takes both out.
///
/// Method: Barber, Dobkin, Huhdanpaa 1996 (Quickhull); only facets strictly below a new point are
/// replaced, hence the invariant holds without any tolerance.
class PointHull {
 public:
  /// A triangle of the boundary.
  struct Facet {
    std::array<int, 3> vertex;  ///< by number, counter-clockwise from outside
    /// neighbor[k] lies across the edge from vertex[k] to vertex[(k + 1) % 3].
    std::array<int, 3> neighbor;
    PlaneSide side;  ///< tells which points are above its plane
    bool alive;      ///< else its place is free
  };

  /// An empty hull for points in the box (the box only decides speed). @pre not empty
  explicit PointHull(const Box& box) : extent_(box.upper - box.lower) {}

  /// Adds points, numbered on from points().size(). Until the points span space there are no
  /// facets; then all points added so far count.
  /// @throws Cancelled, after which the hull is of no more use
  void add(std::span<const dvec3> points, const Progress& progress = {});

  /// Adds one point that is to lie strictly above the facet. False, and nothing changes, if it does
  /// not. @pre dimension() == 3, the facet is alive
  bool insert(const dvec3& point, int facet);

  /// The facets that the point lies strictly above, where it lies so above this one; else none.
  /// Until the hull is changed or asked again. @pre dimension() == 3, the facet is alive
  const std::vector<int>& visible(const dvec3& point, int facet);

  /// Dimension of the points' affine hull: -1 without points, else 0 to 3. Exact.
  int dimension() const { return dimension_; }
  /// Points, by number, that span the affine hull: the first dimension() + 1.
  const std::array<int, 4>& simplex() const { return simplex_; }

  /// All that were added, by number.
  const std::vector<dvec3>& points() const { return points_; }
  /// The point with this number.
  const dvec3& point(int i) const { return points_[std::size_t(i)]; }
  /// Facets by number; the dead among them are free places, which later facets take.
  const std::vector<Facet>& facets() const { return facets_; }
  /// The facet with this number.
  const Facet& facet(int i) const { return facets_[std::size_t(i)]; }
  /// Facets that are alive.
  int facet_count() const { return alive_; }
  /// The facets that the last insert() made, around the new point.
  const std::vector<int>& created() const { return created_; }
  /// The facets that the last insert() took away, unless visible() was called since; their places
  /// are free.
  const std::vector<int>& replaced() const { return visible_; }

  /// The boundary with coplanar facets joined to convex polygons and with extreme points only, by
  /// exact predicates. `facets[k]` is a facet within polygon k.
  struct Polygons {
    std::vector<std::vector<int>> loops;  ///< points by number, counter-clockwise from outside
    std::vector<int> facets;              ///< per loop
  };
  /// @throws Cancelled
  Polygons merged_polygons(const Progress& progress = {}) const;

 private:
  bool make_simplex();
  int new_facet(int a, int b, int c);
  void assign(int point, std::span<const int> candidates);
  void collect_visible(const dvec3& p, int start);
  void make_cone(int apex);
  Sign side(int facet, const dvec3& p) const { return facets_[std::size_t(facet)].side.side(p); }

  struct HorizonEdge {
    int from, to;
    int outside;
  };
  /// Points above a facet that wait for insertion: a list through next_, the highest first.
  struct Waiting {
    int first = -1;
    double height = 0;
  };

  dvec3 extent_;
  int dimension_ = -1;
  std::array<int, 4> simplex_ = {0, -1, -1, -1};
  int alive_ = 0;
  std::vector<dvec3> points_;
  std::vector<Facet> facets_;
  std::vector<int> free_;
  std::vector<int> created_;

  std::vector<Waiting> waiting_;
  std::vector<int> next_;
  std::vector<int> visible_;
  std::vector<HorizonEdge> horizon_;
  std::vector<int> facet_from_;  // per vertex: the cone's facet whose base edge starts there
  std::vector<int> stack_;
};

}  // namespace taut
