#pragma once

#include <iosfwd>
#include <vector>

#include "reference.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull.h"

namespace taut_test {

/// What was found of an exact boundary. Lengths are in the scene's frame, of size about one.
struct BoundaryFacts {
  /// @name Topology
  /// @{
  int open_curves = 0;    ///< curves without two faces
  int misplaced = 0;      ///< curves in a patch's loops that do not name the patch on that side
  int bare_scrolls = 0;   ///< scrolls that name no curve along a contact that is no vertex
  double loop_gap = 0;    ///< largest distance between consecutive curves of a patch's loop
  double region_gap = 0;  ///< the same of stretches of a region's outline, in (u, v)
  /// Facets whose curves, with the facet to the left, do not begin as often in each point as they
  /// end there, or whose sides are not as many as contacts, or bound nothing.
  int open_facets = 0;
  /// V - E + sum of the faces' Euler characteristics; 2.
  long euler = 0;
  /// @}

  /// @name Residuals, the largest ones
  /// @{
  double point = 0;       ///< a contact's point as stored against the model's
  double stationary = 0;  ///< |dx/da . n| over the larger |dx/da|
  double tie = 0;         ///< |(x_0 - x_1) . n|, of facets |x . n - offset|, along their sides too
  double side = 0;        ///< distance of a facet's curved side's ends from its contacts
  double support = 0;     ///< |h(n) - x . n|
  taut::dvec3 worst_support = taut::dvec3(0.0);
  double between = 0;  ///< the largest of these residuals of rulings between neighbouring ones
  int no_rulings = 0;  ///< of such places: none is found, or outside of its element
  /// @}

  /// @name Random directions
  /// @{
  int directions = 0;
  int misses = 0;  ///< the support point lies on no face, curve or vertex of the boundary
  taut::dvec3 missed = taut::dvec3(0.0);
  /// By how much a point of the boundary reaches farther than the model.
  double overshoot = 0;
  /// @}

  /// @name Random points of the model's patches
  /// @{
  int points = 0;
  int undecided = 0;   ///< of these: too near to an outline, or to supporting, to tell
  int mismatches = 0;  ///< points that support strictly outside of all regions or not inside of one
  taut::Contact mismatch;
  /// Points of regions that are farther below their supporting planes than the boundary's gap, as
  /// in dents, and do not bend strictly away.
  int flat = 0;
  /// @}

  /// Nothing is wrong, to within these shares of the scene's size.
  bool sound(double residual = 1e-12, double gap = 1e-9) const {
    return open_curves == 0 && misplaced == 0 && bare_scrolls == 0 && loop_gap <= gap &&
           region_gap <= gap && open_facets == 0 && euler == 2 && point <= residual &&
           stationary <= residual && tie <= residual && side <= residual && support <= residual &&
           between <= residual && no_rulings == 0 && misses == 0 && overshoot <= residual &&
           mismatches == 0 && flat == 0;
  }
};

/// Checks a hull's exact boundary against the scene by support queries, in so many random
/// directions and about as many points of patches. @pre hull.boundary is there and in the scene's
/// frame
BoundaryFacts boundary_facts(const taut::Scene& scene, const taut::Hull& hull, int directions);

std::ostream& operator<<(std::ostream& out, const BoundaryFacts& facts);

/// Where a point of a patch's parameters lies with respect to a region's loops.
struct PlaceInLoops {
  int winding = 0;    ///< inside: 1, outside: 0
  real distance = 0;  ///< from the loops, in (u, v)
};
/// Near the point the outline is refined by exact rulings, and the test is in long double.
PlaceInLoops place_in_loops(const taut::ContactGeometry& geometry,
                            const taut::HullBoundary& boundary, const taut::PatchRegion& region,
                            const taut::dvec2& uv);

}  // namespace taut_test
