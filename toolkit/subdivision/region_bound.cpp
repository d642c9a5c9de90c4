#include "taut/subdivision/region_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "taut/subdivision/edge_middles.h"
#include "taut/subdivision/point_hull_distance.h"
#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/triangle_points.h"
#include "taut/surface/bezier.h"

namespace taut {
namespace {

/// Levels below the region's that are looked at: more than it takes to get from the size of a cage
/// to its rounding.
constexpr int levels_below = 48;
/// Intervals between the points of a side along a crease that are known.
constexpr int crease_samples = 8;
/// Of a cap's side, and lines across.
constexpr int cap_samples = 8;
/// Of pieces in a corner between creases.
constexpr int corner_halvings = 16;

dvec3 cubic(const std::array<dvec3, 4>& c, double t) {
  const double s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

/// The largest distance from the known points' convex hull that was met.
class Bound {
 public:
  /// Nothing is met any more once the bound is over the limit.
  Bound(const std::vector<dvec3>& known, double limit, const Progress& progress)
      : known_(known), limit_(limit), progress_(progress) {}

  void know(const dvec3& p) {
    known_.push_back(p);
    hull_.reset();
  }
  void meet(const dvec3& p) {
    if (!is_over()) value_ = std::max(value_, distance(p, value_));
  }
  bool is_within(const dvec3& p, double distance) {
    return this->distance(p, distance) <= distance;
  }
  bool is_over() const { return value_ > limit_; }
  double value() const { return value_; }

 private:
  double distance(const dvec3& p, double enough) {
    progress_.check();
    if (!hull_) hull_.emplace(known_);
    return hull_->bound(p, enough);
  }

  std::vector<dvec3> known_;
  std::optional<PointHullDistance> hull_;  // of the known points, once it is asked
  double limit_;
  const Progress& progress_;
  double value_ = 0;
};

/// A patch, or part of one.
struct Piece {
  CellPatch patch;
  std::size_t sides = 0;
  std::array<bool, 4> on_crease = {};  ///< from each corner to the next
};

BezierPatch bezier(const CellPatch& quad) {
  BezierPatch result;
  result.degree_u = result.degree_v = quad.degree;
  for (const dvec3& p : quad.points) result.points.push_back(homogeneous(p));
  return result;
}

/// Points of the patch where its sides, and lines across, are divided in so many.
std::vector<dvec3> lattice(const Piece& piece, int count) {
  std::vector<dvec3> result;
  const bool quad = piece.sides == 4;
  const BezierPatch patch = quad ? bezier(piece.patch) : BezierPatch{};
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= (quad ? count : count - i); ++j) {
      const dvec2 at = dvec2(i, j) / double(count);
      result.push_back(quad ? point(patch, at.x, at.y)
                            : value_of_triangle(piece.patch.points, {1 - at.x - at.y, at}));
    }
  }
  return result;
}

/// Two creases are in a common corner.
bool has_crease_corner(const Piece& piece) {
  for (std::size_t side = 0; side < piece.sides; ++side) {
    if (piece.on_crease[side] && piece.on_crease[(side + 1) % piece.sides]) return true;
  }
  return false;
}

/// The control points that are on none of the creases, but for those of creases that meet one of
/// these in a corner: the piece is within the convex hull of these points and of creases that have
/// no corner in common.
std::vector<dvec3> inner_points(const Piece& piece) {
  std::vector<bool> is_outer(piece.patch.points.size());
  std::array<bool, 4> is_left_out = {};
  for (std::size_t side = 0; side < piece.sides; ++side) {
    const std::size_t before = (side + piece.sides - 1) % piece.sides;
    const std::size_t after = (side + 1) % piece.sides;
    is_left_out[side] = piece.on_crease[side] && !is_left_out[before] && !is_left_out[after];
    if (!is_left_out[side]) continue;
    for (const std::size_t k : side_points(piece.patch, side)) is_outer[k] = true;
  }
  std::vector<dvec3> result;
  for (std::size_t k = 0; k < is_outer.size(); ++k) {
    if (!is_outer[k]) result.push_back(piece.patch.points[k]);
  }
  return result;
}

/// The control points of a quad's part at a corner, half as wide.
std::vector<dvec3> quarter_of_quad(const CellPatch& patch, std::size_t corner) {
  const auto half = [](bool upper) { return upper ? Interval{0.5, 1} : Interval{0, 0.5}; };
  std::vector<dvec3> result;
  for (const dvec4& p :
       restricted(bezier(patch), half(corner == 1 || corner == 2), half(corner >= 2)).points) {
    result.push_back(euclidean(p));
  }
  return result;
}

/// The parts at the corners, half as wide, and of a triangle the middle one.
std::vector<Piece> quarters(const Piece& piece) {
  std::vector<Piece> result;
  const std::size_t n = piece.sides;
  std::array<dvec3, 3> middles = {dvec3(0.5, 0.5, 0), dvec3(0, 0.5, 0.5), dvec3(0.5, 0, 0.5)};
  for (std::size_t k = 0; k < n; ++k) {
    Piece part = piece;
    for (std::size_t side = k + 1; side + 1 < k + n; ++side) part.on_crease[side % n] = false;
    if (n == 4) {
      part.patch.points = quarter_of_quad(piece.patch, k);
    } else {
      std::array<dvec3, 3> own;
      own[k] = dvec3(0.0);
      own[k][static_cast<int>(k)] = 1;
      own[(k + 1) % 3] = middles[k];
      own[(k + 2) % 3] = middles[(k + 2) % 3];
      part.patch.points = sub_triangle(piece.patch.points, own);
    }
    result.push_back(std::move(part));
  }
  if (n == 3) {
    Piece part = piece;
    part.on_crease = {};
    part.patch.points = sub_triangle(piece.patch.points, middles);
    result.push_back(std::move(part));
  }
  return result;
}

/// The quarters, those in corners between creases divided again and again: there control points of
/// a crease count, which are as much nearer to it as the part is smaller, squared.
void divide(const Piece& piece, int halvings, std::vector<Piece>& parts) {
  for (Piece& part : quarters(piece)) {
    if (halvings > 1 && has_crease_corner(part)) {
      divide(part, halvings - 1, parts);
    } else {
      parts.push_back(std::move(part));
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

/// How far the cells' limit surface is from the convex hull of points of the caps that stand for
/// them, and the caps from that of points of the limit surface, both with what is known.
class Comparison {
 public:
  /// `creases`: they have the cells' sharp sides in common.
  Comparison(const std::vector<dvec3>& known, bool creases, double limit, const Progress& progress)
      : progress_(progress),
        of_limit_(known, limit, progress),
        of_caps_(known, limit, progress),
        creases_(creases) {}

  /// Points of the caps are known to the limit surface.
  void take_caps(const CageLevel& level, std::span<const std::size_t> cells,
                 const std::vector<CellPatch>& patches);
  /// The limit surface by its patches on the levels below, down to where what is left is near.
  void take_limit(const CageLevel& level, std::span<const std::size_t> cells, double small);
  /// The caps, after the limit surface.
  void meet_caps();
  double value() const { return std::max(of_limit_.value(), of_caps_.value()); }

 private:
  Piece piece_of(const CageLevel& level, std::size_t cell, const CellPatch& patch);
  void know_both(const dvec3& p) {
    of_limit_.know(p);
    of_caps_.know(p);
  }

  const Progress& progress_;
  Bound of_limit_;
  Bound of_caps_;
  bool creases_;
  std::vector<Piece> caps_;
};

/// Points of its creases are known from now on.
Piece Comparison::piece_of(const CageLevel& level, std::size_t cell, const CellPatch& patch) {
  Piece piece{patch, level.vertices(cell).size(), {}};
  for (std::size_t side = 0; side < piece.sides && creases_; ++side) {
    const auto crease = level.crease(cell, side);
    piece.on_crease[side] = crease.has_value();
    if (!crease) continue;
    for (int k = 0; k <= crease_samples; ++k) know_both(cubic(*crease, double(k) / crease_samples));
    // The ends of parts in corners.
    const double part = std::ldexp(1.0, -corner_halvings);
    for (const double t : {part, 1 - part}) know_both(cubic(*crease, t));
  }
  return piece;
}

void Comparison::take_caps(const CageLevel& level, std::span<const std::size_t> cells,
                           const std::vector<CellPatch>& patches) {
  for (const std::size_t c : cells) {
    const Piece cap = piece_of(level, c, patches[c]);
    for (const dvec3& p : lattice(cap, cap_samples)) of_limit_.know(p);
    divide(cap, corner_halvings, caps_);
  }
}

void Comparison::take_limit(const CageLevel& level, std::span<const std::size_t> cells,
                            double small) {
  EdgeMiddles middles(0);
  std::vector<std::size_t> left(cells.begin(), cells.end());
  CageLevel below = level.refined(left, middles);
  int samples = cap_samples;
  for (int depth = 0; depth < levels_below && !of_limit_.is_over(); ++depth) {
    left.clear();
    const std::vector<CellPatch> patches = below.patches(progress_);
    std::vector<Piece> pieces;
    samples = std::max(samples / 2, 1);
    for (std::size_t c = 0; c < patches.size(); ++c) {
      const Piece piece = piece_of(below, c, patches[c]);
      if (patches[c].kind == CellPatch::Kind::regular) {
        pieces.push_back(piece);
      } else {
        left.push_back(c);
      }
    }
    for (const Piece& piece : pieces) {
      std::vector<Piece> parts;
      if (depth == 0 || has_crease_corner(piece)) {
        divide(piece, corner_halvings, parts);
      } else {
        parts.push_back(piece);
      }
      for (const Piece& part : parts) {
        for (const dvec3& p : inner_points(part)) of_limit_.meet(p);
      }
      for (const dvec3& p : lattice(piece, samples)) of_caps_.know(p);
    }
    const std::vector<dvec3> rest = below.enclosure(left);
    const bool ends = depth + 1 == levels_below ||
                      std::all_of(rest.begin(), rest.end(),
                                  [&](const dvec3& p) { return of_limit_.is_within(p, small); });
    if (ends) {
      for (const dvec3& p : rest) of_limit_.meet(p);
      break;
    }
    below = below.refined(left, middles);
  }
}

void Comparison::meet_caps() {
  for (const Piece& cap : caps_) {
    for (const dvec3& p : inner_points(cap)) of_caps_.meet(p);
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
                    const std::vector<CellPatch>& patches, const std::vector<dvec3>& known,
                    double enough, const Progress& progress, bool least) {
  const double limit = least ? std::numeric_limits<double>::infinity() : enough;
  Bound plain(known, limit, progress);
  for (const dvec3& p : level.enclosure(region)) plain.meet(p);
  for (const std::size_t c : region) {
    for (const dvec3& p : patches[c].points) plain.meet(p);
  }
  const SharpSides sharp = sharp_sides(level, region, patches);
  const bool creases = sharp.creases == sharp.count;
  const bool may_gain = sharp.count > 0 || least;
  if (plain.value() <= enough || !may_gain) return plain.value();
  Comparison comparison(known, creases, limit, progress);
  comparison.take_caps(level, region, patches);
  comparison.take_limit(level, region, enough);
  if (comparison.value() <= limit) comparison.meet_caps();
  const double gap = creases ? side_gap(level, region, patches) : 0;
  return std::min(plain.value(), comparison.value() + gap);
}

}  // namespace taut
