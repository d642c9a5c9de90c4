#include "taut/hull/measure/boundary_measures.h"

#include <cmath>
#include <numbers>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/measure/arc_joints.h"
#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/measure/crease_origins.h"
#include "taut/hull/measure/facet_integrals.h"
#include "taut/hull/measure/flat_measures.h"
#include "taut/hull/measure/gauss_nodes.h"
#include "taut/hull/measure/green_regions.h"
#include "taut/hull/measure/interior_point.h"
#include "taut/hull/measure/measure_bounds.h"
#include "taut/hull/measure/ruling_ways.h"

namespace taut {
namespace {

/// By how much the sums that are accurate for measures may miss the way of a contact itself, in the
/// scene's frame: 1e-8 beside free ends of blobs.
constexpr double quadrature_way = 1e-6;

/// Exact rulings are led from one to another if they miss them by no more than this share of the
/// way: by more they are those of other contacts.
constexpr double farthest_led = 0.1;

/// Lines along which, in the patch's parameter, some are enough.
constexpr double short_line = 0.25;

/// What it takes to measure a boundary: its rulings and regions, a few integrals each.
double work_of_measures(const HullBoundary& boundary) {
  double work = 0;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) work += double(piece.rulings.size());
  }
  for (const HullFace& face : boundary.faces) work += double(face.regions.size());
  return work;
}

/// The integrals over a whole boundary, in the scene's frame.
class Summation {
 public:
  Summation(const ContactGeometry& geometry, const HullBoundary& boundary, const Progress& progress)
      : geometry_(geometry),
        system_(geometry),
        boundary_(boundary),
        origin_(interior_point(geometry, boundary)),
        creases_(geometry, boundary, origin_),
        regions_(geometry, boundary),
        in_scroll_(pieces_of_scrolls(boundary)) {
    WorkProgress share(progress, "measure", work_of_measures(boundary));
    for (std::size_t a = 0; a < boundary.arcs.size(); ++a) {
      for (std::size_t p = 0; p < boundary.arcs[a].pieces.size(); ++p) {
        const long double before = sums_.value[ruled];
        const double depth = place_depth(boundary, boundary.arcs[a].pieces[p].tolerant);
        if (in_scroll_[a][p]) add_piece(a, p, depth);
        layer_ += depth * std::abs(double(sums_.value[ruled] - before));
        share.add(double(boundary.arcs[a].pieces[p].rulings.size()));
      }
      add_creases(boundary.arcs[a], in_scroll_[a], sums_);
    }
    for (const GreenRegion& region : regions_.all()) {
      share.add(1);
      for (const std::vector<TrimStretch>& loop : region.region->loops) {
        for (const TrimStretch& stretch : loop) {
          if (stretch.arc < 0) add_border(region, stretch);
        }
      }
    }
    double patch_depth = boundary.gap;
    for (const HullFace& face : boundary.faces) {
      if (face.kind == FaceKind::patch) patch_depth = std::max(patch_depth, face.tolerant);
    }
    layer_ += patch_depth * std::max(double(sums_.value[area] - sums_.value[ruled]), 0.0);
    // What spans the outline of a facet is as far from its plane again.
    const double off_plane = is_polyhedron(boundary) ? 1 : 2;
    for (const HullFace& face : boundary.faces) {
      if (face.kind != FaceKind::facet) continue;
      const long double before = sums_.value[area];
      add_facet(geometry, face, origin_, creases_, sums_);
      const double own = double(sums_.value[area] - before);
      layer_ += off_plane * place_depth(boundary, face.tolerant) * std::abs(own);
    }
    if (is_polyhedron(boundary)) add_creases(boundary, sums_);
    add_joints(boundary, in_scroll_, sums_);
  }

  const dvec3& origin() const { return origin_; }
  /// See MeasuredLengths.
  double layer() const { return layer_; }
  const Sums& sums() const { return sums_; }

 private:
  /// What lies along rulings between two.
  struct Stretch {
    bool scroll = false;
    double depth = 0;  ///< as place_depth() has it
    const std::vector<ArcTrace>* traces = nullptr;
  };

  void add_piece(std::size_t arc, std::size_t piece, double depth);
  void add_between(const Stretch& at, const Ruling& from, const Ruling& to);
  std::array<dvec3, 2> moved_since(const Sums& before) const;
  void add_missed_turn(const Sums& before, const Ruling& from, const Ruling& to);
  bool add_led(const Stretch& at, const LedRulings& led);
  void add_ways(const Stretch& at, const std::vector<RulingWay>& ways);
  void add_exact(const Stretch& at, const RulingsBetween& between);
  void add_ruling(const Stretch& at, const MovingRuling& m, double weight, Quantities& sample);
  bool bounds_normals(const GreenRegion& region, const TrimStretch& stretch) const;
  bool bounds_region(const TrimStretch& stretch) const;
  void add_border(const GreenRegion& region, const TrimStretch& stretch);

  void add_scroll(const MovingRuling& m, Quantities& sum) const;
  void add_to_line(const GreenRegion& region, const dvec2& p, double at, Quantities& sample) const;
  int enough_nodes(const GreenRegion& region, const TrimStretch& stretch) const;
  void add_line(const GreenRegion& region, const dvec2& p, const dvec2& rate, double weight,
                Quantities& sum, int nodes);

  const ContactGeometry& geometry_;
  ContactSystem system_;
  const HullBoundary& boundary_;
  dvec3 origin_;
  CreaseOrigins creases_;
  GreenRegions regions_;
  ScrollPieces in_scroll_;
  Sums sums_;
  double layer_ = 0;
};

/// The integrands on the line from the base to p, where the inner parameter is `at`.
void Summation::add_to_line(const GreenRegion& region, const dvec2& p, double at,
                            Quantities& sample) const {
  const Contact c = region.inner == 0 ? region.contact(at, p.y) : region.contact(p.x, at);
  add_patch(geometry_.jet(c), origin_, region.region->sign, sample);
}

/// Of the first rule that is accurate on the line to the stretch's middle. On the stretch's other
/// lines it will then be accurate too, or halve the lines.
int Summation::enough_nodes(const GreenRegion& region, const TrimStretch& stretch) const {
  const dvec2 p = on_side(stretch.side, 0.5 * (stretch.from + stretch.to));
  int samples = 0;
  const auto f = [&](double at, double, Quantities& sample) {
    ++samples;
    add_to_line(region, p, at, sample);
  };
  for (const int nodes : {few_nodes, some_nodes}) {
    samples = 0;
    Sums line;
    with_nodes(nodes,
               [&](auto n) { integrate<n>(f, tolerances, region.base, p[region.inner], line); });
    if (samples == nodes) return nodes;
  }
  return many_nodes;
}

/// Green's theorem: the integral of f over a region is that of G(u, v) dv around it, G the integral
/// of f from the base to u along u, or that of -G du, G the same along v.
void Summation::add_line(const GreenRegion& region, const dvec2& p, const dvec2& rate,
                         double weight, Quantities& sum, int nodes) {
  const int inner = region.inner;
  const double end = p[inner];
  const double across = inner == 0 ? rate.y : -rate.x;
  if (end == region.base || across == 0) return;
  Sums line;
  const auto f = [&](double at, double, Quantities& sample) { add_to_line(region, p, at, sample); };
  with_nodes(nodes, [&](auto n) { integrate<n>(f, tolerances, region.base, end, line); });
  for (std::size_t k = 0; k < quantities; ++k) {
    sum[k] += across * double(line.value[k]);
    sums_.error[k] += std::abs(weight * across) * line.error[k];
  }
}

/// The points a + r (b - a) of the rulings, with the area element n . (dX/ds x (b - a)) dr ds,
/// which is positive where contact 0 lies to the right of n's path. Three nodes in r are exact for
/// its fourth degree. Curvature is half the length times the angle that n turns by.
void Summation::add_scroll(const MovingRuling& m, Quantities& sum) const {
  const dvec3 a = m.at.jet[0].x - origin_;
  const dvec3 along = -m.at.d();
  // Nodes (1 -+ sqrt(3/5)) / 2 with 5/18, 1/2 with 8/18.
  const double offset = std::sqrt(0.15);
  for (int k = -1; k <= 1; ++k) {
    const double r = 0.5 + k * offset;
    const dvec3 A = glm::cross((1 - r) * m.dx[0] + r * m.dx[1], along);
    const double size = glm::dot(m.at.n, A);
    const double w = (k == 0 ? 8 : 5) / 18.0;
    add_element(sum, a + r * along, A, size, w);
    sum[ruled] += w * size;
  }
  sum[curvature] += 0.5 * glm::dot(m.dn, glm::cross(m.at.n, m.at.d()));
}

/// Of the normals (t, phi) of an edge, the crease's integral of angle times length is that of
/// -+ phi |x'| dt along the arcs that bound them, in the direction of the arcs: along one, dt has
/// the sign of x' . (n x d), d = x_0 - x_1, so that t grows where d points towards growing phi
/// (T x n); contact 0 supports on the side of +d, and contact 1 on that of -d.
void Summation::add_ruling(const Stretch& at, const MovingRuling& m, double weight,
                           Quantities& sample) {
  if (at.scroll) add_scroll(m, sample);
  for (int k = 0; k < 3; ++k) sample[turning + std::size_t(k)] += m.dn[k];
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) sample[way + 3 * i + std::size_t(k)] += m.dx[i][k];
    if (m.at.contact[i].kind != SourceKind::edge) continue;
    const dvec3& origin = creases_.of(m.at.contact[i]);
    const double half = crease(m.at.jet[i].x - origin, m.at.jet[i].dx[0], m.at.n);
    sample[curvature] += (i == 0 ? -1 : 1) * half * m.dp[i].x;
  }
  for (const ArcTrace& trace : *at.traces) {
    const auto i = std::size_t(trace.contact);
    const Contact& c = m.at.contact[i];
    const GreenRegion& region = regions_.all()[std::size_t(trace.region)];
    const dvec2 uv(c.u, c.v);
    const int nodes =
        std::abs(uv[region.inner] - region.base) < short_line ? some_nodes : many_nodes;
    add_line(region, uv, trace.direction * m.dp[i], weight, sample, nodes);
  }
}

/// Along a piece of an arc: its scroll, the regions it bounds, and the creases of contacts on
/// edges.
void Summation::add_piece(std::size_t arc, std::size_t piece, double depth) {
  const std::vector<Ruling>& rulings = boundary_.arcs[arc].pieces[piece].rulings;
  const Stretch stretch{in_scroll_[arc][piece], depth, &regions_.traces(arc, piece)};
  for (std::size_t k = 1; k < rulings.size(); ++k) {
    const Sums before = sums_;
    add_between(stretch, rulings[k - 1], rulings[k]);
    if (stretch.scroll) add_missed_turn(before, rulings[k - 1], rulings[k]);
  }
}

/// Contacts that are a little beside their places lead n where it does not go: what it turns by
/// about the rulings between the two is what it turns by from the one to the other.
void Summation::add_missed_turn(const Sums& before, const Ruling& from, const Ruling& to) {
  dvec3 missed = to.n - from.n;
  for (int k = 0; k < 3; ++k) {
    const std::size_t q = turning + std::size_t(k);
    missed[k] -= double(sums_.value[q] - before.value[q]);
  }
  const dvec3 d = 0.5 * (from.point[0] - from.point[1] + to.point[0] - to.point[1]);
  sums_.value[curvature] += 0.5 * glm::dot(missed, glm::cross(unit(from.n + to.n), d));
}

/// Where exact rulings do not lead from the one to the other, the ways that do are sought; what is
/// better known counts.
void Summation::add_between(const Stretch& at, const Ruling& from, const Ruling& to) {
  const Sums before = sums_;
  const RulingsBetween between(system_, from, to);
  if (between.empty()) return;
  add_exact(at, between);
  if (between.is_smoother()) return;
  std::array<dvec3, 2> moved = moved_since(before);
  double missed = missed_way(moved, from, to);
  if (leads(missed)) return;
  const LedRulings led(geometry_, between, from, to);
  if (leads(led.missed())) {
    // Along edges angles count by the way. Of others the measures are known better than the way.
    for (std::size_t i = 0; i < 2; ++i) {
      const dvec3 whole = to.point[i] - from.point[i];
      const bool is_known = from.contact[i].kind != SourceKind::edge;
      if (is_known && glm::distance(moved[i], whole) <= quadrature_way) moved[i] = whole;
    }
    missed = missed_way(moved, from, to);
    if (leads(missed)) return;
  } else if (led.missed() < farthest_led * between.length()) {
    const Sums exact = sums_;
    sums_ = before;
    const bool is_led = add_led(at, led);
    if (is_led && missed_way(moved_since(before), from, to) <= std::min(missed, quadrature_way)) {
      sums_.error[curvature] += std::abs(double(sums_.value[curvature] - exact.value[curvature]));
      return;
    }
    sums_ = exact;
  }
  sums_.error[curvature] += missed_curvature(missed);
  const Sums exact = sums_;
  sums_ = before;
  add_ways(at, ruling_ways(system_, from, to, at.depth));
  if (exact.error[curvature] < sums_.error[curvature]) sums_ = exact;
}

/// The ways of both contacts that were added.
std::array<dvec3, 2> Summation::moved_since(const Sums& before) const {
  std::array<dvec3, 2> moved;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t q = way + 3 * i + std::size_t(k);
      moved[i][k] = double(sums_.value[q] - before.value[q]);
    }
  }
  return moved;
}

/// Whether there are such rulings all along.
bool Summation::add_led(const Stretch& at, const LedRulings& led) {
  bool all = true;
  const auto f = [&](double s, double weight, Quantities& sample) {
    const std::optional<MovingRuling> m = all ? led(s) : std::nullopt;
    if (m) add_ruling(at, *m, weight, sample);
    all = m.has_value();
  };
  integrate<6>(f, tolerances, 0, 1, sums_);
  return all;
}

void Summation::add_ways(const Stretch& at, const std::vector<RulingWay>& ways) {
  for (const RulingWay& part : ways) {
    if (part.exact) {
      add_exact(at, RulingsBetween(system_, part.from, part.to));
      continue;
    }
    const auto straight = [&](double r, double weight, Quantities& sample) {
      add_ruling(at, part.straight(geometry_, r), weight, sample);
    };
    integrate<6>(straight, tolerances, 0, 1, sums_);
    sums_.error[curvature] += part.uncertainty();
  }
}

void Summation::add_exact(const Stretch& at, const RulingsBetween& between) {
  const bool is_smoother = between.is_smoother();
  const auto f = [&](double s, double weight, Quantities& sample) {
    // Where no ruling is found there is none that is exact; the accuracy tells what it costs.
    const auto exact = is_smoother ? std::nullopt : between(s);
    add_ruling(at, exact ? *exact : between.interpolated(s), weight, sample);
  };
  integrate<6>(f, tolerances, 0, 1, sums_, at.traces->empty() ? single_halvings : 0);
}

/// Whether the stretch runs along an edge, or along a seam at which another face ends: contacts
/// there are the edge's, and so the other face's share is that of an edge.
bool Summation::bounds_normals(const GreenRegion& region, const TrimStretch& stretch) const {
  if (stretch.curve < 0) return false;
  const HullCurveKind kind = boundary_.curves[std::size_t(stretch.curve)].kind;
  if (kind != HullCurveKind::bitangent) return kind == HullCurveKind::edge;
  const Contact c = region.contact(0, 0);
  const Patch& patch = geometry_.patch(c);
  return patch.borders[std::size_t(stretch.side)].piece >= 0;
}

/// Whether another region goes on beyond the stretch: with a kink, if the patches are rounded.
bool Summation::bounds_region(const TrimStretch& stretch) const {
  return stretch.curve < 0 ||
         boundary_.curves[std::size_t(stretch.curve)].kind == HullCurveKind::join;
}

/// Along a stretch of a patch's border, and where that is an edge or a join, its crease: the
/// normals of the edge lie beyond the patch's own n, away from the patch. With the patch to the
/// left of the direction T of travel seen from outside (positive sign), they have larger phi: its
/// lower end.
void Summation::add_border(const GreenRegion& region, const TrimStretch& stretch) {
  const bool of_v = along_v(stretch.side);
  const bool edge = bounds_normals(region, stretch);
  const bool of_line = of_v == (region.inner == 0);
  const bool join = !edge && bounds_region(stretch);
  if (!of_line && !edge && !join) return;
  const double sense = stretch.to < stretch.from ? -1 : 1;
  if (of_line && !edge && !join && on_side(stretch.side, 0)[region.inner] == region.base) return;
  const int nodes = of_line ? enough_nodes(region, stretch) : many_nodes;
  const auto f = [&](double t, double weight, Quantities& sample) {
    const dvec2 p = on_side(stretch.side, t);
    if (of_line) add_line(region, p, of_v ? dvec2(0, 1) : dvec2(1, 0), weight, sample, nodes);
    if (!edge && !join) return;
    const ContactJet j = geometry_.jet(region.contact(p.x, p.y));
    const dvec3 N = double(region.region->sign) * glm::cross(j.dx[0], j.dx[1]);
    const dvec3 x = j.x - (edge ? creases_.of(*region.region, stretch.side) : origin_);
    const double half = crease(x, sense * j.dx[of_v ? 1 : 0], unit(N));
    // The integral runs from `from` to `to`, so backwards dt is negative.
    sample[curvature] -= region.region->sign * sense * half;
  };
  with_nodes(edge ? many_nodes : nodes,
             [&](auto n) { integrate<n>(f, tolerances, stretch.from, stretch.to, sums_); });
}

using Vector = glm::vec<3, long double>;
using SumValues = std::array<long double, quantities>;

Vector vector_at(const SumValues& sum, std::size_t k) { return {sum[k], sum[k + 1], sum[k + 2]}; }

/// From integrals in the frame, about a point there.
BoundaryMeasures measures_of(const SceneFrame& frame, const dvec3& origin, const SumValues& sum) {
  BoundaryMeasures result;
  const double unit_length = 1 / frame.scale;
  // Sums over sheets thinner than rounding may be negative.
  result.volume = std::max(double(sum[volume]), 0.0) * unit_length * unit_length * unit_length;
  result.area = double(sum[area]) * unit_length * unit_length;
  // Mean width = M / (2 pi) (Santalo 1976, chapter 13).
  result.mean_width = double(sum[curvature] / (2 * std::numbers::pi_v<long double>)) * unit_length;
  Vector center(0);
  if (sum[volume] > 0) {
    center = vector_at(sum, moment) / sum[volume];
    // About the centroid, by the parallel axis theorem.
    const dvec3 s(vector_at(sum, second) - sum[volume] * center * center);
    const dvec3 p(vector_at(sum, second + 3) - sum[volume] * Vector(center.y * center.z,
                                                                    center.z * center.x,
                                                                    center.x * center.y));
    result.inertia = std::pow(unit_length, 5) * dmat3(s.y + s.z, -p.z, -p.y,  //
                                                      -p.z, s.z + s.x, -p.x,  //
                                                      -p.y, -p.x, s.x + s.y);
  } else if (sum[area] > 0) {
    center = vector_at(sum, surface_moment) / sum[area];
  }
  result.centroid = frame.to_model(origin + dvec3(center));
  return result;
}

MeasuredLengths lengths_of(const Scene& scene, const SumValues& sum, double layer,
                           const BoundaryMeasures& measures) {
  const SceneFrame& frame = scene.frame();
  const Box& box = scene.box();
  // The farthest corner of the box.
  const dvec3 reach =
      glm::max(glm::abs(box.lower - measures.centroid), glm::abs(box.upper - measures.centroid));
  const dmat3& I = measures.inertia;
  MeasuredLengths lengths;
  lengths.volume = std::max(double(sum[volume]), 0.0);
  lengths.area = double(sum[area]);
  lengths.mean_width = frame.length_to_frame(measures.mean_width);
  lengths.layer = layer;
  lengths.radius = frame.length_to_frame(glm::length(reach));
  lengths.diagonal = frame.length_to_frame(scene.diagonal());
  lengths.inertia = std::pow(frame.scale, 5) * std::max({I[0][0], I[1][1], I[2][2]});
  return lengths;
}

}  // namespace

BoundaryMeasures measure(const Scene& scene, const ContactGeometry& geometry,
                         const HullBoundary& boundary, const Progress& progress) {
  if (boundary.dimension == 2) return flat_measures(geometry, boundary);
  const Summation summation(geometry, boundary, progress);
  const auto& sum = summation.sums().value;
  const auto& error = summation.sums().error;
  BoundaryMeasures result = measures_of(scene.frame(), summation.origin(), sum);
  const auto relative = [&](std::size_t k) { return sum[k] > 0 ? error[k] / double(sum[k]) : 0.0; };
  result.accuracy = std::max({relative(volume), relative(area), relative(curvature)});
  if (sum[area] > 0) {
    const double open = double(glm::length(vector_at(sum, vector_area)) / sum[area]);
    result.accuracy = std::max(result.accuracy, open);
  }
  const double accuracy = result.accuracy;
  result.bounds = {accuracy, accuracy, accuracy, accuracy, accuracy};
  const MeasureBounds of_places =
      measure_bounds(boundary, lengths_of(scene, sum, summation.layer(), result));
  result.bounds.volume += of_places.volume;
  result.bounds.area += of_places.area;
  result.bounds.mean_width += of_places.mean_width;
  result.bounds.centroid += of_places.centroid;
  result.bounds.inertia += of_places.inertia;
  return result;
}

}  // namespace taut
