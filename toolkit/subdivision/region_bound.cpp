#include "taut/subdivision/region_bound.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "taut/subdivision/edge_middles.h"
#include "taut/subdivision/hull_distance.h"
#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/triangle_points.h"

namespace taut {
namespace {

/// Levels below the region's that are looked at: more than it takes to get from the size of a cage
/// to its rounding.
constexpr int levels_below = 48;
/// Intervals between the points of a side along a crease that are known.
constexpr int crease_samples = 8;

dvec3 cubic(const std::array<dvec3, 4>& c, double t) {
  const double s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

/// The largest distance from the known points' convex hull that was met.
class Bound {
 public:
  /// Nothing is met any more once the bound is over the limit.
  Bound(std::vector<dvec3> known, double limit) : known_(std::move(known)), limit_(limit) {}

  void know(const std::array<dvec3, 4>& crease) {
    for (int k = 0; k <= crease_samples; ++k) {
      known_.push_back(cubic(crease, double(k) / crease_samples));
    }
  }
  void meet(const dvec3& p) {
    if (!is_over()) value_ = std::max(value_, distance(p));
  }
  double distance(const dvec3& p) const { return distance_from_hull_bound(p, known_); }
  bool is_over() const { return value_ > limit_; }
  double value() const { return value_; }

 private:
  std::vector<dvec3> known_;
  double limit_;
  double value_ = 0;
};

/// The control points that are on none of the cell's creases.
std::vector<dvec3> inner_points(const CageLevel& level, std::size_t cell, const CellPatch& patch) {
  std::vector<bool> is_outer(patch.points.size());
  for (std::size_t side = 0; side < level.vertices(cell).size(); ++side) {
    if (!level.crease(cell, side)) continue;
    for (const std::size_t k : side_points(patch, side)) is_outer[k] = true;
  }
  std::vector<dvec3> result;
  for (std::size_t k = 0; k < patch.points.size(); ++k) {
    if (!is_outer[k]) result.push_back(patch.points[k]);
  }
  return result;
}

/// Adds points of the cells' creases.
void know_creases(const CageLevel& level, std::span<const std::size_t> cells, Bound& bound) {
  for (const std::size_t c : cells) {
    for (std::size_t side = 0; side < level.vertices(c).size(); ++side) {
      if (const auto crease = level.crease(c, side)) bound.know(*crease);
    }
  }
}

/// Sharp sides of the cells, and those of them that are creases: so are then those of the levels
/// below, and parts of them.
struct SharpSides {
  int count = 0;
  int creases = 0;
};

SharpSides sharp_sides(const CageLevel& level, std::span<const std::size_t> cells,
                       const std::vector<CellPatch>& patches) {
  SharpSides sharp;
  for (const std::size_t c : cells) {
    for (std::size_t side = 0; side < level.vertices(c).size(); ++side) {
      if (patches[c].smooth[side]) continue;
      ++sharp.count;
      if (level.crease(c, side)) ++sharp.creases;
    }
  }
  return sharp;
}

/// How far the caps' sides may be from the cells' creases.
double side_gap(const CageLevel& level, std::span<const std::size_t> cells,
                const std::vector<CellPatch>& patches) {
  double gap = 0;
  for (const std::size_t c : cells) {
    for (std::size_t side = 0; side < level.vertices(c).size(); ++side) {
      const auto crease = level.crease(c, side);
      if (!crease) continue;
      const std::vector<std::size_t> own = side_points(patches[c], side);
      const std::vector<dvec3> there =
          elevated_curve({crease->begin(), crease->end()}, own.size() - 1);
      for (std::size_t k = 0; k < own.size(); ++k) {
        gap = std::max(gap, glm::distance(patches[c].points[own[k]], there[k]));
      }
    }
  }
  return gap;
}

/// The cells' limit surface is within the convex hull of these.
std::vector<dvec3> enclosures(const CageLevel& level, std::span<const std::size_t> cells) {
  std::vector<dvec3> result;
  std::vector<dvec3> points;
  for (const std::size_t c : cells) {
    level.enclosure(c, points);
    result.insert(result.end(), points.begin(), points.end());
  }
  return result;
}

/// Meets all of the cells' limit surface, by its patches on the levels below.
void meet_limit(const CageLevel& level, std::span<const std::size_t> cells, Bound& bound,
                double small) {
  EdgeMiddles middles(0);
  std::vector<std::size_t> left(cells.begin(), cells.end());
  CageLevel below = level.refined(left, middles);
  for (int depth = 0; depth < levels_below && !bound.is_over(); ++depth) {
    left.clear();
    const std::vector<CellPatch> patches = below.patches();
    for (std::size_t c = 0; c < patches.size(); ++c) {
      if (patches[c].kind != CellPatch::Kind::regular) left.push_back(c);
    }
    std::vector<std::size_t> all(patches.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    know_creases(below, all, bound);
    for (std::size_t c = 0; c < patches.size(); ++c) {
      if (patches[c].kind != CellPatch::Kind::regular) continue;
      for (const dvec3& p : inner_points(below, c, patches[c])) bound.meet(p);
    }
    const std::vector<dvec3> rest = enclosures(below, left);
    const bool ends = depth + 1 == levels_below ||
                      std::all_of(rest.begin(), rest.end(),
                                  [&](const dvec3& p) { return bound.distance(p) <= small; });
    if (ends) {
      for (const dvec3& p : rest) bound.meet(p);
      return;
    }
    below = below.refined(left, middles);
  }
}

}  // namespace

std::vector<std::size_t> side_points(const CellPatch& patch, std::size_t side) {
  const auto n = std::size_t(patch.degree);
  std::vector<std::size_t> result;
  const bool quad = patch.points.size() == (n + 1) * (n + 1);
  for (std::size_t k = 0; k <= n; ++k) {
    const std::array<std::size_t, 4> of_quad = {k * (n + 1), n * (n + 1) + k, (n - k) * (n + 1) + n,
                                                n - k};
    const std::array<std::size_t, 3> of_triangle = {
        triangle_point(n, k, 0), triangle_point(n, n - k, k), triangle_point(n, 0, n - k)};
    result.push_back(quad ? of_quad[side] : of_triangle[side]);
  }
  return result;
}

double region_bound(const CageLevel& level, std::span<const std::size_t> region,
                    const std::vector<CellPatch>& patches, std::vector<dvec3> known, double enough,
                    bool least) {
  const double limit = least ? std::numeric_limits<double>::infinity() : enough;
  Bound plain(known, limit);
  for (const dvec3& p : enclosures(level, region)) plain.meet(p);
  for (const std::size_t c : region) {
    for (const dvec3& p : patches[c].points) plain.meet(p);
  }
  // Where there are no creases, levels below are as good as the region's own.
  const SharpSides sharp = sharp_sides(level, region, patches);
  const bool may_gain = sharp.count > 0 || least;
  if (plain.value() <= enough || sharp.creases < sharp.count || !may_gain) return plain.value();
  Bound bound(std::move(known), limit);
  know_creases(level, region, bound);
  for (const std::size_t c : region) {
    for (const dvec3& p : inner_points(level, c, patches[c])) bound.meet(p);
  }
  meet_limit(level, region, bound, enough);
  return std::min(plain.value(), bound.value() + side_gap(level, region, patches));
}

}  // namespace taut
