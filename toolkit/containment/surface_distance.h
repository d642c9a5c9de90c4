#pragma once

#include <vector>

#include "taut/containment/hull_distance.h"
#include "taut/containment/placed_surface.h"

namespace taut {

/// Distances of points from the patches of a placed surface, by branch and bound over their control
/// nets: a cell lies within the convex hull of its control points, hence beyond the box of these
/// and beyond the plane through any of them across a direction. Across the direction to the nearest
/// point known, that is as good as the cell is flat. Newton's method finds nearest points.
///
/// Holds scratch memory, so use one object a thread; the surface must outlive it.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const PlacedSurface& surface) : surface_(surface) {}

  /// The distance of x from the patches of one body, or of all (-1): what was found, with proven
  /// bounds, in the scene's frame. The search ends when it is known to `goal`, with
  /// `goal.tolerance` asking whether it is larger. `within`: the distance is not larger than this.
  /// Infinite where there are no patches.
  DistanceRange operator()(const dvec3& x, const DistanceGoal& goal, int body, double within);

 private:
  struct Cell {
    double lower;  ///< bound of its distance
    int patch;
    double u, v, size_u, size_v;
    std::size_t slot;
    bool operator<(const Cell& other) const { return lower > other.lower; }
  };

  void open(int patch);
  void push(const Cell& cell);
  double lower_bound(const dvec4* net, std::size_t size) const;
  void improve(const PlacedPatch& patch, double u, double v);
  void offer(const dvec3& point);
  void split(const Cell& cell);
  bool done(double lower) const;

  const PlacedSurface& surface_;
  dvec3 x_ = dvec3(0.0);
  DistanceGoal goal_;
  double best_ = 0;
  dvec3 toward_ = dvec3(0.0);  ///< unit, from the nearest point known to x
  std::vector<Cell> heap_;
  std::vector<dvec4> nets_;
};

}  // namespace taut
