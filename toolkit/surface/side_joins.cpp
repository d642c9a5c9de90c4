#include "taut/surface/side_joins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/surface/point_grid.h"

namespace taut {
namespace {

/// How far curve b, run backwards if `reversed`, is from curve a at worst; none if that is more
/// than the tolerance.
///
/// They are compared as points at equal parameters rather than by control points, since that is the
/// distance which the tolerance means, for any weights and degrees. Two rational curves of degrees
/// p and q that agree at p + q + 1 parameters are the same.
std::optional<double> gap_between(const BezierCurve& a, const BezierCurve& b, bool reversed,
                                  double tolerance) {
  double gap = 0;
  const auto same = [&](const dvec3& p, const dvec3& q) {
    gap = std::max(gap, glm::distance(p, q));
    return same_point(p, q, tolerance);
  };
  const dvec4& start = reversed ? b.points.back() : b.points.front();
  const dvec4& end = reversed ? b.points.front() : b.points.back();
  if (!same(euclidean(a.points.front()), euclidean(start)) ||
      !same(euclidean(a.points.back()), euclidean(end))) {
    return {};
  }
  const int m = a.degree() + b.degree();
  for (int k = 1; k < m; ++k) {
    const double t = sample_parameter(k, m);
    if (!same(point(a, t), point(b, reversed ? 1 - t : t))) return {};
  }
  return gap;
}

/// A point that curves have in common if they agree, in either direction, within twice the
/// tolerance. The middle alone would do, but not where very many curves cross in theirs.
dvec3 place_of(const BezierCurve& curve) {
  const dvec3 chord = euclidean(curve.points.back()) - euclidean(curve.points.front());
  return point(curve, 0.5) + 0.5 * glm::abs(chord);
}

/// Whether all control points coincide within the tolerance.
bool is_collapsed(const BezierCurve& curve, double tolerance) {
  const dvec3 start = euclidean(curve.points.front());
  return std::all_of(curve.points.begin(), curve.points.end(),
                     [&](const dvec4& p) { return same_point(euclidean(p), start, tolerance); });
}

}  // namespace

double join_tolerance(const Box& box, double bent) {
  return std::max({join_distance * diagonal(box), bent, std::numeric_limits<double>::min()});
}

double sample_parameter(int k, int m) { return 0.5 - 0.5 * std::cos(std::numbers::pi * k / m); }

std::vector<SideCurve> side_curves(const std::vector<Patch>& patches, double tolerance) {
  std::vector<SideCurve> sides;
  sides.reserve(4 * patches.size());
  for (const Patch& patch : patches) {
    for (const Side side : all_sides) {
      BezierCurve curve = border(patch.bezier, side);
      const bool collapsed = is_collapsed(curve, tolerance);
      sides.push_back({std::move(curve), collapsed});
    }
  }
  return sides;
}

std::vector<Join> match_sides(const std::vector<Patch>& patches,
                              const std::vector<SideCurve>& sides, const Box& box, double tolerance,
                              const Progress& progress) {
  std::vector<Join> joins;
  PointGrid places(box, 2 * tolerance);
  for (int side = 0; side < to_int(sides.size()); ++side) {
    progress.check();
    const SideCurve& s = sides[to_size(side)];
    if (s.collapsed || patches[to_size(side / 4)].repeats >= 0) continue;
    const dvec3 place = place_of(s.curve);
    Use use{side, false, 0};
    int found = to_int(joins.size());
    places.visit_near(place, [&](int join) {
      if (join > found) return;
      const BezierCurve& first = sides[to_size(joins[to_size(join)].front().side)].curve;
      for (const bool reversed : {false, true}) {
        const std::optional<double> gap = gap_between(first, s.curve, reversed, tolerance);
        if (!gap) continue;
        found = join;
        use.reversed = reversed;
        use.gap = *gap;
        return;
      }
    });
    if (found == to_int(joins.size())) {
      joins.emplace_back();
      places.insert(place, found);
    }
    joins[to_size(found)].push_back(use);
  }
  return joins;
}

double largest_gap(const std::vector<SideCurve>& sides, const std::vector<Join>& joins) {
  double gap = 0;
  for (const Join& join : joins) {
    for (const Use& use : join) gap = std::max(gap, use.gap);
  }
  for (const SideCurve& side : sides) {
    if (!side.collapsed) continue;
    const dvec3 start = euclidean(side.curve.points.front());
    for (const dvec4& p : side.curve.points)
      gap = std::max(gap, glm::distance(euclidean(p), start));
  }
  return gap;
}

}  // namespace taut
