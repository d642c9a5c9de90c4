#include "taut/hull/measure/boundary_measures.h"

#include <cmath>
#include <numbers>

#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/measure/green_regions.h"
#include "taut/hull/measure/interior_point.h"
#include "taut/hull/measure/quadrature.h"

namespace taut {
namespace {

/// The integrals over the boundary, where x is relative to a point inside. By the divergence
/// theorem, of the fields x, x_i x and x_i x_j x with divergences 3, 4 x_i and 5 x_i x_j:
///   volume = int x . dA / 3,  moments = int x_i x . dA / 4,  int x_i x_j x . dA / 5.
enum Quantity : std::size_t {
  volume = 0,
  area = 1,
  curvature = 2,        ///< total mean curvature, int (k1 + k2) / 2 dA, creases included
  moment = 3,           ///< int x dV
  second = 6,           ///< int x_i x_j dV: xx, yy, zz, yz, zx, xy
  surface_moment = 12,  ///< int x dA
  vector_area = 15,     ///< int n dA
  quantities = 18
};
using Quantities = std::array<double, quantities>;
using Sums = Integrals<quantities>;

/// Relative accuracy of every single rule: what contacts solved to 1e-13 can give.
constexpr double rule_accuracy = 1e-13;
/// Roundings of a second derivative, in the scene's frame, which curvature has whatever a patch's
/// size.
constexpr double curvature_rounding = 16 * rounding_unit;

/// Nodes of the rules that do for patches that are small beside their radii of curvature.
constexpr int few_nodes = 6;

/// Adds w times the area element of size dA with unit or any normal, n dA = A.
void add_element(Quantities& sum, const dvec3& x, const dvec3& A, double dA, double w) {
  const double flux = w * glm::dot(x, A);
  sum[volume] += flux / 3;
  sum[area] += w * dA;
  for (int i = 0; i < 3; ++i) {
    const auto k = std::size_t(i);
    sum[moment + k] += flux / 4 * x[i];
    sum[second + k] += flux / 5 * x[i] * x[i];
    sum[second + 3 + k] += flux / 5 * x[(i + 1) % 3] * x[(i + 2) % 3];
    sum[surface_moment + k] += w * dA * x[i];
    sum[vector_area + k] += w * A[i];
  }
}

/// Tolerances relative to the largest component of each kind, but not below the rounding of what
/// they are made of: lengths in the scene's frame are about one at most, derivatives are rounded as
/// these are, and areas have those of the region's size as factors.
Quantities tolerances(const Quantities& magnitude) {
  Quantities result{};
  const auto largest = [&](std::size_t from, std::size_t to) {
    double m = 0;
    for (std::size_t k = from; k < to; ++k) m = std::max(m, magnitude[k]);
    return m;
  };
  const double areas = std::max(magnitude[area], largest(vector_area, quantities));
  const double rounding = 8 * rounding_unit * std::max(areas, std::sqrt(areas));
  const auto set = [&](std::size_t from, std::size_t to) {
    const double m = rule_accuracy * largest(from, to) + rounding;
    for (std::size_t k = from; k < to; ++k) result[k] = m;
  };
  set(volume, volume + 1);
  set(curvature, curvature + 1);
  set(moment, second);
  set(second, surface_moment);
  set(surface_moment, vector_area);
  set(vector_area, quantities);
  result[area] = result[vector_area];
  result[curvature] += 8 * rounding_unit * magnitude[curvature] + curvature_rounding;
  return result;
}

/// Integrands over a patch per du dv, about the origin; the outward normal is along sign * (Su x
/// Sv).
void add_patch(const ContactJet& j, const dvec3& origin, int sign, Quantities& sum) {
  const dvec3 N = double(sign) * glm::cross(j.dx[0], j.dx[1]);
  const double length = glm::length(N);
  add_element(sum, j.x - origin, N, length, 1);
  if (length == 0) return;
  // H dA with H = (E n - 2 F m + G l) / (2 |N|^2), l = -Suu . N / |N| and so on: positive where the
  // surface is convex (do Carmo 1976, section 3-3).
  const double E = glm::dot(j.dx[0], j.dx[0]);
  const double F = glm::dot(j.dx[0], j.dx[1]);
  const double G = glm::dot(j.dx[1], j.dx[1]);
  const double form = E * glm::dot(j.dyy, N) - 2 * F * glm::dot(j.dxy, N) + G * glm::dot(j.dxx, N);
  sum[curvature] -= form / (2 * length * length);
}

/// The integrals over a whole boundary, in the scene's frame.
class Summation {
 public:
  Summation(const ContactGeometry& geometry, const HullBoundary& boundary)
      : geometry_(geometry),
        system_(geometry),
        boundary_(boundary),
        origin_(interior_point(geometry, boundary)),
        regions_(geometry, boundary) {
    find_scrolls();
    for (std::size_t a = 0; a < boundary.arcs.size(); ++a) {
      for (std::size_t p = 0; p < boundary.arcs[a].pieces.size(); ++p) add_piece(a, p);
    }
    for (const GreenRegion& region : regions_.all()) {
      for (const std::vector<TrimStretch>& loop : region.region->loops) {
        for (const TrimStretch& stretch : loop) {
          if (stretch.arc < 0) add_border(region, stretch);
        }
      }
    }
    for (const HullFace& face : boundary.faces) {
      if (face.kind == FaceKind::facet) add_facet(face);
    }
  }

  const dvec3& origin() const { return origin_; }
  const Sums& sums() const { return sums_; }

 private:
  void find_scrolls();
  void add_piece(std::size_t arc, std::size_t piece);
  bool bounds_normals(const GreenRegion& region, const TrimStretch& stretch) const;
  void add_border(const GreenRegion& region, const TrimStretch& stretch);
  void add_facet(const HullFace& face);
  void add_polygon(const HullFace& face);
  void add_side(const HullFace& face, const dvec3& begin, const EdgeStretch& side);

  void add_scroll(const MovingRuling& m, Quantities& sum) const;
  double crease(const dvec3& x, const dvec3& tangent, const dvec3& n) const;
  void add_to_line(const GreenRegion& region, const dvec2& p, double at, Quantities& sample) const;
  bool is_plain(const GreenRegion& region, const TrimStretch& stretch) const;
  void add_line(const GreenRegion& region, const dvec2& p, const dvec2& rate, double weight,
                Quantities& sum, bool plain = false);

  const ContactGeometry& geometry_;
  ContactSystem system_;
  const HullBoundary& boundary_;
  dvec3 origin_;
  GreenRegions regions_;
  std::vector<std::vector<bool>> in_scroll_;  // per arc and piece
  Sums sums_;
};

void Summation::find_scrolls() {
  in_scroll_.reserve(boundary_.arcs.size());
  for (const SeparatingArc& arc : boundary_.arcs) {
    in_scroll_.emplace_back(arc.pieces.size(), false);
  }
  for (const HullFace& face : boundary_.faces) {
    if (face.kind != FaceKind::scroll) continue;
    std::vector<bool>& used = in_scroll_[std::size_t(face.scroll.arc)];
    for (int k = 0; k < face.scroll.count; ++k) {
      used[std::size_t(face.scroll.first + k) % used.size()] = true;
    }
  }
}

/// The integrands on the line from the base to p, where the inner parameter is `at`.
void Summation::add_to_line(const GreenRegion& region, const dvec2& p, double at,
                            Quantities& sample) const {
  const Contact c = region.inner == 0 ? region.contact(at, p.y) : region.contact(p.x, at);
  add_patch(geometry_.jet(c), origin_, region.region->sign, sample);
}

/// Whether few nodes are accurate on the line to the stretch's middle. On the stretch's other
/// lines few nodes will then be accurate too, or halve the lines.
bool Summation::is_plain(const GreenRegion& region, const TrimStretch& stretch) const {
  const dvec2 p = on_side(stretch.side, 0.5 * (stretch.from + stretch.to));
  int samples = 0;
  const auto f = [&](double at, double, Quantities& sample) {
    ++samples;
    add_to_line(region, p, at, sample);
  };
  Sums line;
  integrate<few_nodes>(f, tolerances, region.base, p[region.inner], line);
  return samples == few_nodes;
}

/// Green's theorem: the integral of f over a region is that of G(u, v) dv around it, G the integral
/// of f from the base to u along u, or that of -G du, G the same along v.
void Summation::add_line(const GreenRegion& region, const dvec2& p, const dvec2& rate,
                         double weight, Quantities& sum, bool plain) {
  const int inner = region.inner;
  const double end = p[inner];
  const double across = inner == 0 ? rate.y : -rate.x;
  if (end == region.base || across == 0) return;
  Sums line;
  const auto f = [&](double at, double, Quantities& sample) { add_to_line(region, p, at, sample); };
  if (plain) {
    integrate<few_nodes>(f, tolerances, region.base, end, line);
  } else if (std::abs(end - region.base) < 0.25) {
    integrate<8>(f, tolerances, region.base, end, line);
  } else {
    integrate<16>(f, tolerances, region.base, end, line);
  }
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
  const double size0 = glm::dot(m.at.n, glm::cross(m.dx[0], along));
  const double size1 = glm::dot(m.at.n, glm::cross(m.dx[1], along));
  // Nodes (1 -+ sqrt(3/5)) / 2 with 5/18, 1/2 with 8/18.
  const double offset = std::sqrt(0.15);
  for (int k = -1; k <= 1; ++k) {
    const double r = 0.5 + k * offset;
    const double size = (1 - r) * size0 + r * size1;
    add_element(sum, a + r * along, size * m.at.n, size, (k == 0 ? 8 : 5) / 18.0);
  }
  sum[curvature] += 0.5 * glm::dot(m.dn, glm::cross(m.at.n, m.at.d()));
}

/// Half the angle of n about an edge's tangent, from the direction away from the interior point:
/// between -pi/4 and pi/4, since (x - origin) . n > 0.
double Summation::crease(const dvec3& x, const dvec3& tangent, const dvec3& n) const {
  const double length = glm::length(tangent);
  if (length == 0) return 0;
  const dvec3 T = tangent / length;
  const dvec3 across = glm::cross(T, x - origin_);  // T x m, as long as m
  const double phi = std::atan2(glm::dot(n, across), glm::dot(n, glm::cross(across, T)));
  return 0.5 * length * phi;
}

/// Along a piece of an arc: its scroll, the regions it bounds, and the creases of contacts on
/// edges.
///
/// Of the normals (t, phi) of an edge, the crease's integral of angle times length is that of
/// -+ phi |x'| dt along the arcs that bound them, in the direction of the arcs: along one, dt has
/// the sign of x' . (n x d), d = x_0 - x_1, so that t grows where d points towards growing phi
/// (T x n); contact 0 supports on the side of +d, and contact 1 on that of -d.
void Summation::add_piece(std::size_t arc, std::size_t piece) {
  const std::vector<Ruling>& rulings = boundary_.arcs[arc].pieces[piece].rulings;
  if (rulings.empty()) return;
  const std::array<Contact, 2>& contact = rulings[0].contact;
  const auto is = [&](std::size_t i, SourceKind kind) { return contact[i].kind == kind; };
  if (is(0, SourceKind::vertex) && is(1, SourceKind::vertex)) {
    // A crease along the segment itself; n turns along a great circle.
    const double length = glm::length(rulings[0].point[0] - rulings[0].point[1]);
    for (std::size_t k = 1; k < rulings.size(); ++k) {
      const dvec3& n0 = rulings[k - 1].n;
      const dvec3& n1 = rulings[k].n;
      const double angle = std::atan2(glm::length(glm::cross(n0, n1)), glm::dot(n0, n1));
      sums_.value[curvature] += 0.5 * length * angle;
    }
    return;
  }
  const bool scroll = in_scroll_[arc][piece];
  const std::vector<ArcTrace>& traces = regions_.traces(arc, piece);
  for (std::size_t k = 1; k < rulings.size(); ++k) {
    const RulingsBetween between(system_, rulings[k - 1], rulings[k]);
    if (between.empty()) continue;
    const auto f = [&](double s, double weight, Quantities& sample) {
      // Where no ruling is found there is none that is exact; the accuracy tells what it costs.
      const auto exact = between.is_smoother() ? std::nullopt : between(s);
      const MovingRuling m = exact ? *exact : between.interpolated(s);
      if (scroll) add_scroll(m, sample);
      for (std::size_t i = 0; i < 2; ++i) {
        if (!is(i, SourceKind::edge)) continue;
        const double half = crease(m.at.jet[i].x, m.at.jet[i].dx[0], m.at.n);
        sample[curvature] += (i == 0 ? -1 : 1) * half * m.dp[i].x;
      }
      for (const ArcTrace& trace : traces) {
        const auto i = std::size_t(trace.contact);
        const Contact& c = m.at.contact[i];
        add_line(regions_.all()[std::size_t(trace.region)], {c.u, c.v}, trace.direction * m.dp[i],
                 weight, sample);
      }
    };
    integrate<6>(f, tolerances, 0, 1, sums_);
  }
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

/// Along a stretch of a patch's border, and where that is an edge, its crease: the normals of the
/// edge lie beyond the patch's own n, away from the patch. With the patch to the left of the
/// direction T of travel seen from outside (positive sign), they have larger phi: its lower end.
void Summation::add_border(const GreenRegion& region, const TrimStretch& stretch) {
  const bool of_v = along_v(stretch.side);
  const bool edge = bounds_normals(region, stretch);
  const bool of_line = of_v == (region.inner == 0);
  if (!of_line && !edge) return;
  const double sense = stretch.to < stretch.from ? -1 : 1;
  if (of_line && !edge && on_side(stretch.side, 0)[region.inner] == region.base) return;
  const bool plain = of_line && is_plain(region, stretch);
  const auto f = [&](double t, double weight, Quantities& sample) {
    const dvec2 p = on_side(stretch.side, t);
    if (of_line) add_line(region, p, of_v ? dvec2(0, 1) : dvec2(1, 0), weight, sample, plain);
    if (!edge) return;
    const ContactJet j = geometry_.jet(region.contact(p.x, p.y));
    const dvec3 N = double(region.region->sign) * glm::cross(j.dx[0], j.dx[1]);
    const double half = crease(j.x, sense * j.dx[of_v ? 1 : 0], unit(N));
    // The integral runs from `from` to `to`, so backwards dt is negative.
    sample[curvature] -= region.region->sign * sense * half;
  };
  if (plain && !edge) {
    integrate<few_nodes>(f, tolerances, stretch.from, stretch.to, sums_);
  } else {
    integrate<16>(f, tolerances, stretch.from, stretch.to, sums_);
  }
}

/// The polygon of the facet's contacts and what lies between its sides and the curved ones.
void Summation::add_facet(const HullFace& face) {
  add_polygon(face);
  for (std::size_t k = 0; k < face.sides.size(); ++k) {
    if (face.sides[k].piece >= 0) add_side(face, face.points[k], face.sides[k]);
  }
}

/// The segment between a curved side and its chord, as the triangles between neighbouring rays from
/// where the side begins: begin + r (x - begin) has the area element r (x - begin) x dx/dt dr dt.
/// Two nodes in r are exact for its third degree. Of the side's normals the facet's own is the
/// lower end, as add_border() has it.
void Summation::add_side(const HullFace& face, const dvec3& begin, const EdgeStretch& side) {
  const dvec3 tip = begin - origin_;
  const double sense = side.to < side.from ? -1 : 1;
  const double offset = std::sqrt(1.0 / 12);
  const auto f = [&](double t, double, Quantities& sample) {
    const ContactJet j = geometry_.jet(side.at(t));
    const dvec3 ray = j.x - begin;
    const dvec3 element = glm::cross(ray, j.dx[0]);
    for (const double r : {0.5 - offset, 0.5 + offset}) {
      const dvec3 A = r * element;
      add_element(sample, tip + r * ray, A, glm::dot(A, face.n), 0.5);
    }
    sample[curvature] -= sense * crease(j.x, sense * j.dx[0], face.n);
  };
  integrate<16>(f, tolerances, side.from, side.to, sums_);
}

/// A plane polygon, by the tetrahedra over a fan of triangles with the interior point as tip: the
/// integral of x_i x_j over one is det / 120 ((sum of x)_i (sum of x)_j + sum of x_i x_j).
void Summation::add_polygon(const HullFace& face) {
  using Vector = glm::vec<3, long double>;
  const auto at = [&](std::size_t k) {
    return Vector(face.points[k % face.points.size()]) - Vector(origin_);
  };
  Vector total(0);
  for (std::size_t k = 0; k < face.points.size(); ++k) {
    total += 0.5L * glm::cross(at(k) - at(0), at(k + 1) - at(0));
  }
  const long double size = glm::length(total);
  if (!(size > 0)) return;
  const Vector n = total / size;
  auto& sum = sums_.value;
  sum[area] += size;
  for (int i = 0; i < 3; ++i) sum[vector_area + std::size_t(i)] += total[i];
  for (std::size_t k = 1; k + 1 < face.points.size(); ++k) {
    const Vector a = at(0), b = at(k), c = at(k + 1);
    const Vector corners = a + b + c;
    const long double det = glm::dot(a, glm::cross(b, c));
    const long double twice = glm::dot(n, glm::cross(b - a, c - a));
    const auto product = [&](int i, int j) {
      return det / 120 * (corners[i] * corners[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    };
    sum[volume] += det / 6;
    for (int i = 0; i < 3; ++i) {
      const auto q = std::size_t(i);
      sum[moment + q] += det / 24 * corners[i];
      sum[second + q] += product(i, i);
      sum[second + 3 + q] += product((i + 1) % 3, (i + 2) % 3);
      sum[surface_moment + q] += twice / 6 * corners[i];
    }
  }
}

}  // namespace

BoundaryMeasures measure(const Scene& scene, const ContactGeometry& geometry,
                         const HullBoundary& boundary) {
  using Vector = glm::vec<3, long double>;
  const Summation summation(geometry, boundary);
  const auto& sum = summation.sums().value;
  const auto& error = summation.sums().error;
  const auto vector_at = [&](std::size_t k) { return Vector(sum[k], sum[k + 1], sum[k + 2]); };

  BoundaryMeasures result;
  const SceneFrame& frame = scene.frame();
  const double unit_length = 1 / frame.scale;
  result.volume = double(sum[volume]) * unit_length * unit_length * unit_length;
  result.area = double(sum[area]) * unit_length * unit_length;
  // Mean width = M / (2 pi) (Santalo 1976, chapter 13).
  result.mean_width = double(sum[curvature] / (2 * std::numbers::pi_v<long double>)) * unit_length;
  Vector center(0);
  if (sum[volume] > 0) {
    center = vector_at(moment) / sum[volume];
    // About the centroid, by the parallel axis theorem.
    const dvec3 s(vector_at(second) - sum[volume] * center * center);
    const dvec3 p(vector_at(second + 3) - sum[volume] * Vector(center.y * center.z,
                                                               center.z * center.x,
                                                               center.x * center.y));
    result.inertia = std::pow(unit_length, 5) * dmat3(s.y + s.z, -p.z, -p.y,  //
                                                      -p.z, s.z + s.x, -p.x,  //
                                                      -p.y, -p.x, s.x + s.y);
  } else if (sum[area] > 0) {
    center = vector_at(surface_moment) / sum[area];
  }
  result.centroid = frame.to_model(summation.origin() + dvec3(center));

  const auto relative = [&](std::size_t k) { return sum[k] > 0 ? error[k] / double(sum[k]) : 0.0; };
  result.accuracy = std::max({relative(volume), relative(area), relative(curvature)});
  if (sum[area] > 0) {
    const double open = double(glm::length(vector_at(vector_area)) / sum[area]);
    result.accuracy = std::max(result.accuracy, open);
  }
  return result;
}

}  // namespace taut
