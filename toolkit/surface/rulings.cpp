#include "taut/surface/rulings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

/// Curvatures below this, as a share of the second derivatives, have no direction to tell.
constexpr double flat_share = 1e-9;
/// How far from a flat point its ruling is taken from those on both sides.
constexpr double aside = 1e-3;
/// Largest step along a ruling, in parameters.
constexpr double stride = 0.1;
constexpr int step_limit = 200;
constexpr int newton_limit = 8;
constexpr int halving_limit = 20;
/// What points may be off a line, as a share of the control points' extent, and how far from where
/// they were predicted they may be, as a share of the step.
constexpr double missed_line = 1e-12;
constexpr double least_share = 0.1;
/// Sine of the angle between segments of one line.
constexpr double same_line = 1e-6;
/// Those shorter than this share of the part have no direction.
constexpr double shortest = 1e-10;
/// Parameters so near to a side's are at it.
constexpr double at_side = 1e-9;
/// Patches that a line passes at most.
constexpr std::size_t path_limit = 1000;
/// Steps that lead away from a border at a smaller share of their length run along it.
constexpr double along_border = 1e-9;

/// Of what second derivatives come to, relative to the control points' coordinates and the factors
/// of the degrees: their differences double those twice, and evaluation adds as much again.
constexpr double jet_rounding = 8 * std::numeric_limits<double>::epsilon();

/// The direction in which the second fundamental form vanishes. None where all of it does.
std::optional<RulingDirection> null_direction(const BezierPatch& patch, const dvec2& uv) {
  const PatchJet2 j = jet2(patch, uv.x, uv.y);
  const dvec3 n = unit(glm::cross(j.Su, j.Sv));
  // By tangents of length one, so that parameters' speeds do not matter.
  const double a = glm::length(j.Su);
  const double b = glm::length(j.Sv);
  if (n == dvec3(0.0)) return std::nullopt;
  const double L = glm::dot(j.Suu, n) / (a * a);
  const double M = glm::dot(j.Suv, n) / (a * b);
  const double N = glm::dot(j.Svv, n) / (b * b);
  const double size =
      glm::length(j.Suu) / (a * a) + glm::length(j.Suv) / (a * b) + glm::length(j.Svv) / (b * b);
  const double curved = std::max(std::abs(L), std::abs(N));
  if (curved <= flat_share * size) return std::nullopt;
  const dvec3 u = j.Su / a;
  const dvec3 v = j.Sv / b;
  const dvec3 along = std::abs(L) >= std::abs(N) ? L * v - M * u : N * u - M * v;
  double extent = 0;
  for (const dvec4& p : patch.points) extent = std::max(extent, glm::length(euclidean(p)));
  const double p = patch.degree_u / a;
  const double q = patch.degree_v / b;
  const double rounding = jet_rounding * extent * (p * p + p * q + q * q);
  return RulingDirection{unit(along), rounding / glm::length(along)};
}

/// The direction of the ruling through the point, by the second fundamental form.
std::optional<RulingDirection> traced_direction(const BezierPatch& patch, const dvec2& uv) {
  if (const auto e = null_direction(patch, uv)) return e;
  for (const dvec2& off : {dvec2(aside, 0), dvec2(0, aside)}) {
    const auto a = null_direction(patch, uv - off);
    const auto b = null_direction(patch, uv + off);
    if (!a || !b) continue;
    const dvec3 sum = a->along + (glm::dot(a->along, b->along) < 0 ? -b->along : b->along);
    return RulingDirection{unit(sum), std::max(a->rounding, b->rounding)};
  }
  return std::nullopt;
}

/// Of the oblique line through the point: what was one before its control points were rounded has
/// the direction in which they are nearest to that.
std::optional<RulingDirection> oblique_direction(const Patch& patch, const dvec2& uv) {
  if (patch.ruled_obliquely) return traced_direction(patch.bezier, uv);
  return RulingDirection{patch.off_ruled.along, patch.off_ruled.turned};
}

/// Follows the line through a point of the patch, in its tangent plane there, which is that of all
/// of the ruling.
class RulingTrace {
 public:
  RulingTrace(const BezierPatch& patch, const dvec2& uv, const dvec3& direction)
      : patch_(patch), uv_(uv), along_(direction) {
    const PatchJet1 j = jet1(patch, uv.x, uv.y);
    x_ = j.S;
    Box box;
    for (const dvec4& p : patch.points) box.include(euclidean(p));
    size_ = diagonal(box);
    across_ = unit(glm::cross(glm::cross(j.Su, j.Sv), direction));
  }

  dvec2 end(double sense) const {
    dvec2 at = uv_;
    for (int k = 0; k < step_limit; ++k) {
      std::optional<dvec2> step = step_along(at, sense);
      if (!step) break;
      std::optional<Arrival> next = arrival(at, *step, sense);
      // Where the parametrisation is uneven, as at corners, long steps lead astray.
      for (int halvings = 0; !next && halvings < halving_limit; ++halvings) {
        *step *= 0.5;
        next = arrival(at, *step, sense);
      }
      if (!next) break;
      at = next->uv;
      if (next->border >= 0) break;
    }
    return at;
  }

 private:
  struct Arrival {
    dvec2 uv;
    int border;  ///< the parameter that is at its end; -1: the point is inside
  };

  /// Of the length of a stride. None where the parametrisation fails.
  std::optional<dvec2> step_along(const dvec2& at, double sense) const {
    const PatchJet1 j = jet1(patch_, at.x, at.y);
    const double ua = glm::dot(j.Su, along_);
    const double va = glm::dot(j.Sv, along_);
    const double ub = glm::dot(j.Su, across_);
    const double vb = glm::dot(j.Sv, across_);
    const double determinant = ua * vb - va * ub;
    const dvec2 rate = dvec2(vb, -ub) * std::copysign(sense, sense * determinant);
    const double length = std::max(std::abs(rate.x), std::abs(rate.y));
    if (determinant == 0 || length == 0) return std::nullopt;
    return rate * (stride / length);
  }

  /// Where the step leads, on the line and no farther than the border. None if it misses the line.
  std::optional<Arrival> arrival(const dvec2& at, dvec2 step, double sense) const {
    double share = 1;
    int border = -1;
    for (int a = 0; a < 2; ++a) {
      const double room = step[a] < 0 ? at[a] : 1 - at[a];
      if (room <= 0 && std::abs(step[a]) <= along_border * stride) step[a] = 0;
      if (std::abs(step[a]) * share <= room) continue;
      share = room / std::abs(step[a]);
      border = a;
    }
    dvec2 uv = glm::clamp(at + share * step, dvec2(0.0), dvec2(1.0));
    if (border >= 0) uv[border] = step[border] > 0 ? 1 : 0;
    const dvec2 predicted = uv;
    for (int k = 0; k < newton_limit; ++k) {
      const dvec2 before = uv;
      correct(uv, border);
      if (uv == before) break;
    }
    const dvec3 x = point(patch_, uv.x, uv.y);
    const double moved = sense * glm::dot(x - point(patch_, at.x, at.y), along_);
    const bool on_line = std::abs(glm::dot(x - x_, across_)) <= missed_line * size_;
    const bool near = glm::distance(uv, predicted) <= stride * std::max(share, least_share);
    if (!on_line || !near || moved < -missed_line * size_) return std::nullopt;
    return Arrival{uv, border};
  }

  /// Moves the point towards the line; on a border along it.
  void correct(dvec2& at, int border) const {
    const PatchJet1 j = jet1(patch_, at.x, at.y);
    dvec2 slope(glm::dot(j.Su, across_), glm::dot(j.Sv, across_));
    if (border >= 0) {
      const dvec3& along = border == 0 ? j.Sv : j.Su;
      slope[border] = 0;
      if (glm::length(slope) <= along_border * glm::length(along)) return;
    }
    const double square = glm::dot(slope, slope);
    if (square == 0) return;
    at = glm::clamp(at - slope * (glm::dot(j.S - x_, across_) / square), dvec2(0.0), dvec2(1.0));
  }

  const BezierPatch& patch_;
  const dvec2 uv_;
  double size_ = 0;
  dvec3 x_;
  dvec3 along_, across_;
};

/// Its ends, on the patch's border.
std::optional<std::array<dvec2, 2>> ends_in(const BezierPatch& patch, const dvec2& uv,
                                            const std::optional<RulingDirection>& direction) {
  if (!direction) return std::nullopt;
  const RulingTrace trace(patch, uv, direction->along);
  return std::array<dvec2, 2>{trace.end(-1), trace.end(1)};
}

/// Ends of segments through the point, that in the direction among them if there is one.
std::vector<dvec2> ends_along(const Patch& patch, const dvec2& uv, const dvec3& along,
                              double bent) {
  const RuledLines lines = patch.lines(bent);
  std::vector<dvec2> ends;
  if (lines.v) ends.insert(ends.end(), {dvec2(uv.x, 0), dvec2(uv.x, 1)});
  if (lines.u) ends.insert(ends.end(), {dvec2(0, uv.y), dvec2(1, uv.y)});
  if (!lines.oblique) return ends;
  if (const auto direction = oblique_direction(patch, uv)) {
    const double sense = glm::dot(direction->along, along) < 0 ? -1 : 1;
    ends.push_back(RulingTrace(patch.bezier, uv, direction->along).end(sense));
  }
  return ends;
}

/// The end of a segment through the point in the direction.
std::optional<PatchPoint> end_along(const Part& part, const PatchPoint& at, const dvec3& along,
                                    double bent) {
  const double least = shortest * diagonal(part.control_box());
  const dvec3 x = point(part, at);
  for (const dvec2& uv : ends_along(part.patches()[std::size_t(at.patch)], at.uv, along, bent)) {
    const PatchPoint end{at.patch, uv};
    const dvec3 way = point(part, end) - x;
    const double length = glm::length(way);
    if (length <= least) continue;
    if (glm::distance(unit(way), along) < same_line + 2 * bent / length) return end;
  }
  return std::nullopt;
}

/// The point in all the ruled patches about it that smooth joins lead to, beginning with its own.
std::vector<PatchPoint> about(const Part& part, const PatchPoint& at, double bent) {
  std::vector<PatchPoint> all = {at};
  for (std::size_t k = 0; k < all.size(); ++k) {
    const dvec2 uv = all[k].uv;
    const Patch& patch = part.patches()[std::size_t(all[k].patch)];
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      if (border.kind != BorderKind::smooth || border.piece >= 0) continue;
      if (std::abs((along_v(side) ? uv.x : uv.y) - (at_upper_end(side) ? 1 : 0)) > at_side)
        continue;
      const double t = std::clamp(along_v(side) ? uv.y : uv.x, 0.0, 1.0);
      const PatchPoint over{border.neighbor,
                            on_side(border.neighbor_side, border.reversed ? 1 - t : t)};
      const bool known = std::any_of(all.begin(), all.end(),
                                     [&](const PatchPoint& p) { return p.patch == over.patch; });
      if (!known && part.patches()[std::size_t(over.patch)].lines(bent).any()) all.push_back(over);
    }
  }
  return all;
}

}  // namespace

std::optional<std::array<dvec2, 2>> ruling_ends(const BezierPatch& patch, const dvec2& uv) {
  return ends_in(patch, uv, traced_direction(patch, uv));
}

std::vector<std::array<dvec2, 2>> rulings(const Patch& patch, const dvec2& uv, double bent) {
  const RuledLines lines = patch.lines(bent);
  std::vector<std::array<dvec2, 2>> result;
  if (lines.v) result.push_back({dvec2(uv.x, 0), dvec2(uv.x, 1)});
  if (lines.u) result.push_back({dvec2(0, uv.y), dvec2(1, uv.y)});
  if (!lines.oblique) return result;
  const auto ends = ends_in(patch.bezier, uv, oblique_direction(patch, uv));
  if (ends) result.push_back(*ends);
  return result;
}

std::optional<RulingDirection> ruling_at(const Patch& patch, const dvec2& uv, double bent) {
  const RuledLines lines = patch.lines(bent);
  if (lines.oblique) return oblique_direction(patch, uv);
  const std::vector<std::array<dvec2, 2>> all = rulings(patch, uv, bent);
  if (all.size() != 1) return std::nullopt;
  const auto at = [&](const dvec2& end) { return point(patch.bezier, end.x, end.y); };
  const dvec3 way = at(all[0][1]) - at(all[0][0]);
  if (unit(way) == dvec3(0.0)) return std::nullopt;
  return RulingDirection{unit(way), 2 * bent / glm::length(way)};
}

std::optional<dvec3> ruling_direction(const Patch& patch, const dvec2& uv) {
  const std::optional<RulingDirection> ruling = ruling_at(patch, uv);
  return ruling ? std::optional(ruling->along) : std::nullopt;
}

dvec3 point(const Part& part, const PatchPoint& at) {
  return point(part.patches()[std::size_t(at.patch)].bezier, at.uv.x, at.uv.y);
}

std::vector<PatchPoint> ruling_path(const Part& part, const PatchPoint& from, const dvec3& along,
                                    double bent) {
  std::vector<PatchPoint> path;
  PatchPoint at = from;
  while (path.size() < path_limit) {
    std::optional<PatchPoint> next;
    for (const PatchPoint& p : about(part, at, bent)) {
      next = end_along(part, p, along, bent);
      if (next) break;
    }
    if (!next) break;
    path.push_back(*next);
    at = *next;
  }
  return path;
}

}  // namespace taut
