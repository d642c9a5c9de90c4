#include "taut/surface/join_smoothness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/surface/crests.h"
#include "taut/surface/flatness.h"
#include "taut/surface/rulings.h"
#include "taut/surface/split_crests.h"

namespace taut {
namespace {

Side side_of(int side) { return all_sides[static_cast<std::size_t>(side % 4)]; }

/// Normal of the patch at parameter t of a side.
dvec3 side_normal(const BezierPatch& patch, Side side, double t) {
  const dvec2 at = on_side(side, t);
  return unit_normal(patch, at.x, at.y);
}

/// Su x Sv is (direction into the patch) x (direction of the side), or minus it.
bool normal_is_inward_cross_along(Side side) { return side == Side::u0 || side == Side::v1; }

}  // namespace

JoinSmoothness::JoinSmoothness(const std::vector<Patch>& patches,
                               const std::vector<SideCurve>& sides, double tolerance,
                               double smooth_angle, double grid, double bent)
    : patches_(patches),
      sides_(sides),
      corner_points_(corner_points(patches)),
      tolerance_(tolerance),
      grid_(grid),
      bent_(bent),
      chord_(2 * std::sin(smooth_angle / 2)) {}

/// G1 along a border x(t) is det(X, X', A, B) = 0 with homogeneous X and cross derivatives A, B: a
/// polynomial of degree at most 4 d - 2, which 4 d - 1 parameters determine.
bool JoinSmoothness::is_smooth(const Join& join) const {
  if (join.size() != 2) return false;
  const Use& a = join[0];
  const Use& b = join[1];
  if (patch(a.side).smooth_sides[std::size_t(a.side % 4)] &&
      patch(b.side).smooth_sides[std::size_t(b.side % 4)]) {
    return true;
  }
  const bool reversed = a.reversed != b.reversed;
  // Where b continues a, the directions into the two patches are opposite; where it folds back onto
  // a, they are the same. So the sign between the two normals is known.
  const bool opposite = (normal_is_inward_cross_along(side_of(a.side)) ==
                         normal_is_inward_cross_along(side_of(b.side))) != reversed;
  const int m = 4 * std::max(curve(a).degree(), curve(b).degree()) - 2;
  for (int k = 0; k <= m; ++k) {
    const double t = sample_parameter(k, m);
    const dvec3 na = side_normal(patch(a.side).bezier, side_of(a.side), t);
    const dvec3 nb = side_normal(patch(b.side).bezier, side_of(b.side), reversed ? 1 - t : t);
    if (na == dvec3(0.0) || !same_direction(na, opposite ? -nb : nb)) return false;
  }
  return true;
}

bool JoinSmoothness::is_seam(const Join& join) const {
  const bool straight =
      is_straight(curve(join[0])) || distance_from_segment(curve(join[0])) <= bent_;
  const bool ruled[2] = {lines(join[0]).any(), lines(join[1]).any()};
  if (ruled[0] != ruled[1]) return true;
  if (ruled[0]) return !straight && !rulings_go_on(join);
  return !straight &&
         std::all_of(join.begin(), join.end(), [&](const Use& use) { return may_be_crest(use); });
}

bool JoinSmoothness::may_be_crest(const Use& use) const {
  const Side side = side_of(use.side);
  const BezierPatch& bezier = patch(use.side).bezier;
  const Direction direction = along_v(side) ? Direction::u : Direction::v;
  const double s = at_upper_end(side) ? 1 : 0;
  return is_crest(bezier, direction, s, grid_) &&
         may_support(bezier, direction, s, corner_points_, tolerance_, grid_);
}

bool JoinSmoothness::is_plane(const Use& use) const {
  const BezierPatch& bezier = patch(use.side).bezier;
  return taut::is_plane(bezier) || (lines(use).both() && distance_from_plane(bezier) <= bent_);
}

/// Rulings of the one patch that end on the join are continued by those of the other, as of two
/// parts of one plane all are.
bool JoinSmoothness::rulings_go_on(const Join& join) const {
  if (is_plane(join[0]) && is_plane(join[1])) return true;
  const int m = 4 * curve(join[0]).degree();
  for (int k = 0; k <= m; ++k) {
    const double t = sample_parameter(k, m);
    std::array<std::optional<RulingDirection>, 2> e;
    for (const std::size_t i : {0u, 1u}) {
      const Use& use = join[i];
      const dvec2 uv = on_side(side_of(use.side), use.reversed ? 1 - t : t);
      e[i] = ruling_at(patch(use.side), uv, bent_);
    }
    if (!e[0] || !e[1]) return false;
    const double allowed = same_ruling_angle + e[0]->rounding + e[1]->rounding;
    if (glm::length(glm::cross(e[0]->along, e[1]->along)) > allowed) return false;
  }
  return true;
}

bool JoinSmoothness::is_pole(int side) const {
  const BezierPatch& bezier = patch(side).bezier;
  const int m = 4 * sides_[static_cast<std::size_t>(side)].curve.degree() - 2;
  const dvec3 first = side_normal(bezier, side_of(side), 0);
  if (first == dvec3(0.0)) return false;
  for (int k = 1; k <= m; ++k) {
    const dvec3 n = side_normal(bezier, side_of(side), sample_parameter(k, m));
    if (!same_direction(n, first)) return false;
  }
  return true;
}

}  // namespace taut
