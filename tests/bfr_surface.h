#pragma once

#include <memory>
#include <vector>

#include "models.h"
#include "taut/surface/control_cage.h"

namespace taut_test {

using taut::ControlCage;

/// A point of a limit surface, by OpenSubdiv's evaluation of single faces (Bfr).
struct BfrPoint {
  dvec3 x = dvec3(0.0);
  dvec3 normal = dvec3(0.0);  ///< unit; zero where there is none
  /// How far x may be off: see BfrSurface.
  double error = 0;
};

/// A cage's limit surface by Bfr, in double precision: face by face, with a patch tree of its own
/// for each that is not regular.
///
/// Regular faces are exact. Others are so but for squares about their extraordinary corners, as
/// small as the level of approximation says (2^-10 of the face, no less), in which they end in
/// Gregory patches. Those of the limit's valences up to 12 have positions that come nearer by a
/// factor of at most 0.65 with each level, so that what level 10 is off is less than twice of what
/// it differs from level 9; four times that is taken for the error. Normals there are right to some
/// hundredths, at valence 50 and at boundaries, no better. Outside of the squares both levels are
/// the same but for rounding.
class BfrSurface {
 public:
  explicit BfrSurface(const ControlCage& cage);
  ~BfrSurface();

  /// It is no hole.
  bool has_surface(int face) const;

  /// Anywhere in a face, or near one of its corners: within about `size` of the face.
  BfrPoint point(int face, Random& random) const;
  BfrPoint point_near_corner(int face, double size, Random& random) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace taut_test
