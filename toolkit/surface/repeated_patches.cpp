#include "taut/surface/repeated_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "taut/core/tolerances.h"
#include "taut/surface/point_grid.h"
#include "taut/surface/side_joins.h"

namespace taut {
namespace {

/// Patches so many times as large as the distance of copies are no neighbours of these.
constexpr double large_patch = 16;

/// Patches that are the same within a tolerance have it in common within the same: the middle of
/// the control points, apart from others with the same middle by their extent.
dvec3 place_of(const BezierPatch& patch) {
  Box box;
  dvec3 sum(0.0);
  for (const dvec4& p : patch.points) {
    sum += euclidean(p) / double(patch.points.size());
    box.include(euclidean(p));
  }
  return sum + 0.5 * (box.upper - box.lower);
}

/// Weights are compared as multiples of those of the first pair of points.
bool same_patch(const Patch& first, const BezierPatch& repeated, const Patch& mapping,
                double tolerance) {
  const BezierPatch& a = first.bezier;
  const BezierPatch b = mapping.swapped ? transposed(repeated) : repeated;
  if (a.degree_u != b.degree_u || a.degree_v != b.degree_v) return false;
  const auto mapped = [&](int i, int j) -> const dvec4& {
    return b.at(mapping.reversed_u ? b.degree_u - i : i, mapping.reversed_v ? b.degree_v - j : j);
  };
  const double ratio = mapped(0, 0).w / a.at(0, 0).w;
  for (int i = 0; i <= a.degree_u; ++i) {
    for (int j = 0; j <= a.degree_v; ++j) {
      const dvec4& p = a.at(i, j);
      const dvec4& q = mapped(i, j);
      if (!same_point(euclidean(p), euclidean(q), tolerance)) return false;
      if (std::abs(q.w / p.w / ratio - 1) > repeated_patch_distance) return false;
    }
  }
  return true;
}

/// Sets the patch's mapping to one under which it repeats the first, if there is any.
bool find_mapping(const Patch& first, Patch& patch, double tolerance) {
  for (int mapping = 0; mapping < 8; ++mapping) {
    patch.swapped = (mapping & 4) != 0;
    patch.reversed_u = (mapping & 1) != 0;
    patch.reversed_v = (mapping & 2) != 0;
    if (same_patch(first, patch.bezier, patch, tolerance)) return true;
  }
  patch.swapped = patch.reversed_u = patch.reversed_v = false;
  return false;
}

/// Of a place in a patch that repeats another one: its (u, v) there.
dvec2 place_in_repeated(const Patch& patch, dvec2 uv) {
  if (patch.swapped) std::swap(uv.x, uv.y);
  return {patch.reversed_u ? 1 - uv.x : uv.x, patch.reversed_v ? 1 - uv.y : uv.y};
}

}  // namespace

void find_repeated_patches(std::vector<Patch>& patches, const Box& box, double apart,
                           const Progress& progress) {
  const double least =
      std::max(repeated_patch_distance * diagonal(box), std::numeric_limits<double>::min());
  // Cells of the join tolerance are fine enough to tell patches apart, and coarse enough to number.
  PointGrid places(box, 2 * std::max(join_tolerance(box), apart));
  for (std::size_t i = 0; i < patches.size(); ++i) {
    Patch& patch = patches[i];
    const dvec3 place = place_of(patch.bezier);
    Box own;
    for (const dvec4& p : patch.bezier.points) own.include(euclidean(p));
    const bool is_large = diagonal(own) > large_patch * apart;
    const double tolerance = is_large ? std::max(least, apart) : least;
    places.visit_near(place, [&](int earlier) {
      progress.check();
      const Patch& first = patches[std::size_t(earlier)];
      if (patch.repeats < 0 && find_mapping(first, patch, tolerance)) patch.repeats = earlier;
    });
    if (patch.repeats < 0) places.insert(place, static_cast<int>(i));
  }
}

RepeatedSide side_in_repeated(const Patch& patch, Side side) {
  const dvec2 a = place_in_repeated(patch, on_side(side, 0));
  const dvec2 b = place_in_repeated(patch, on_side(side, 1));
  if (a.x == b.x) return {a.x == 0 ? Side::u0 : Side::u1, a.y > b.y};
  return {a.y == 0 ? Side::v0 : Side::v1, a.x > b.x};
}

}  // namespace taut
