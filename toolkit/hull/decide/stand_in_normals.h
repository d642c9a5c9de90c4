#pragma once

#include <vector>

#include "taut/hull/decide/branches.h"

namespace taut {

/// Stand-ins that are no more than points to a branch.
///
/// The curvature of a stand-in tells nothing. But let its normals, and those of the stand-ins that
/// it goes on into, lie within a cone of angle e. For directions outside of the cone the heights
/// have no point there at which a plane touches, as far as their sum of indices goes; for one
/// inside, what nearly supports nearly supports in one on the cone's border too, to within e times
/// the extent of the branch.
class StandInNormals {
 public:
  explicit StandInNormals(const MapPieces& pieces)
      : pieces_(pieces), cones_(pieces.elements().size()) {}

  bool is_stand_in(const Chart& chart) const;
  /// Certain: for stand-ins of the branch that go on into each other that is within `budget`.
  bool are_points(const Branches& branches, const Branch& branch, double budget);

 private:
  /// That holds all normals of a patch; of no use if the angle is pi.
  struct Cone {
    dvec3 axis = dvec3(0.0);
    double angle = -1;  ///< not known yet
  };
  const Cone& cone(int element);

  const MapPieces& pieces_;
  std::vector<Cone> cones_;  // by element
};

}  // namespace taut
