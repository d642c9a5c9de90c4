#pragma once

#include <vector>

#include "reference.h"
#include "refined_cage.h"

namespace taut_test {

/// Support values of a control cage's limit surface, by uniform refinement alone: of the whole cage
/// to some level, and from there on of the faces that may hold the maximum. No patches, no end
/// caps, no derivatives.
class LimitSupport {
 public:
  /// @pre levels >= 2
  LimitSupport(const ControlCage& cage, int levels);

  /// `lower` is attained by a limit point; nothing is above `upper`, for the limit surface of a
  /// face is in the convex hull of the control points of the faces around it: all masks are convex
  /// combinations. In double precision: rounded by some 1e-15 of the cage's size.
  ///
  /// They are as close as `accuracy`, but for contact along whole curves, whose faces become more
  /// from level to level, and but for cages with edges between the same vertices in all levels, as
  /// Loop's with vertices of two faces have: they have the bounds of the first one.
  SupportRange operator()(const dvec3& n, double accuracy) const;

  /// Of the level to which all is refined, where masks hold.
  const std::vector<LimitPoint>& limits() const { return start_.limits; }

 private:
  struct Level {
    explicit Level(RefinedCage refined);
    RefinedCage cage;
    std::vector<LimitPoint> limits;
  };
  static double highest_limit(const Level& level, const dvec3& n);
  static std::vector<double> reaches(const Level& level, const dvec3& n);

  Level start_;
  bool simple_;  // its edges
};

}  // namespace taut_test
