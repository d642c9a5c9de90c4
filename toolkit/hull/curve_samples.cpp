#include "taut/hull/curve_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "taut/hull/contact_system.h"

namespace taut {
namespace {

/// A place on a sequence of points: in the interval behind one of them.
struct Place {
  std::size_t interval = 0;
  double s = 0;
};

/// Divides a sequence of places so that the sagittas of all parts are alike and no larger than
/// they may be. A chord's sagitta grows as its length squared, so it is the integral of the square
/// root that is divided.
class EvenDivision {
 public:
  /// Adds the next interval; `sagitta_root` is the square root of its sagitta.
  void add(double sagitta_root) { sums_.push_back(sums_.back() + sagitta_root); }

  std::vector<Place> places(double sagitta, int least_parts) const {
    const double parts =
        std::clamp(std::ceil(sums_.back() / std::sqrt(sagitta)), double(least_parts), most_parts);
    std::vector<Place> result = {{0, 0}};
    for (int k = 1; k < int(parts); ++k) {
      const double at = sums_.back() * (k / parts);
      const auto next = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, at);
      const double from = *(next - 1);
      const double s = *next > from ? (at - from) / (*next - from) : 0;
      result.push_back({std::size_t(next - sums_.begin()) - 1, std::clamp(s, 0.0, 1.0)});
    }
    result.push_back({sums_.size() - 2, 1});
    return result;
  }

 private:
  static constexpr double most_parts = 1e6;
  std::vector<double> sums_ = {0};
};

/// Nearer than this share of an interval to one of its ends, the end serves as well.
constexpr double snap_share = 0.1;

Place snapped(Place p) {
  if (p.s < snap_share) p.s = 0;
  if (p.s > 1 - snap_share) p.s = 1;
  return p;
}

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 edge = b - a;
  const double square = glm::dot(edge, edge);
  const double t = square > 0 ? std::clamp(glm::dot(x - a, edge) / square, 0.0, 1.0) : 0;
  return glm::distance(x, a + t * edge);
}

double sagitta(const Ruling& a, const Ruling& middle, const Ruling& b) {
  return std::max(distance_to_segment(middle.point[0], a.point[0], b.point[0]),
                  distance_to_segment(middle.point[1], a.point[1], b.point[1]));
}

double chord(const Ruling& a, const Ruling& b) {
  return glm::distance(a.n, b.n) + glm::distance(a.point[0], b.point[0]) +
         glm::distance(a.point[1], b.point[1]);
}

/// The square roots of the intervals' sagittas, from those of pairs of them; one interval alone
/// by its middle.
template <class T, class Middle>
void add_intervals(const std::vector<T>& points, Middle middle, EvenDivision& division) {
  const std::size_t count = points.size();
  if (count == 2) {
    division.add(std::sqrt(sagitta(points[0], middle(), points[1])));
    return;
  }
  std::vector<double> lengths;
  for (std::size_t k = 0; k + 1 < count; ++k) lengths.push_back(chord(points[k], points[k + 1]));
  std::vector<double> density(count, 0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double length = lengths[k - 1] + lengths[k];
    if (!(length > 0)) continue;
    density[k] = std::sqrt(sagitta(points[k - 1], points[k], points[k + 1])) / length;
  }
  density.front() = density[1];
  density.back() = density[count - 2];
  for (std::size_t k = 0; k + 1 < count; ++k) {
    division.add(0.5 * (density[k] + density[k + 1]) * lengths[k]);
  }
}

class CurveSampler {
 public:
  CurveSampler(const ContactGeometry& geometry, const HullBoundary& boundary,
               const ContactFaces& faces, double sagitta)
      : geometry_(geometry),
        frame_(geometry.scene().frame()),
        boundary_(boundary),
        faces_(faces),
        system_(geometry),
        sagitta_(sagitta * frame_.scale) {}

  CurveSamples run(double width);

 private:
  void add(const dvec3& n, const Contact& contact, TouchedFaces touched);
  void add_facet(int face);
  void add_arc(int arc);
  void add_run(int arc, int first, int count, int least_parts);
  void add_ruling(int arc, int piece, const Ruling& ruling);
  bool same_faces(int arc, std::size_t piece, std::size_t other) const;
  bool samples_border(const PatchRegion& region, int face, const TrimStretch& stretch) const;
  void add_border(const PatchRegion& region, const TrimStretch& stretch);
  Ruling border_place(const PatchRegion& region, Side side, double t) const;
  CurveSamples without_near_ones(double width) const;

  const ContactGeometry& geometry_;
  SceneFrame frame_;
  const HullBoundary& boundary_;
  const ContactFaces& faces_;
  ContactSystem system_;
  double sagitta_;  // in the scene's frame
  CurveSamples all_;
};

void CurveSampler::add(const dvec3& n, const Contact& contact, TouchedFaces touched) {
  const Contact c = geometry_.canonical(contact);
  if (c.kind != SourceKind::face) {
    for (const TouchedFace& f : faces_.touched(c)) touch(touched, f);
  }
  all_.samples.push_back({n, c});
  all_.points.push_back(frame_.to_model(geometry_.point(c)));
  all_.faces.push_back(std::move(touched));
}

void CurveSampler::add_facet(int face) {
  const HullFace& f = boundary_.faces[std::size_t(face)];
  for (const Contact& c : f.contacts) add(f.n, c, {{face, 0}});
}

void CurveSampler::add_ruling(int arc, int piece, const Ruling& ruling) {
  for (int i = 0; i < 2; ++i) {
    TouchedFaces touched;
    touch(touched, {faces_.scroll(arc, piece), 1U << unsigned(i)});
    touch(touched, {faces_.patch(arc, piece, i), 0});
    add(ruling.n, ruling.contact[std::size_t(i)], std::move(touched));
  }
}

bool CurveSampler::same_faces(int arc, std::size_t piece, std::size_t other) const {
  const auto p = int(piece);
  const auto q = int(other);
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(arc)].pieces;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact& a = pieces[piece].rulings.front().contact[i];
    const Contact& b = pieces[other].rulings.front().contact[i];
    if (a.kind != b.kind || faces_.patch(arc, p, int(i)) != faces_.patch(arc, q, int(i))) {
      return false;
    }
  }
  return faces_.scroll(arc, p) == faces_.scroll(arc, q);
}

/// Divides the arc wherever the faces that it touches change.
void CurveSampler::add_arc(int arc) {
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(arc)].pieces;
  const bool closed = boundary_.arcs[std::size_t(arc)].closed;
  std::size_t first = 0;
  for (std::size_t next = 1; next <= pieces.size(); ++next) {
    if (next < pieces.size() && same_faces(arc, first, next)) continue;
    // A triangle at least where it would be nothing else.
    const bool whole = closed && first == 0 && next == pieces.size();
    add_run(arc, int(first), int(next - first), whole ? 3 : 1);
    first = next;
  }
}

void CurveSampler::add_run(int arc, int first, int count, int least_parts) {
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(arc)].pieces;
  EvenDivision division;
  std::vector<std::pair<int, std::size_t>> from;  // per interval: piece and ruling
  for (int p = first; p < first + count; ++p) {
    const std::vector<Ruling>& rulings = pieces[std::size_t(p)].rulings;
    add_intervals(
        rulings, [&] { return ruling_between(system_, rulings[0], rulings[1], 0.5); }, division);
    for (std::size_t k = 0; k + 1 < rulings.size(); ++k) from.emplace_back(p, k);
  }
  for (Place place : division.places(sagitta_, least_parts)) {
    place = snapped(place);
    const auto [piece, k] = from[place.interval];
    const std::vector<Ruling>& rulings = pieces[std::size_t(piece)].rulings;
    add_ruling(arc, piece, ruling_between(system_, rulings[k], rulings[k + 1], place.s));
  }
}

/// Whether the border is part of a curve that no rulings are sampled along, and not passed from
/// its other side.
bool CurveSampler::samples_border(const PatchRegion& region, int face,
                                  const TrimStretch& stretch) const {
  if (stretch.arc >= 0 || stretch.curve < 0) return false;
  const HullCurve& curve = boundary_.curves[std::size_t(stretch.curve)];
  int patches = 0;
  for (const int f : curve.faces) {
    if (f < 0) continue;
    const FaceKind kind = boundary_.faces[std::size_t(f)].kind;
    if (kind == FaceKind::scroll) return false;
    patches += kind == FaceKind::patch ? 1 : 0;
  }
  if (patches < 2) return true;
  if (curve.faces[0] != curve.faces[1]) return face == curve.faces[0];
  const Contact c = {region.instance, SourceKind::face, region.patch, 0, 0};
  const Border& border =
      geometry_.part(c).patches()[std::size_t(region.patch)].borders[std::size_t(stretch.side)];
  return border.neighbor < 0 ||
         std::pair(region.patch, stretch.side) <= std::pair(border.neighbor, border.neighbor_side);
}

/// As a ruling of length zero.
Ruling CurveSampler::border_place(const PatchRegion& region, Side side, double t) const {
  const bool along_v = side == Side::u0 || side == Side::u1;
  const double fixed = side == Side::u1 || side == Side::v1 ? 1 : 0;
  const Contact c = {region.instance, SourceKind::face, region.patch, along_v ? fixed : t,
                     along_v ? t : fixed};
  const BezierPatch& patch = geometry_.part(c).patches()[std::size_t(region.patch)].bezier;
  const dvec3 n =
      double(region.sign) * geometry_.to_frame(c.instance, unit_normal(patch, c.u, c.v));
  const dvec3 x = geometry_.point(c);
  return {n, {c, c}, {x, x}};
}

void CurveSampler::add_border(const PatchRegion& region, const TrimStretch& stretch) {
  constexpr int intervals = 32;  // a Bezier border bends smoothly, its sagitta more so
  std::vector<double> t;
  std::vector<Ruling> places;
  for (int k = 0; k <= intervals; ++k) {
    t.push_back(Interval{stretch.from, stretch.to}.at(double(k) / intervals));
    places.push_back(border_place(region, stretch.side, t.back()));
  }
  EvenDivision division;
  add_intervals(
      places, [&] { return places[0]; }, division);
  const HullCurve& curve = boundary_.curves[std::size_t(stretch.curve)];
  for (const Place& place : division.places(sagitta_, 1)) {
    const double at = Interval{t[place.interval], t[place.interval + 1]}.at(place.s);
    const Ruling r = border_place(region, stretch.side, at);
    TouchedFaces touched;
    for (const int f : curve.faces) touch(touched, {f, 0});
    add(r.n, r.contact[0], std::move(touched));
  }
}

/// In the order of a direction in which few points of a model lie side by side.
CurveSamples CurveSampler::without_near_ones(double width) const {
  const dvec3 across = unit(dvec3(0.7548776662466927, 0.5698402909980532, 0.4301597090019468));
  const std::size_t count = all_.points.size();
  std::vector<double> height;
  for (const dvec3& p : all_.points) height.push_back(glm::dot(across, p - frame_.center));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return height[a] != height[b] ? height[a] < height[b] : a < b;
  });
  std::vector<std::size_t> place(count);
  for (std::size_t k = 0; k < count; ++k) place[order[k]] = k;
  CurveSamples result;
  std::vector<int> number(count, -1);  // in the result
  for (std::size_t i = 0; i < count; ++i) {
    int near = -1;
    const auto look = [&](std::size_t other) {
      if (std::abs(height[other] - height[i]) > width) return false;
      if (number[other] >= 0 && other < i &&
          glm::distance(all_.points[other], all_.points[i]) <= width) {
        near = number[other];
      }
      return near < 0;
    };
    for (std::size_t k = place[i]; k > 0 && look(order[k - 1]); --k) continue;
    for (std::size_t k = place[i] + 1; near < 0 && k < count && look(order[k]); ++k) continue;
    if (near >= 0) {
      for (const TouchedFace& f : all_.faces[i]) touch(result.faces[std::size_t(near)], f);
      continue;
    }
    number[i] = int(result.samples.size());
    result.samples.push_back(all_.samples[i]);
    result.points.push_back(all_.points[i]);
    result.faces.push_back(all_.faces[i]);
  }
  return result;
}

CurveSamples CurveSampler::run(double width) {
  for (int f = 0; f < int(boundary_.faces.size()); ++f) add_facet(f);
  for (int a = 0; a < int(boundary_.arcs.size()); ++a) add_arc(a);
  for (int f = 0; f < int(boundary_.faces.size()); ++f) {
    for (const PatchRegion& region : boundary_.faces[std::size_t(f)].regions) {
      for (const std::vector<TrimStretch>& loop : region.loops) {
        for (const TrimStretch& stretch : loop) {
          if (samples_border(region, f, stretch)) add_border(region, stretch);
        }
      }
    }
  }
  return without_near_ones(width);
}

}  // namespace

CurveSamples curve_samples(const ContactGeometry& geometry, const HullBoundary& boundary,
                           const ContactFaces& faces, double sagitta, double width) {
  return CurveSampler(geometry, boundary, faces, sagitta).run(width);
}

}  // namespace taut
