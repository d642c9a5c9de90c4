#include "taut/verify/document_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "taut/core/integers.h"
#include "taut/core/parallel.h"
#include "taut/verify/closest_on_curve.h"
#include "taut/verify/integral.h"
#include "taut/verify/stated_bounds.h"

namespace taut {
namespace {

using DirectedCurve = HullDocument::DirectedCurve;
using Face = HullDocument::Face;

/// Of integrals along outlines and rulings, and of those across patches from them, in units of the
/// diagonal; what differs by less does so by rounding.
constexpr IntegralAccuracy along_accuracy = {1e-12, 1e-13, 60};
constexpr IntegralAccuracy across_accuracy = {1e-12, 1e-14, 15};

/// Shares of the step at which borders and the best fit are measured.
constexpr double borders_share = 0.5;
constexpr double best_share = 0.75;

/// Points of a curve that its interpolating polynomials go through, and those of a worse one that
/// tells the error.
constexpr std::size_t window(Fit fit) { return fit == Fit::best ? 6 : 4; }

/// Cosine of the angle between neighbouring chords from which on there is a kink.
constexpr double kink = 0.9;

/// What is integrated over faces, in units of the diagonal: curvature is the mean one, and what
/// creases have of it; length, that of outlines, is for comparison.
enum : std::size_t { volume, area, area_x, area_y, area_z, curvature, outline_length, term_count };
using Terms = IntegralSums<term_count>;

void add_vector_area(Terms& terms, const dvec3& A) {
  terms.value[area_x] += A.x;
  terms.value[area_y] += A.y;
  terms.value[area_z] += A.z;
}

double length_of(const std::vector<dvec3>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += glm::distance(points[k - 1], points[k]);
  return length;
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
  MeasureSums(const DocumentGeometry& geometry, const DocumentOutlines& outlines, Fit fit);
  /// What regions have along sides of Bezier patches, whatever the fit.
  Terms of_borders(const VerifyOptions& options) const;
  /// All, with what they have along borders.
  DocumentMeasures run(const Terms& borders, const Progress& progress);
  /// Something was interpolated of which a worse fit tells the error.
  bool interpolated() const { return interpolated_; }

 private:
  /// Where integrals across a region begin.
  double base_of(const RegionOutline& outline) const;
  void add_fitted(const RegionOutline& outline);
  Terms border_terms(const RegionOutline& outline) const;
  void add_free_stretch(const RegionOutline& outline, const OutlineStretch& stretch);
  void add_track(const RegionOutline& outline, const OutlineStretch& stretch);
  Terms region_terms(const RegionOutline& outline, const dvec2& t, const dvec2& dt) const;
  Terms patch_terms(const SourceJet& j, int sign) const;
  void add_scroll(const Face& face, const std::vector<RulingInterval>& intervals);
  Terms scroll_terms(const RulingInterval& interval, const std::array<RulingState, 2>& at) const;
  void add_end(const HullDocument::Ruling& ruling, bool last);
  void add_facet(const Face& face);
  Terms facet_side(const DirectedCurve& side, const dvec3& normal);
  std::optional<EdgePart> edge_between(const HullDocument::Curve& curve, const dvec3& p,
                                       const dvec3& q) const;
  static Terms outline_terms(const dvec3& x, const dvec3& dx, const dvec3& n);
  /// Relative to a point inside, in units of the diagonal.
  dvec3 from_inside(const dvec3& p) const { return placed(geometry_.local(p)); }
  dvec3 placed(const dvec3& local) const { return (local - inside_) / unit_; }
  template <class Function>
  void add(double from, double to, const Function& f) {
    integrate(f, from, to, along_accuracy, sums_);
  }
  /// Whether this is interpolated is noted.
  void see(const RulingInterval& interval);

  const DocumentGeometry& geometry_;
  const DocumentOutlines& outlines_;
  double unit_;
  dvec3 inside_ = dvec3(0.0);  ///< relative to the origin
  Terms sums_;
  Fit fit_;
  bool interpolated_ = false;
  /// What the vector area lacks by facets' outlines off their planes, and the volume between
  /// facets and scrolls and others that the bounds allow.
  double open_ = 0, between_ = 0;
};

MeasureSums::MeasureSums(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                         Fit fit)
    : geometry_(geometry),
      outlines_(outlines),
      unit_(geometry.hull().diagonal > 0 ? geometry.hull().diagonal : 1),
      fit_(fit) {
  double count = 0;
  const auto add_point = [&](const dvec3& p) {
    inside_ += geometry.local(p);
    count += 1;
  };
  for (const HullDocument::Curve& curve : geometry.hull().curves) {
    for (const dvec3& p : curve.points) add_point(p);
  }
  // A patch without outlines is all that there is; its control points are about it.
  for (const HullDocument::Source& source : geometry.hull().sources) {
    if (!geometry.hull().curves.empty()) break;
    for (const HullDocument::Patch& patch : source.patches) {
      for (const dvec4& p : patch.points) add_point(dvec3(p));
    }
  }
  if (count > 0) inside_ /= count;
}

Terms MeasureSums::of_borders(const VerifyOptions& options) const {
  const std::vector<RegionOutline>& regions = outlines_.regions();
  std::vector<Terms> terms(regions.size());
  constexpr std::size_t grain = 16;
  parallel_for(
      regions.size(), grain, options.threads,
      [&](std::size_t begin, std::size_t end) {
        options.progress.check();
        for (std::size_t k = begin; k < end; ++k) terms[k] = border_terms(regions[k]);
      },
      [&](std::size_t done) {
        options.progress.update("verify", double(done) / double(regions.size()));
      });
  Terms sum;
  for (const Terms& own : terms) sum.add(1, own);
  return sum;
}

DocumentMeasures MeasureSums::run(const Terms& borders, const Progress& progress) {
  sums_ = borders;
  const std::vector<Face>& faces = geometry_.hull().faces;
  WorkProgress told(progress, "verify", double(outlines_.regions().size() + faces.size()));
  for (const RegionOutline& region : outlines_.regions()) {
    add_fitted(region);
    told.add(1);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    told.add(1);
    if (faces[f].kind == FaceKind::scroll) add_scroll(faces[f], outlines_.intervals()[f]);
    if (faces[f].kind == FaceKind::facet) add_facet(faces[f]);
  }
  const auto share = [&](std::size_t i) { return sums_.error[i] / std::abs(sums_.value[i]); };
  const std::array<double, term_count>& value = sums_.value;
  DocumentMeasures measures;
  const bool is_planar = geometry_.hull().dimension == 2;
  // What lies in a plane encloses nothing, and is as wide, in the mean, as a quarter of its outline
  // is long.
  measures.volume = is_planar ? 0 : unit_ * unit_ * unit_ * value[volume];
  measures.area = unit_ * unit_ * value[area];
  measures.vector_area = unit_ * unit_ * dvec3(value[area_x], value[area_y], value[area_z]);
  measures.vector_area_bound = unit_ * unit_ * open_;
  measures.volume_bound = unit_ * unit_ * unit_ * between_;
  measures.mean_width = is_planar ? unit_ * value[outline_length] / 4
                                  : unit_ * value[curvature] / (2 * std::numbers::pi);
  measures.volume_error = is_planar ? 0 : share(volume);
  measures.area_error = share(area);
  measures.mean_width_error = share(is_planar ? outline_length : curvature);
  measures.vector_area_error =
      (sums_.error[area_x] + sums_.error[area_y] + sums_.error[area_z]) / std::abs(value[area]);
  return measures;
}

/// Along a piece of an outline that has its face to the left: half the angle between the face's
/// normal and what is outward there counts as mean curvature.
Terms MeasureSums::outline_terms(const dvec3& x, const dvec3& dx, const dvec3& n) {
  Terms terms;
  const double speed = glm::length(dx);
  if (speed == 0) return terms;
  const dvec3 along = dx / speed;
  const dvec3 outward = x - glm::dot(x, along) * along;
  const double angle = std::atan2(glm::dot(n, glm::cross(outward, along)), glm::dot(n, outward));
  terms.value[curvature] = 0.5 * speed * angle;
  terms.value[outline_length] = speed;
  return terms;
}

double MeasureSums::base_of(const RegionOutline& outline) const {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const Interval& u = geometry_.source(source).patches[to_size(outline.region->patch)].domain[0];
  const double middle = 0.5 * (outline.lower().x + outline.upper().x);
  return std::clamp((middle - u.lower) / (u.upper - u.lower), 0.0, 1.0);
}

void MeasureSums::add_fitted(const RegionOutline& outline) {
  for (const std::vector<OutlineStretch>& loop : outline.loops) {
    for (const OutlineStretch& stretch : loop) {
      if (stretch.kind == OutlineStretch::Kind::track) add_track(outline, stretch);
      if (stretch.kind == OutlineStretch::Kind::free) add_free_stretch(outline, stretch);
    }
  }
}

Terms MeasureSums::border_terms(const RegionOutline& outline) const {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  Terms sum;
  for (const std::vector<OutlineStretch>& loop : outline.loops) {
    for (const OutlineStretch& stretch : loop) {
      if (stretch.kind != OutlineStretch::Kind::border) continue;
      const dvec2 from = geometry_.place(source, outline.region->patch, stretch.from);
      const dvec2 side = geometry_.place(source, outline.region->patch, stretch.to) - from;
      const auto terms_at = [&](double s) { return region_terms(outline, from + s * side, side); };
      integrate(terms_at, 0, 1, along_accuracy, sum);
    }
  }
  return sum;
}

/// Of which only the points are known.
void MeasureSums::add_free_stretch(const RegionOutline& outline, const OutlineStretch& stretch) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  interpolated_ = true;
  std::vector<dvec3> points;
  points.reserve(stretch.line.size());
  for (const dvec2& p : stretch.line) {
    points.emplace_back(geometry_.place(source, outline.region->patch, p), 0);
  }
  const SmoothLine line(points, window(fit_));
  // Points that stand twice are one to it.
  if (line.segments() + 1 != points.size()) {
    const dvec2 from(points[stretch.place]);
    const dvec2 side = dvec2(points[stretch.place + 1]) - from;
    add(0, 1, [&](double s) { return region_terms(outline, from + s * side, side); });
    return;
  }
  add(line.from(stretch.place), line.to(stretch.place), [&](double s) {
    const auto [t, slope] = line.at(stretch.place, s);
    return region_terms(outline, dvec2(t), dvec2(slope));
  });
}

void MeasureSums::see(const RulingInterval& interval) {
  interpolated_ = interpolated_ || std::any_of(interval.panels.begin(), interval.panels.end(),
                                               [](const RulingPanel& p) { return !p.settled; });
}

/// Along a scroll's contact, which may be in the terms of another patch than the region.
void MeasureSums::add_track(const RegionOutline& outline, const OutlineStretch& stretch) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const RulingInterval& interval = *stretch.interval;
  const auto k = to_size(stretch.contact);
  see(interval);
  const dvec2 size = geometry_.domain_size(source, interval.patch[k]) /
                     geometry_.domain_size(source, outline.region->patch);
  for (const RulingPanel& panel : interval.panels) {
    const double from = stretch.reversed ? panel.to : panel.from;
    const double to = stretch.reversed ? panel.from : panel.to;
    add(from, to, [&](double s) {
      const auto [value, slope] = panel.at(s, fit_);
      const dvec2 uv = geometry_.parameters(source, {interval.patch[k], value.t[k]});
      return region_terms(outline, geometry_.place(source, outline.region->patch, uv),
                          slope.t[k] * size);
    });
  }
}

/// The region's integrals are those along its outline, counter-clockwise, of the integrals across
/// to it, dv.
Terms MeasureSums::region_terms(const RegionOutline& outline, const dvec2& t,
                                const dvec2& dt) const {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const int patch = outline.region->patch;
  const int sign = outline.region->sign;
  const SourceJet j = geometry_.jet(source, {patch, t});
  const dvec3 along = double(sign) * (dt.x * j.dx[0] + dt.y * j.dx[1]) / unit_;
  Terms terms = outline_terms(placed(j.x), along, geometry_.normal(source, {patch, t}, sign));
  if (dt.y == 0) return terms;
  Terms across;
  integrate(
      [&](double u) {
        return patch_terms(geometry_.jet(source, {patch, dvec2(u, t.y)}), sign);
      },
      base_of(outline), t.x, across_accuracy, across);
  terms.add(dt.y, across);
  return terms;
}

Terms MeasureSums::patch_terms(const SourceJet& j, int sign) const {
  Terms terms;
  const dvec3 du = j.dx[0] / unit_;
  const dvec3 dv = j.dx[1] / unit_;
  const dvec3 N = double(sign) * glm::cross(du, dv);
  const double square = glm::dot(N, N);
  if (square == 0) return terms;
  terms.value[volume] = glm::dot(placed(j.x), N) / 3;
  terms.value[area] = std::sqrt(square);
  add_vector_area(terms, N);
  // H dA = (E n - 2 F m + G l) / (2 |N|^2), l = -Suu . N / |N| and so on: positive where the
  // surface is convex (do Carmo 1976, section 3-3).
  const double form = glm::dot(du, du) * glm::dot(j.dyy, N) -
                      2 * glm::dot(du, dv) * glm::dot(j.dxy, N) +
                      glm::dot(dv, dv) * glm::dot(j.dxx, N);
  terms.value[curvature] = -form / unit_ / (2 * square);
  return terms;
}

void MeasureSums::add_scroll(const Face& face, const std::vector<RulingInterval>& intervals) {
  const double before = sums_.value[area];
  std::vector<bool> joined(face.rulings.size(), false);
  for (const RulingInterval& interval : intervals) {
    see(interval);
    joined[to_size(interval.ruling)] = true;
    for (const RulingPanel& panel : interval.panels) {
      add(panel.from, panel.to,
          [&](double s) { return scroll_terms(interval, panel.at(s, fit_)); });
    }
  }
  between_ += face.tolerant / unit_ * std::abs(sums_.value[area] - before);
  if (face.rulings.empty()) return;
  // One ruling in two terms, of which n may differ by a kink, ends the scroll on either side. A
  // closed one has no ends; where these are one they cancel anyway.
  for (std::size_t k = 0; k < face.rulings.size(); ++k) {
    if (joined[k]) continue;
    add_end(face.rulings[k], true);
    add_end(face.rulings[(k + 1) % face.rulings.size()], false);
  }
}

/// Along it, contact 0 has the scroll to the left. x = a + t (b - a), x_s x x_t is outward.
Terms MeasureSums::scroll_terms(const RulingInterval& interval,
                                const std::array<RulingState, 2>& at) const {
  const auto& [value, slope] = at;
  std::array<dvec3, 2> x, dx;
  for (std::size_t k = 0; k < 2; ++k) {
    const SourceJet j = geometry_.jet(interval.source[k], {interval.patch[k], value.t[k]});
    x[k] = placed(j.x);
    dx[k] = (slope.t[k].x * j.dx[0] + slope.t[k].y * j.dx[1]) / unit_;
  }
  const dvec3 n = unit(value.n);
  const dvec3 d = x[1] - x[0];
  const dvec3 A = glm::cross(0.5 * (dx[0] + dx[1]), d);
  Terms terms;
  terms.value[volume] = glm::dot(x[0], A) / 3;
  terms.value[area] = glm::dot(n, A);
  add_vector_area(terms, A);
  // Half the ruling's length times the turn about it, which may go back and forth by a little.
  terms.value[curvature] = 0.5 * glm::dot(slope.n, glm::cross(d, n));
  terms.add(1, outline_terms(x[0], dx[0], n));
  terms.add(1, outline_terms(x[1], -dx[1], n));
  return terms;
}

/// The last ruling from contact 0 to contact 1, the first one back.
void MeasureSums::add_end(const HullDocument::Ruling& ruling, bool last) {
  const dvec3 a = from_inside(ruling.a.p);
  const dvec3 side = from_inside(ruling.b.p) - a;
  add(0, 1, [&](double t) { return outline_terms(a + t * side, last ? side : -side, ruling.n); });
}

void MeasureSums::add_facet(const Face& face) {
  Terms sides;
  for (const DirectedCurve& c : face.outline) {
    sides.add(1, facet_side(c, face.normal));
    // Of the vector area of what spans the outline, half the integral of x cross dx, only the part
    // along the normal is summed up. What that leaves out is the vector area of the strip between
    // the outline and its projection, no larger than the height over the plane times the length.
    const HullDocument::Curve& curve = geometry_.hull().curves[to_size(c.first)];
    open_ += bound_of(geometry_.hull(), curve) * length_of(curve.points) / (unit_ * unit_);
  }
  const auto along_normal = [&](const std::array<double, term_count>& terms) {
    return glm::dot(dvec3(terms[area_x], terms[area_y], terms[area_z]), face.normal);
  };
  Terms whole;
  whole.value[area] = along_normal(sides.value);
  whole.error[area] = sides.error[area_x] + sides.error[area_y] + sides.error[area_z];
  add_vector_area(whole, whole.value[area] * face.normal);
  for (const std::size_t i : {curvature, outline_length}) {
    whole.value[i] = sides.value[i];
    whole.error[i] = sides.error[i];
  }
  if (!face.boundary.empty()) {
    const double height = glm::dot(from_inside(face.boundary[0]), face.normal);
    whole.value[volume] = whole.value[area] * height / 3;
    whole.error[volume] = whole.error[area] * std::abs(height) / 3;
  }
  sums_.add(1, whole);
  between_ += face.tolerant / unit_ * std::abs(whole.value[area]);
}

/// Its share of the facet's vector area, and its outline: along the model's edge between points of
/// it, else along what is interpolated.
Terms MeasureSums::facet_side(const DirectedCurve& side, const dvec3& normal) {
  const HullDocument::Curve& curve = geometry_.hull().curves[to_size(side.first)];
  std::vector<dvec3> points = curve.points;
  for (dvec3& p : points) p = from_inside(p);
  if (side.second < 0) std::reverse(points.begin(), points.end());
  const SmoothLine line(points, window(fit_));
  Terms sum;
  const auto terms_at = [&](const dvec3& x, const dvec3& dx) {
    Terms terms = outline_terms(x, dx, normal);
    add_vector_area(terms, 0.5 * glm::cross(x, dx));
    return terms;
  };
  for (std::size_t k = 0; k < line.segments(); ++k) {
    const auto on_edge = edge_between(curve, line.point(k), line.point(k + 1));
    if (on_edge) {
      const double sense =
          on_edge->from < on_edge->to ? 1 : -1;  // a length falls with no parameter
      const auto along_edge = [&](double t) {
        const SourceJet j = geometry_.jet(curve.source, {on_edge->patch, dvec2(t, 0)});
        Terms terms = terms_at(placed(j.x), j.dx[0] / unit_);
        terms.value[outline_length] *= sense;
        return terms;
      };
      integrate(along_edge, on_edge->from, on_edge->to, along_accuracy, sum);
      continue;
    }
    interpolated_ = interpolated_ || line.segments() > 1;
    const auto along_line = [&](double s) {
      const auto [x, dx] = line.at(k, s);
      return terms_at(x, dx);
    };
    integrate(along_line, line.from(k), line.to(k), along_accuracy, sum);
  }
  return sum;
}

/// The part of one of an edge's Bezier curves between two points, if both lie on it.
std::optional<MeasureSums::EdgePart> MeasureSums::edge_between(const HullDocument::Curve& curve,
                                                               const dvec3& p,
                                                               const dvec3& q) const {
  if (curve.kind != HullCurveKind::edge || curve.source < 0) return std::nullopt;
  if (geometry_.source(curve.source).kind != SourceKind::edge) return std::nullopt;
  const double near = geometry_.noise() * geometry_.hull().diagonal;
  const int pieces = int(geometry_.source(curve.source).patches.size());
  const auto local = [&](const dvec3& x) { return unit_ * x + inside_; };
  for (int i = 0; i < pieces; ++i) {
    const auto jet = [&](double t) { return geometry_.jet(curve.source, {i, dvec2(t, 0)}); };
    const ClosestOnCurve from = closest_on_curve(local(p), 0, 1, jet);
    if (!(from.distance <= near)) continue;
    const ClosestOnCurve to = closest_on_curve(local(q), 0, 1, jet);
    if (to.distance <= near && from.s != to.s) return EdgePart{i, from.s, to.s};
  }
  return std::nullopt;
}

}  // namespace

DocumentMeasures measure(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                         const VerifyOptions& options) {
  MeasureSums sums(geometry, outlines, Fit::best);
  VerifyOptions first = options;
  first.progress = options.progress.part(0, borders_share);
  const Terms borders = sums.of_borders(first);
  DocumentMeasures best = sums.run(borders, options.progress.part(borders_share, best_share));
  if (!sums.interpolated()) return best;
  const DocumentMeasures worse = MeasureSums(geometry, outlines, Fit::worse)
                                     .run(borders, options.progress.part(best_share, 1));
  // Where the curve is not as smooth as the polynomials suppose, both err by as much.
  constexpr double safety = 2;
  best.volume_error += safety * std::abs(worse.volume / best.volume - 1);
  best.area_error += safety * std::abs(worse.area / best.area - 1);
  best.mean_width_error += safety * std::abs(worse.mean_width / best.mean_width - 1);
  best.vector_area_error += safety * glm::length(worse.vector_area - best.vector_area) / best.area;
  return best;
}

}  // namespace taut
