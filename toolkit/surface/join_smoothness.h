#pragma once

#include <vector>

#include "taut/surface/side_joins.h"

namespace taut {

/// How a part's patches go on across the joins of their sides, with tangents the same up to a given
/// angle.
class JoinSmoothness {
 public:
  /// Patches and sides must outlive this. `grid`: by how much coordinates were rounded before;
  /// `bent`: by how much patches that were ruled then may miss it.
  /// @pre rulings are found
  JoinSmoothness(const std::vector<Patch>& patches, const std::vector<SideCurve>& sides,
                 double tolerance, double smooth_angle, double grid = 0, double bent = 0);

  /// Unit vectors differ by at most the angle.
  bool same_direction(const dvec3& a, const dvec3& b) const { return glm::length(a - b) <= chord_; }

  /// Two patches have the same tangent planes all along the join, and go on into each other.
  bool is_smooth(const Join& join) const;

  /// Whether something ends at a smooth join. Where a ruled patch ends, rulings end, unless those
  /// of another go straight on; on both sides of a crest support points are few, on it many.
  /// Across other smooth joins support points move on from one patch to the next.
  /// @pre the join is smooth
  bool is_seam(const Join& join) const;

  /// The normals' limits agree along a collapsed side, as at the pole of a sphere.
  bool is_pole(int side) const;

 private:
  const BezierCurve& curve(const Use& use) const {
    return sides_[static_cast<std::size_t>(use.side)].curve;
  }
  const Patch& patch(int side) const { return patches_[static_cast<std::size_t>(side / 4)]; }
  RuledLines lines(const Use& use) const { return patch(use.side).lines(bent_); }
  bool is_plane(const Use& use) const;
  bool rulings_go_on(const Join& join) const;
  bool may_be_crest(const Use& use) const;

  const std::vector<Patch>& patches_;
  const std::vector<SideCurve>& sides_;
  std::vector<dvec3> corner_points_;
  double tolerance_;
  double grid_;
  double bent_;
  double chord_;  // of the angle
};

}  // namespace taut
