#include "taut/verify/document_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "taut/hull/measure/quadrature.h"
#include "taut/verify/closest_on_curve.h"

namespace taut {
namespace {

using DirectedCurve = HullDocument::DirectedCurve;
using Face = HullDocument::Face;

/// Nodes along a stretch of an outline, and across a patch from it.
constexpr int along_nodes = 8;
constexpr int across_nodes = 16;

/// Points of a curve that its interpolating polynomials go through, and those of a worse one that
/// tells the error.
constexpr std::size_t best_window = 6;
constexpr std::size_t worse_window = 4;

/// Cosine of the angle between neighbouring chords from which on there is a kink.
constexpr double kink = 0.9;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

template <int nodes, class Function>
void for_gauss_nodes(double from, double to, const Function& f) {
  const GaussRule<nodes>& rule = GaussRule<nodes>::get();
  for (std::size_t i = 0; i < to_size(nodes); ++i) {
    f(from + (to - from) * rule.node[i], (to - from) * rule.weight[i]);
  }
}

/// A smooth curve through given points.
class SmoothLine {
 public:
  SmoothLine(const std::vector<dvec3>& points, std::size_t window);
  std::size_t segments() const { return points_.empty() ? 0 : points_.size() - 1; }
  const dvec3& point(std::size_t i) const { return points_[i]; }
  double from(std::size_t segment) const { return length_[segment]; }
  double to(std::size_t segment) const { return length_[segment + 1]; }
  /// Point and derivative at a length within the segment.
  std::array<dvec3, 2> at(std::size_t segment, double s) const;

 private:
  bool kinked(std::size_t i) const;

  std::size_t window_;
  std::vector<dvec3> points_;
  std::vector<double> length_;
  std::vector<std::size_t> first_, last_;  ///< per segment: what is smooth with it
};

SmoothLine::SmoothLine(const std::vector<dvec3>& points, std::size_t window) : window_(window) {
  points_.reserve(points.size());
  length_.reserve(points.size());
  for (const dvec3& p : points) {
    if (!points_.empty() && p == points_.back()) continue;
    length_.push_back(points_.empty() ? 0 : length_.back() + glm::distance(p, points_.back()));
    points_.push_back(p);
  }
  first_.resize(segments());
  last_.resize(segments());
  for (std::size_t k = 0; k < segments(); ++k) {
    first_[k] = k == 0 || kinked(k) ? k : first_[k - 1];
  }
  for (std::size_t k = segments(); k-- > 0;) {
    last_[k] = k + 1 == segments() || kinked(k + 1) ? k + 1 : last_[k + 1];
  }
}

bool SmoothLine::kinked(std::size_t i) const {
  const dvec3 before = points_[i] - points_[i - 1];
  const dvec3 after = points_[i + 1] - points_[i];
  return glm::dot(before, after) < kink * glm::length(before) * glm::length(after);
}

std::array<dvec3, 2> SmoothLine::at(std::size_t segment, double s) const {
  const std::size_t count = std::min(window_, last_[segment] - first_[segment] + 1);
  // The window's middle is the segment, as far as there are points.
  const std::size_t before = std::min(segment - first_[segment], count / 2 - (count > 1 ? 1 : 0));
  const std::size_t begin = std::min(segment - before, last_[segment] + 1 - count);
  dvec3 x(0.0), dx(0.0);
  for (std::size_t i = begin; i < begin + count; ++i) {
    double weight = 1, slope = 0;
    for (std::size_t j = begin; j < begin + count; ++j) {
      if (j == i) continue;
      const double step = 1 / (length_[i] - length_[j]);
      slope = (slope * (s - length_[j]) + weight) * step;
      weight *= (s - length_[j]) * step;
    }
    x += weight * points_[i];
    dx += slope * points_[i];
  }
  return {x, dx};
}

/// Sums up the faces' integrals.
class MeasureSums {
 public:
  /// Of a Bezier curve of an edge.
  struct EdgePart {
    int patch = -1;
    double from = 0;
    double to = 0;
  };
  MeasureSums(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
              std::size_t window);
  DocumentMeasures run(const Progress& progress);
  /// Something was interpolated.
  bool interpolated() const { return interpolated_; }

 private:
  void add_patch(const RegionOutline& outline);
  void add_stretch(const RegionOutline& outline, const OutlineStretch& stretch);
  std::optional<SmoothLine> smooth_line(const OutlineStretch& stretch, const dvec2& lower,
                                        const dvec2& size);
  void add_across(const RegionOutline& outline, const dvec2& t, double w);
  void add_patch_element(const SourceJet& j, int sign, double w);
  void add_scroll(const Face& face, const std::vector<RulingInterval>& intervals);
  void add_scroll_element(const RulingInterval& interval, double s, double w);
  void add_end(const HullDocument::Ruling& ruling, bool last);
  void add_facet(const Face& face);
  dvec3 facet_side(const DirectedCurve& side, const dvec3& normal);
  std::optional<EdgePart> edge_between(const HullDocument::Curve& curve, const dvec3& p,
                                       const dvec3& q) const;
  void add_outline(const dvec3& x, const dvec3& dx, const dvec3& n, double w);
  dvec3 from_inside(const dvec3& p) const { return geometry_.local(p) - inside_; }

  const DocumentGeometry& geometry_;
  const DocumentOutlines& outlines_;
  dvec3 inside_ = dvec3(0.0);  ///< relative to the origin
  double base_ = 0;            ///< where integrals across the region at hand begin
  DocumentMeasures sums_;
  double curvature_ = 0;
  std::size_t window_;
  bool interpolated_ = false;
};

MeasureSums::MeasureSums(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                         std::size_t window)
    : geometry_(geometry), outlines_(outlines), window_(window) {
  double count = 0;
  const auto add = [&](const dvec3& p) {
    inside_ += geometry.local(p);
    count += 1;
  };
  for (const HullDocument::Curve& curve : geometry.hull().curves) {
    for (const dvec3& p : curve.points) add(p);
  }
  // A patch without outlines is all that there is; its control points are about it.
  for (const HullDocument::Source& source : geometry.hull().sources) {
    if (!geometry.hull().curves.empty()) break;
    for (const HullDocument::Patch& patch : source.patches) {
      for (const dvec4& p : patch.points) add(dvec3(p));
    }
  }
  if (count > 0) inside_ /= count;
}

DocumentMeasures MeasureSums::run(const Progress& progress) {
  for (const RegionOutline& region : outlines_.regions()) {
    progress.check();
    add_patch(region);
  }
  const std::vector<Face>& faces = geometry_.hull().faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    progress.check();
    if (faces[f].kind == FaceKind::scroll) add_scroll(faces[f], outlines_.intervals()[f]);
    if (faces[f].kind == FaceKind::facet) add_facet(faces[f]);
  }
  sums_.mean_width = curvature_ / (2 * std::numbers::pi);
  return sums_;
}

/// A piece of an outline that has its face to the left, w dx: half the angle between the face's
/// normal and what is outward there counts as mean curvature.
void MeasureSums::add_outline(const dvec3& x, const dvec3& dx, const dvec3& n, double w) {
  const double speed = glm::length(dx);
  if (speed == 0) return;
  const dvec3 along = dx / speed;
  const dvec3 outward = x - glm::dot(x, along) * along;
  const double angle = std::atan2(glm::dot(n, glm::cross(outward, along)), glm::dot(n, outward));
  curvature_ += 0.5 * w * speed * angle;
}

void MeasureSums::add_patch(const RegionOutline& outline) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const Interval& u = geometry_.source(source).patches[to_size(outline.region->patch)].domain[0];
  const double middle = 0.5 * (outline.lower().x + outline.upper().x);
  base_ = std::clamp((middle - u.lower) / (u.upper - u.lower), 0.0, 1.0);
  for (const std::vector<OutlineStretch>& loop : outline.loops) {
    for (const OutlineStretch& stretch : loop) add_stretch(outline, stretch);
  }
}

/// Of a stretch of which only the points are known, in the Bezier patch's parameters.
std::optional<SmoothLine> MeasureSums::smooth_line(const OutlineStretch& stretch,
                                                   const dvec2& lower, const dvec2& size) {
  if (stretch.kind != OutlineStretch::Kind::free) return std::nullopt;
  interpolated_ = true;
  std::vector<dvec3> points;
  points.reserve(stretch.line.size());
  for (const dvec2& p : stretch.line) points.emplace_back((p - lower) / size, 0);
  const SmoothLine line(points, window_);
  // Points that stand twice are one to it.
  if (line.segments() + 1 != points.size()) return std::nullopt;
  return line;
}

/// The region's integrals are those along its outline, counter-clockwise, of the integrals across
/// to it, dv.
void MeasureSums::add_stretch(const RegionOutline& outline, const OutlineStretch& stretch) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const int sign = outline.region->sign;
  const std::vector<Interval>& domain =
      geometry_.source(source).patches[to_size(outline.region->patch)].domain;
  const dvec2 lower(domain[0].lower, domain[1].lower);
  const dvec2 size(domain[0].upper - lower.x, domain[1].upper - lower.y);
  const std::optional<SmoothLine> free = smooth_line(stretch, lower, size);
  for_gauss_nodes<along_nodes>(0, 1, [&](double s, double w) {
    SourcePlace place{outline.region->patch,
                      (stretch.from + s * (stretch.to - stretch.from) - lower) / size};
    dvec2 dt = (stretch.to - stretch.from) / size;
    if (free) {
      const double from = free->from(stretch.place);
      const double length = free->to(stretch.place) - from;
      const auto [t, slope] = free->at(stretch.place, from + s * length);
      place.t = dvec2(t);
      dt = length * dvec2(slope);
    }
    if (stretch.kind == OutlineStretch::Kind::track) {
      const RulingInterval& interval = *stretch.interval;
      const auto k = to_size(stretch.contact);
      const double at = stretch.reversed ? 1 - s : s;
      const SourcePlace on_track{interval.patch[k], interval.value(at).t[k]};
      const Interval& u = geometry_.source(source).patches[to_size(on_track.patch)].domain[0];
      const Interval& v = geometry_.source(source).patches[to_size(on_track.patch)].domain[1];
      place.t = (geometry_.parameters(source, on_track) - lower) / size;
      dt = (stretch.reversed ? -1.0 : 1.0) * interval.slope(at).t[k] *
           dvec2(u.upper - u.lower, v.upper - v.lower) / size;
    }
    if (dt.y != 0) add_across(outline, place.t, w * dt.y);
    const SourceJet j = geometry_.jet(source, place);
    const dvec3 n = geometry_.normal(source, place, sign);
    add_outline(j.x - inside_, double(sign) * (dt.x * j.dx[0] + dt.y * j.dx[1]), n, w);
  });
}

void MeasureSums::add_across(const RegionOutline& outline, const dvec2& t, double w) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  for_gauss_nodes<across_nodes>(base_, t.x, [&](double u, double wu) {
    const SourceJet j = geometry_.jet(source, {outline.region->patch, dvec2(u, t.y)});
    add_patch_element(j, outline.region->sign, w * wu);
  });
}

void MeasureSums::add_patch_element(const SourceJet& j, int sign, double w) {
  const dvec3 N = double(sign) * glm::cross(j.dx[0], j.dx[1]);
  const double square = glm::dot(N, N);
  if (square == 0) return;
  sums_.volume += w * glm::dot(j.x - inside_, N) / 3;
  sums_.area += w * std::sqrt(square);
  sums_.vector_area += w * N;
  // H dA = (E n - 2 F m + G l) / (2 |N|^2), l = -Suu . N / |N| and so on: positive where the
  // surface is convex (do Carmo 1976, section 3-3).
  const double form = glm::dot(j.dx[0], j.dx[0]) * glm::dot(j.dyy, N) -
                      2 * glm::dot(j.dx[0], j.dx[1]) * glm::dot(j.dxy, N) +
                      glm::dot(j.dx[1], j.dx[1]) * glm::dot(j.dxx, N);
  curvature_ -= w * form / (2 * square);
}

void MeasureSums::add_scroll(const Face& face, const std::vector<RulingInterval>& intervals) {
  for (const RulingInterval& interval : intervals) {
    for_gauss_nodes<along_nodes>(0, 1,
                                 [&](double s, double w) { add_scroll_element(interval, s, w); });
  }
  if (face.rulings.empty()) return;
  const HullDocument::Ruling& first = face.rulings.front();
  const HullDocument::Ruling& last = face.rulings.back();
  // A closed one has no ends; where these are one they cancel anyway.
  add_end(first, false);
  add_end(last, true);
}

/// Along it, contact 0 has the scroll to the left. x = a + t (b - a), x_s x x_t is outward.
void MeasureSums::add_scroll_element(const RulingInterval& interval, double s, double w) {
  const RulingState value = interval.value(s);
  const RulingState slope = interval.slope(s);
  std::array<dvec3, 2> x, dx;
  for (std::size_t k = 0; k < 2; ++k) {
    const SourceJet j = geometry_.jet(interval.source[k], {interval.patch[k], value.t[k]});
    x[k] = j.x - inside_;
    dx[k] = slope.t[k].x * j.dx[0] + slope.t[k].y * j.dx[1];
  }
  const dvec3 n = unit(value.n);
  const dvec3 d = x[1] - x[0];
  const dvec3 A = glm::cross(0.5 * (dx[0] + dx[1]), d);
  sums_.volume += w * glm::dot(x[0], A) / 3;
  sums_.area += w * glm::dot(n, A);
  sums_.vector_area += w * A;
  curvature_ += 0.5 * w * glm::length(d) * glm::length(slope.n - glm::dot(slope.n, n) * n);
  add_outline(x[0], dx[0], n, w);
  add_outline(x[1], -dx[1], n, w);
}

/// The last ruling from contact 0 to contact 1, the first one back.
void MeasureSums::add_end(const HullDocument::Ruling& ruling, bool last) {
  const dvec3 a = from_inside(ruling.a.p);
  const dvec3 side = from_inside(ruling.b.p) - a;
  for_gauss_nodes<across_nodes>(0, 1, [&](double t, double w) {
    add_outline(a + t * side, last ? side : -side, ruling.n, w);
  });
}

void MeasureSums::add_facet(const Face& face) {
  dvec3 area(0.0);
  for (const DirectedCurve& c : face.outline) area += facet_side(c, face.normal);
  const double size = glm::dot(area, face.normal);
  sums_.area += size;
  sums_.vector_area += size * face.normal;
  if (!face.boundary.empty()) {
    sums_.volume += size * glm::dot(from_inside(face.boundary[0]), face.normal) / 3;
  }
}

/// Its share of the facet's vector area: along the model's edge between points of it, else along
/// what is interpolated.
dvec3 MeasureSums::facet_side(const DirectedCurve& side, const dvec3& normal) {
  const HullDocument::Curve& curve = geometry_.hull().curves[to_size(side.first)];
  std::vector<dvec3> points = curve.points;
  for (dvec3& p : points) p = from_inside(p);
  if (side.second < 0) std::reverse(points.begin(), points.end());
  const SmoothLine line(points, window_);
  dvec3 area(0.0);
  const auto add = [&](const dvec3& x, const dvec3& dx, double w) {
    area += 0.5 * w * glm::cross(x, dx);
    add_outline(x, dx, normal, w);
  };
  for (std::size_t k = 0; k < line.segments(); ++k) {
    if (const auto on_edge = edge_between(curve, line.point(k), line.point(k + 1))) {
      for_gauss_nodes<across_nodes>(on_edge->from, on_edge->to, [&](double t, double w) {
        const SourceJet j = geometry_.jet(curve.source, {on_edge->patch, dvec2(t, 0)});
        add(j.x - inside_, j.dx[0], w);
      });
      continue;
    }
    interpolated_ = interpolated_ || line.segments() > 1;
    for_gauss_nodes<across_nodes>(line.from(k), line.to(k), [&](double s, double w) {
      const auto [x, dx] = line.at(k, s);
      add(x, dx, w);
    });
  }
  return area;
}

/// The part of one of an edge's Bezier curves between two points, if both lie on it.
std::optional<MeasureSums::EdgePart> MeasureSums::edge_between(const HullDocument::Curve& curve,
                                                               const dvec3& p,
                                                               const dvec3& q) const {
  if (curve.kind != HullCurveKind::edge || curve.source < 0) return std::nullopt;
  if (geometry_.source(curve.source).kind != SourceKind::edge) return std::nullopt;
  const double near = geometry_.noise() * geometry_.hull().diagonal;
  const int pieces = int(geometry_.source(curve.source).patches.size());
  for (int i = 0; i < pieces; ++i) {
    const auto jet = [&](double t) { return geometry_.jet(curve.source, {i, dvec2(t, 0)}); };
    const ClosestOnCurve from = closest_on_curve(p + inside_, 0, 1, jet);
    if (!(from.distance <= near)) continue;
    const ClosestOnCurve to = closest_on_curve(q + inside_, 0, 1, jet);
    if (to.distance <= near && from.s != to.s) return EdgePart{i, from.s, to.s};
  }
  return std::nullopt;
}

}  // namespace

DocumentMeasures measure(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                         const Progress& progress) {
  MeasureSums sums(geometry, outlines, best_window);
  DocumentMeasures best = sums.run(progress);
  if (!sums.interpolated()) return best;
  const DocumentMeasures worse = MeasureSums(geometry, outlines, worse_window).run(progress);
  // Where the curve is not as smooth as the polynomials suppose, both err by as much.
  constexpr double safety = 2;
  best.interpolation = safety * std::max({std::abs(worse.volume / best.volume - 1),
                                          std::abs(worse.area / best.area - 1),
                                          std::abs(worse.mean_width / best.mean_width - 1)});
  return best;
}

}  // namespace taut
