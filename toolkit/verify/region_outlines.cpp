#include "taut/verify/region_outlines.h"

#include <algorithm>
#include <limits>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Pieces that an interval of a track is refined into, times its panels.
constexpr int track_pieces = 4;

/// Nearer to an outline than this share of a Bezier patch's parameters nothing can be told: where
/// contacts are ill-conditioned, that is how far support queries find them off.
constexpr double near_outline = 1e-6;

/// How far beside the outline at a free end, which is interpolated, as a share of its pieces.
constexpr double near_guess = 0.25;

/// Beside a ruling's end the support exceeds the surface by the rate at which the ruling's other
/// end rises as the normal turns. As far as it exceeds it by so many times the slack of support
/// queries, but no farther than this, they cannot tell on which side of the outline a place lies.
constexpr double told_slacks = 4;
constexpr double farthest_untold = 0.25;

/// The same about a stretch that is neither a track nor along a side, of which only the ends are
/// known: outlines are smooth between points whose normals differ by up to 0.1.
constexpr double near_free_stretch = 0.02;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// d . dn as the place in a Bezier patch moves along its two parameters, for a vector d in the
/// tangent plane across n.
dvec2 turn_towards(const SourceJet& j, const dvec3& n, const dvec3& d) {
  const double uu = glm::dot(j.dx[0], j.dx[0]);
  const double uv = glm::dot(j.dx[0], j.dx[1]);
  const double vv = glm::dot(j.dx[1], j.dx[1]);
  const double det = uu * vv - uv * uv;
  if (!(det > 0)) return dvec2(0.0);
  const double du = glm::dot(d, j.dx[0]);
  const double dv = glm::dot(d, j.dx[1]);
  const double a = (vv * du - uv * dv) / det;
  const double b = (uu * dv - uv * du) / det;
  const double xy = glm::dot(j.dxy, n);
  return {-a * glm::dot(j.dxx, n) - b * xy, -a * xy - b * glm::dot(j.dyy, n)};
}

/// How far beside the track of contact k, as a share of its Bezier patch's parameters, support
/// values do not tell whether a place is on the hull.
double untold_distance(const DocumentGeometry& geometry, const RulingInterval& interval,
                       std::size_t k, const RulingState& at) {
  const auto jet = [&](std::size_t i) {
    return geometry.jet(interval.source[i], {interval.patch[i], at.t[i]});
  };
  const SourceJet own = jet(k);
  const dvec2 rise = turn_towards(own, unit(at.n), jet(1 - k).x - own.x);
  const double told = told_slacks * support_slack * geometry.hull().diagonal;
  const double steepest = glm::length(rise);
  return steepest > 0 ? std::min(told / steepest, farthest_untold) : farthest_untold;
}

}  // namespace

/// Crossings of the ray towards growing u, as seen from the place.
RegionOutline::Location RegionOutline::locate(const dvec2& uv) const {
  Location location;
  for (const Piece& piece : pieces_) {
    const dvec2 a = (piece.from - uv) / size_;
    const dvec2 side = (piece.to - piece.from) / size_;
    const double square = glm::dot(side, side);
    const double s = square > 0 ? std::clamp(-glm::dot(a, side) / square, 0.0, 1.0) : 0;
    if (glm::length(a + s * side) <= piece.slack) location.near = true;
    const dvec2 b = a + side;
    if ((a.y > 0) == (b.y > 0)) continue;
    if (a.x - a.y * side.x / side.y > 0) location.winding += b.y > a.y ? 1 : -1;
  }
  return location;
}

bool RegionOutline::may_contain(const dvec2& uv) const {
  if (!glm::all(glm::lessThanEqual(lower_, uv)) || !glm::all(glm::lessThanEqual(uv, upper_))) {
    return false;
  }
  const Location location = locate(uv);
  return location.near || location.winding != 0;
}

dvec2 RegionOutline::nearest(const dvec2& uv) const {
  if (pieces_.empty()) return uv;
  dvec2 best = pieces_.front().from;
  for (const Piece& piece : pieces_) {
    const dvec2 a = (piece.from - uv) / size_;
    const dvec2 side = (piece.to - piece.from) / size_;
    const double square = glm::dot(side, side);
    const double s = square > 0 ? std::clamp(-glm::dot(a, side) / square, 0.0, 1.0) : 0;
    const dvec2 there = glm::mix(piece.from, piece.to, s);
    if (glm::length((there - uv) / size_) < glm::length((best - uv) / size_)) best = there;
  }
  return best;
}

double RegionOutline::area() const {
  double sum = 0;
  for (const Piece& piece : pieces_) {
    sum += cross(piece.from - lower_, piece.to - lower_) / 2;
  }
  return sum;
}

void RegionOutline::refine(const DocumentGeometry& geometry, int source) {
  const HullDocument::Patch& patch = geometry.source(source).patches[to_size(region->patch)];
  size_ = {patch.domain[0].upper - patch.domain[0].lower,
           patch.domain[1].upper - patch.domain[1].lower};
  const auto on_track = [&](const OutlineStretch& stretch, double s) {
    const RulingInterval& interval = *stretch.interval;
    const auto k = to_size(stretch.contact);
    const dvec2 t = interval.value(stretch.reversed ? 1 - s : s).t[k];
    return geometry.parameters(source, {interval.patch[k], t});
  };
  const auto untold = [&](const OutlineStretch& stretch, double s) {
    const RulingInterval& interval = *stretch.interval;
    const RulingState at = interval.value(stretch.reversed ? 1 - s : s);
    return untold_distance(geometry, interval, to_size(stretch.contact), at);
  };
  for (const std::vector<OutlineStretch>& loop : loops) {
    for (const OutlineStretch& stretch : loop) {
      if (stretch.kind != OutlineStretch::Kind::track) {
        pieces_.push_back(
            {stretch.from, stretch.to,
             stretch.kind == OutlineStretch::Kind::free ? near_free_stretch : near_outline});
        continue;
      }
      dvec2 from = stretch.from;
      const int pieces = track_pieces * int(stretch.interval->panels.size());
      for (int i = 1; i <= pieces; ++i) {
        const double s = double(i) / pieces;
        const dvec2 to = i == pieces ? stretch.to : on_track(stretch, s);
        const dvec2 middle = on_track(stretch, s - 0.5 / pieces);
        const double sagitta = glm::length((middle - 0.5 * (from + to)) / size_);
        double slack = 2 * sagitta + near_outline + untold(stretch, s - 0.5 / pieces);
        if (!stretch.interval->solved) slack += near_guess * glm::length((to - from) / size_);
        pieces_.push_back({from, to, slack});
        from = to;
      }
    }
  }
  lower_ = dvec2(std::numeric_limits<double>::infinity());
  upper_ = -lower_;
  for (const Piece& piece : pieces_) {
    lower_ = glm::min(lower_, piece.from - piece.slack * size_);
    upper_ = glm::max(upper_, piece.from + piece.slack * size_);
  }
}

DocumentOutlines::DocumentOutlines(const DocumentGeometry& geometry) : geometry_(geometry) {
  const HullDocument& hull = geometry.hull();
  const DocumentRulings rulings(geometry);
  intervals_.reserve(hull.faces.size());
  for (const HullDocument::Face& face : hull.faces) intervals_.push_back(rulings.intervals(face));
  add_tracks(geometry);
  add_regions(geometry);
}

void DocumentOutlines::add_tracks(const DocumentGeometry& geometry) {
  const HullDocument& hull = geometry.hull();
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    for (const RulingInterval& interval : intervals_[f]) {
      const HullDocument::Ruling& from = hull.faces[f].rulings[to_size(interval.ruling)];
      const HullDocument::Ruling& to = hull.faces[f].rulings[to_size(interval.ruling) + 1];
      for (int k = 0; k < 2; ++k) {
        const HullDocument::Contact& a = k == 0 ? from.a : from.b;
        const HullDocument::Contact& b = k == 0 ? to.a : to.b;
        if (geometry.source(a.source).kind != SourceKind::face) continue;
        const dvec2 p = parameters(a);
        const dvec2 q = parameters(b);
        OutlineStretch s{OutlineStretch::Kind::track, p, q, &interval, k, false, {}, 0};
        tracks_.try_emplace({double(a.source), p.x, p.y, q.x, q.y}, s);
        s = {OutlineStretch::Kind::track, q, p, &interval, k, true, {}, 0};
        tracks_.try_emplace({double(a.source), q.x, q.y, p.x, p.y}, s);
      }
    }
  }
}

std::optional<OutlineStretch> DocumentOutlines::border(int source, const dvec2& from,
                                                       const dvec2& to) const {
  const auto along_side = [&](const HullDocument::Patch& patch) {
    for (int k = 0; k < 2; ++k) {
      const Interval& domain = patch.domain[to_size(k)];
      if (from[k] == to[k] && (from[k] == domain.lower || from[k] == domain.upper)) return true;
    }
    return false;
  };
  const std::vector<HullDocument::Patch>& patches = geometry_.source(source).patches;
  const double size = std::max(1.0, std::max(glm::length(from), glm::length(to)));
  // No longer than this where it passes from one Bezier patch into another.
  const bool short_one = glm::distance(from, to) <= geometry_.noise() * size;
  if (!short_one && std::none_of(patches.begin(), patches.end(), along_side)) return std::nullopt;
  OutlineStretch stretch;
  stretch.kind = OutlineStretch::Kind::border;
  stretch.from = from;
  stretch.to = to;
  return stretch;
}

OutlineStretch DocumentOutlines::stretch(int source, const dvec2& from, const dvec2& to) const {
  const auto track = tracks_.find({double(source), from.x, from.y, to.x, to.y});
  if (track != tracks_.end()) return track->second;
  if (const auto along_side = border(source, from, to)) return *along_side;
  OutlineStretch stretch;
  stretch.from = from;
  stretch.to = to;
  return stretch;
}

void DocumentOutlines::add_regions(const DocumentGeometry& geometry) {
  const HullDocument& hull = geometry.hull();
  regions_of_.resize(hull.sources.size());
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const HullDocument::Face& face = hull.faces[f];
    for (const HullDocument::Region& region : face.regions) {
      RegionOutline outline;
      outline.face = int(f);
      outline.region = &region;
      for (const std::vector<dvec2>& line : region.loops) {
        std::vector<OutlineStretch>& loop = outline.loops.emplace_back();
        loop.reserve(line.size());
        for (std::size_t k = 0; k < line.size(); ++k) {
          loop.push_back(stretch(face.source, line[k], line[(k + 1) % line.size()]));
        }
      }
      for (std::vector<OutlineStretch>& loop : outline.loops) join_free_stretches(loop);
      outline.refine(geometry, face.source);
      regions_of_[to_size(face.source)].push_back(int(regions_.size()));
      regions_.push_back(std::move(outline));
    }
  }
}

void DocumentOutlines::join_free_stretches(std::vector<OutlineStretch>& loop) {
  for (std::size_t first = 0; first < loop.size();) {
    std::size_t last = first;
    std::vector<dvec2> line = {loop[first].from};
    while (last < loop.size() && loop[last].kind == OutlineStretch::Kind::free) {
      line.push_back(loop[last++].to);
    }
    for (std::size_t k = first; k < last; ++k) {
      loop[k].line = line;
      loop[k].place = k - first;
    }
    first = std::max(last, first + 1);
  }
}

const std::vector<int>& DocumentOutlines::regions_of(int source) const {
  return regions_of_[to_size(source)];
}

bool DocumentOutlines::covers(int source, const dvec2& uv) const {
  const std::vector<int>& places = regions_of(source);
  return std::any_of(places.begin(), places.end(),
                     [&](int i) { return regions_[to_size(i)].may_contain(uv); });
}

}  // namespace taut
