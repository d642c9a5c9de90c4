#include "taut/hull/mesh/boundary_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/mesh/even_division.h"
#include "taut/hull/mesh/near_samples.h"

namespace taut {
namespace {

/// Lengths of the intervals between contacts, in the root of the second fundamental form.
std::vector<double> form_lengths(const std::vector<Ruling>& rulings, std::size_t contact = 0) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k + 1 < rulings.size(); ++k) {
    const double form = glm::dot(rulings[k + 1].n - rulings[k].n,
                                 rulings[k + 1].point[contact] - rulings[k].point[contact]);
    lengths.push_back(std::sqrt(std::max(form, 0.0)));
  }
  return lengths;
}

/// Share of a space that is before the first of evenly spaced places.
constexpr double first_visit = 0.5;

/// Calls visit with evenly spaced places on intervals of these lengths, the first after half a
/// space: the interval and the share of it.
template <class Visit>
void visit_evenly(const std::vector<double>& lengths, double space, Visit visit) {
  double to_next = first_visit * space;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    while (to_next < lengths[k]) {
      visit(k, to_next / lengths[k]);
      to_next += space;
    }
    to_next -= lengths[k];
  }
}

/// Shares of the permitted gap (tried; more makes fewer points on curves, and more beside them):
/// for sagittas of curves, and for the triangles beside them.
constexpr double sagitta_share = 0.6;
constexpr double gap_share = 0.8;

/// Share for what a rim's sagitta means for the distance that is certified: next to a sharp
/// rim, between normals n and m, up to sagitta * (n x m) is gap, which counts by the depth
/// |n + m| / 2 of their cone (certificate.h). So the sagitta counts |n - m| times.
constexpr double rim_share = 0.9;

/// Nearer to others than this share of its distance from its curve, a point beside the curve is
/// not wanted: it might hide a chord (design: mesh).
constexpr double clear_share = 0.6;

/// Turns of the normal beyond which a step from a curve is no small one.
constexpr double largest_step = 0.5;

/// A Bezier border bends smoothly, its sagitta more so.
constexpr int border_intervals = 32;
/// So few intervals tell whether a border is worth the others,
constexpr int coarse_intervals = 4;
/// where they find more than this share of what it takes to divide it.
constexpr double worth_dividing = 0.9;

class BoundarySampler {
 public:
  BoundarySampler(const ContactGeometry& geometry, const HullBoundary& boundary,
                  const ContactFaces& faces, const SampleSpacing& spacing, SupportQuery& query)
      : geometry_(geometry),
        frame_(geometry.scene().frame()),
        boundary_(boundary),
        faces_(faces),
        system_(geometry),
        query_(query),
        sagitta_(sagitta_share * spacing.gap * frame_.scale),
        rim_(rim_share * spacing.gap * frame_.scale),
        side_(std::sqrt(6 * gap_share * spacing.gap * frame_.scale)),
        width_(spacing.width) {}

  BoundarySamples run();

 private:
  void add(const dvec3& n, const Contact& contact, TouchedFaces touched);
  void add_facet(int face);
  void add_arc(int arc);
  void add_run(int arc, int first, int count, int least_parts);
  void add_ruling(const ArcPlace& place);
  bool same_faces(int arc, std::size_t piece, std::size_t other) const;
  bool samples_border(const PatchRegion& region, int face, const TrimStretch& stretch) const;
  void add_border(const PatchRegion& region, const TrimStretch& stretch);
  std::vector<Ruling> border_places(const PatchRegion& region, const TrimStretch& stretch) const;
  Ruling border_place(const PatchRegion& region, Side side, double t) const;
  std::vector<Ruling> coarse_places(const PatchRegion& region, const TrimStretch& stretch) const;
  double border_sagitta(const std::vector<Ruling>& places, const HullCurve& curve) const;
  void add_rows(int arc, int piece);
  void add_border_row(const PatchRegion& region, const TrimStretch& stretch);
  void add_beside(const ContactJet& jet, const dvec3& n, const dvec3& across, const Contact& hint);

  const ContactGeometry& geometry_;
  SceneFrame frame_;
  const HullBoundary& boundary_;
  const ContactFaces& faces_;
  ContactSystem system_;
  SupportQuery& query_;
  double sagitta_;  // in the scene's frame
  double rim_;      // of rims: the sagitta times the difference of normals
  double side_;     // of triangles inside patches, in the root of the second fundamental form
  double width_;
  BoundarySamples all_;
  std::vector<double> clear_;  // per sample: no sample before may be as near; in model units
};

void BoundarySampler::add(const dvec3& n, const Contact& contact, TouchedFaces touched) {
  // Rulings between those of the boundary may go a little past a border, where nothing is.
  const Contact c = geometry_.canonical(clamped(contact));
  if (!is_finite(n) || !is_finite(geometry_.point(c))) return;
  if (c.kind != SourceKind::face) {
    for (const TouchedFace& f : faces_.touched(c)) touch(touched, f);
  }
  all_.samples.push_back({n, c});
  all_.points.push_back(frame_.to_model(geometry_.point(c)));
  all_.faces.push_back(std::move(touched));
  clear_.push_back(width_);
}

void BoundarySampler::add_facet(int face) {
  const HullFace& f = boundary_.faces[std::size_t(face)];
  for (const Contact& c : f.contacts) add(f.n, c, {{face, 0}});
}

void BoundarySampler::add_ruling(const ArcPlace& place) {
  for (int i = 0; i < 2; ++i) {
    add(place.ruling.n, place.ruling.contact[std::size_t(i)],
        faces_.beside(place.arc, place.piece, i));
  }
}

bool BoundarySampler::same_faces(int arc, std::size_t piece, std::size_t other) const {
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
void BoundarySampler::add_arc(int arc) {
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

void BoundarySampler::add_run(int arc, int first, int count, int least_parts) {
  const std::vector<ArcPiece>& pieces = boundary_.arcs[std::size_t(arc)].pieces;
  EvenDivision division;
  std::vector<std::pair<int, std::size_t>> from;  // per interval: piece and ruling
  for (int p = first; p < first + count; ++p) {
    const std::vector<Ruling>& rulings = pieces[std::size_t(p)].rulings;
    division.add(rulings, [&] {
      return ruling_between(system_, rulings[0], rulings[1], 0.5).value_or(rulings[0]);
    });
    for (std::size_t k = 0; k + 1 < rulings.size(); ++k) from.emplace_back(p, k);
  }
  if (from.empty()) return;
  const auto begin = int(all_.samples.size());
  std::vector<ArcPlace> along;
  for (const EvenDivision::Place& place : division.places(sagitta_, least_parts)) {
    const auto [piece, k] = from[place.interval];
    const std::vector<Ruling>& rulings = pieces[std::size_t(piece)].rulings;
    const std::optional<Ruling> r = ruling_between(system_, rulings[k], rulings[k + 1], place.s);
    if (!r || !is_finite(r->n) || !is_finite(r->point[0]) || !is_finite(r->point[1])) continue;
    along.push_back({arc, piece, *r});
    add_ruling(along.back());
  }
  for (std::size_t k = 0; k + 1 < along.size(); ++k) {
    for (int i = 0; i < 2; ++i) {
      const int a = begin + 2 * int(k) + i;
      all_.chords.push_back({a, a + 2, i, along[k], along[k + 1]});
    }
  }
}

/// Whether the border is part of a curve that no rulings are sampled along, and not passed from
/// its other side.
bool BoundarySampler::samples_border(const PatchRegion& region, int face,
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
Ruling BoundarySampler::border_place(const PatchRegion& region, Side side, double t) const {
  const dvec2 uv = on_side(side, t);
  const Contact c = {region.instance, SourceKind::face, region.patch, uv.x, uv.y};
  const BezierPatch& patch = geometry_.part(c).patches()[std::size_t(region.patch)].bezier;
  const dvec3 n =
      double(region.sign) * geometry_.to_frame(c.instance, unit_normal(patch, c.u, c.v));
  const dvec3 x = geometry_.point(c);
  return {n, {c, c}, {x, x}};
}

/// Enough places to tell how a stretch bends.
std::vector<Ruling> BoundarySampler::border_places(const PatchRegion& region,
                                                   const TrimStretch& stretch) const {
  std::vector<Ruling> places;
  for (int k = 0; k <= border_intervals; ++k) {
    const double t = Interval{stretch.from, stretch.to}.at(double(k) / border_intervals);
    places.push_back(border_place(region, stretch.side, t));
  }
  return places;
}

/// Few places, without their contacts, and but for a shift of the whole.
std::vector<Ruling> BoundarySampler::coarse_places(const PatchRegion& region,
                                                   const TrimStretch& stretch) const {
  const Part& part = geometry_.part({region.instance, SourceKind::face, region.patch, 0, 0});
  const BezierPatch& patch = part.patches()[std::size_t(region.patch)].bezier;
  std::vector<Ruling> places;
  for (int k = 0; k <= coarse_intervals; ++k) {
    const double t = Interval{stretch.from, stretch.to}.at(double(k) / coarse_intervals);
    const dvec2 uv = on_side(stretch.side, t);
    const PatchJet1 j = jet1(patch, uv.x, uv.y);
    const dvec3 n = double(region.sign) * unit(glm::cross(j.Su, j.Sv));
    const dvec3 x = geometry_.to_frame(region.instance, frame_.scale * j.S);
    places.push_back({geometry_.to_frame(region.instance, n), {}, {x, x}});
  }
  return places;
}

/// The sagitta allowed where the patch meets facets: without this the rim's chords would be halved.
double BoundarySampler::border_sagitta(const std::vector<Ruling>& places,
                                       const HullCurve& curve) const {
  double turn = 0;
  for (const int f : curve.faces) {
    if (f < 0 || boundary_.faces[std::size_t(f)].kind != FaceKind::facet) continue;
    for (const Ruling& place : places) {
      turn = std::max(turn, glm::distance(place.n, boundary_.faces[std::size_t(f)].n));
    }
  }
  return turn * sagitta_ > rim_ ? rim_ / turn : sagitta_;
}

void BoundarySampler::add_border(const PatchRegion& region, const TrimStretch& stretch) {
  const HullCurve& curve = boundary_.curves[std::size_t(stretch.curve)];
  double sagitta = 0;
  EvenDivision division;
  const auto divide = [&](const std::vector<Ruling>& places) {
    sagitta = border_sagitta(places, curve);
    division = EvenDivision();
    division.add(places, [&] { return places[0]; });
  };
  divide(coarse_places(region, stretch));
  const bool coarse = division.parts(sagitta) <= worth_dividing;
  if (!coarse) divide(border_places(region, stretch));
  for (const EvenDivision::Place& place : division.places(sagitta, 1)) {
    const double s =
        (double(place.interval) + place.s) / (coarse ? coarse_intervals : border_intervals);
    const double at = Interval{stretch.from, stretch.to}.at(s);
    const Ruling r = border_place(region, stretch.side, at);
    TouchedFaces touched;
    for (const int f : curve.faces) touch(touched, {f, 0});
    add(r.n, r.contact[0], std::move(touched));
  }
}

void BoundarySampler::add_border_row(const PatchRegion& region, const TrimStretch& stretch) {
  const std::vector<double> coarse = form_lengths(coarse_places(region, stretch));
  const double length = std::accumulate(coarse.begin(), coarse.end(), 0.0);
  if (length <= worth_dividing * first_visit * side_) return;
  const std::vector<Ruling> places = border_places(region, stretch);
  visit_evenly(form_lengths(places), side_, [&](std::size_t k, double s) {
    const double at = (double(k) + s) / border_intervals;
    const double t = Interval{stretch.from, stretch.to}.at(at);
    const Ruling r = border_place(region, stretch.side, t);
    // With the region to the left in (u, v), it is so from outside if the normal is Su x Sv.
    const dvec3 along = unit(places[k + 1].point[0] - places[k].point[0]);
    const dvec3 across = double(region.sign) * unit(glm::cross(r.n, along));
    add_beside(geometry_.jet(r.contact[0]), r.n, across, r.contact[0]);
  });
}

/// Adds the support point of the direction that lies across from a place on a patch's border or
/// trim, so far that the point moves by the height of an equilateral triangle. The contact moves by
/// -B^-1 r for r = (Su . across, Sv . across), and -r . B^-1 r is that step's form.
void BoundarySampler::add_beside(const ContactJet& jet, const dvec3& n, const dvec3& across,
                                 const Contact& hint) {
  const double a = -glm::dot(jet.dxx, n);
  const double b = -glm::dot(jet.dxy, n);
  const double c = -glm::dot(jet.dyy, n);
  const double det = a * c - b * b;
  const dvec2 r(glm::dot(jet.dx[0], across), glm::dot(jet.dx[1], across));
  const double form = (c * r.x * r.x - 2 * b * r.x * r.y + a * r.y * r.y) / det;
  if (!(a > 0 && det > 0 && form > 0)) return;
  const double step = std::sqrt(0.75 / form) * side_;
  if (!(step < largest_step)) return;
  const dvec3 beside = unit(n + step * across);
  const Support s = query_(beside, hint);
  const Contact contact = geometry_.canonical(s.contact);
  all_.samples.push_back({beside, contact, true});
  all_.points.push_back(frame_.to_model(s.point));
  all_.faces.push_back(faces_.touched(contact));
  clear_.push_back(clear_share * frame_.length_to_model(glm::distance(s.point, jet.x)));
}

void BoundarySampler::add_rows(int arc, int piece) {
  const std::vector<Ruling>& rulings =
      boundary_.arcs[std::size_t(arc)].pieces[std::size_t(piece)].rulings;
  for (std::size_t i = 0; i < 2; ++i) {
    if (rulings.front().contact[i].kind != SourceKind::face) continue;
    visit_evenly(form_lengths(rulings, i), side_, [&](std::size_t k, double s) {
      const std::optional<Ruling> r = ruling_between(system_, rulings[k], rulings[k + 1], s);
      if (!r) return;
      const dvec3 across = unit(r->point[i] - r->point[1 - i]);
      add_beside(geometry_.jet(r->contact[i]), r->n, across, r->contact[i]);
    });
  }
}

BoundarySamples BoundarySampler::run() {
  for (int f = 0; f < int(boundary_.faces.size()); ++f) add_facet(f);
  for (int a = 0; a < int(boundary_.arcs.size()); ++a) add_arc(a);
  const auto for_each_border = [&](auto visit) {
    for (int f = 0; f < int(boundary_.faces.size()); ++f) {
      for (const PatchRegion& region : boundary_.faces[std::size_t(f)].regions) {
        for (const std::vector<TrimStretch>& loop : region.loops) {
          for (const TrimStretch& stretch : loop) visit(f, region, stretch);
        }
      }
    }
  };
  for_each_border([&](int f, const PatchRegion& region, const TrimStretch& stretch) {
    if (samples_border(region, f, stretch)) add_border(region, stretch);
  });
  for (int a = 0; a < int(boundary_.arcs.size()); ++a) {
    const int pieces = int(boundary_.arcs[std::size_t(a)].pieces.size());
    for (int p = 0; p < pieces; ++p) add_rows(a, p);
  }
  for_each_border([&](int, const PatchRegion& region, const TrimStretch& stretch) {
    if (stretch.arc < 0 && stretch.curve >= 0) add_border_row(region, stretch);
  });
  return without_near_ones(all_, clear_, width_, frame_.center);
}

}  // namespace

BoundarySamples boundary_samples(const ContactGeometry& geometry, const HullBoundary& boundary,
                                 const ContactFaces& faces, const SampleSpacing& spacing,
                                 SupportQuery& query) {
  return BoundarySampler(geometry, boundary, faces, spacing, query).run();
}

}  // namespace taut
