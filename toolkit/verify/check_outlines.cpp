#include "taut/verify/check_outlines.h"

#include <functional>
#include <optional>
#include <set>

#include "taut/core/integers.h"
#include "taut/verify/closest_on_curve.h"
#include "taut/verify/nearest_point.h"
#include "taut/verify/stated_bounds.h"

namespace taut {
namespace {

using Curve = HullDocument::Curve;
using DirectedCurve = HullDocument::DirectedCurve;
using Face = HullDocument::Face;

/// Share of the distance within which points are one below which they are the same but for
/// rounding.
constexpr double listed_share = 1e-4;

std::string at(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]: ";
}

/// Checks one document.
class OutlineCheck {
 public:
  OutlineCheck(const DocumentGeometry& geometry, const DocumentOutlines& outlines, double tolerance,
               double resolution, HullFaults& faults)
      : geometry_(geometry),
        outlines_(outlines),
        hull_(geometry.hull()),
        tolerance_(tolerance),
        resolution_(resolution),
        listed_(listed_share * tolerance),
        faults_(faults) {}
  double run();

 private:
  /// What is no farther off than the bound of the curve or face at hand is not off.
  void see(double distance) { raise(off_, std::max(distance - bound_, 0.0)); }
  /// A stretch along a side of one of a source's Bezier patches.
  struct Border {
    int source = -1;
    OutlineStretch stretch;
  };
  void check_kind(std::size_t curve);
  bool is_straight(const Curve& curve) const;
  bool is_edge(int source) const {
    return source >= 0 && geometry_.source(source).kind == SourceKind::edge;
  }
  void check_edge(const Curve& curve);
  double distance_to_edge(int edge, const dvec3& p) const;
  void check_order(std::size_t face);
  void check_sides(std::size_t face, std::size_t contact);
  void check_ruling_ends(const Curve& curve, const Face& scroll);
  void check_patch(std::size_t face);
  void check_free_stretches(std::size_t face);
  void check_loop(const Face& face, const HullDocument::Loop& loop);
  std::vector<Border> borders_of(const Face& scroll, std::size_t contact) const;
  void add_borders_of(int face, std::vector<Border>& borders) const;
  double distance(const dvec3& p, const NearestPoint& points,
                  const std::vector<Border>& borders) const;
  std::optional<dvec3> point_near(int source, const dvec2& uv, const NearestPoint& curves) const;
  double distance_to_border(int source, const OutlineStretch& stretch, const dvec3& p) const;
  void check_tracks();
  using SideJet = std::function<SourceJet(double)>;
  std::optional<SideJet> side_jet(const Face& facet, std::size_t side) const;
  void check_facet(std::size_t face);
  void check_facet_sides(std::size_t face);
  bool is_convex(const std::vector<dvec3>& points, const Face& facet) const;
  /// The length within which the face's structure is not told apart; zero where it is exact.
  double untold(const Face& face) const {
    return face.tolerant > 0 ? std::max(face.tolerant, resolution_) : 0;
  }
  std::vector<dvec3> points_of(const std::vector<int>& curves) const;
  std::vector<dvec3> points_of(const std::vector<DirectedCurve>& curves) const;

  const DocumentGeometry& geometry_;
  const DocumentOutlines& outlines_;
  const HullDocument& hull_;
  double tolerance_;
  double resolution_;
  double listed_;  ///< a point is one of those listed; else what lies between them is asked
  HullFaults& faults_;
  double bound_ = 0;
  double off_ = 0;
};

double OutlineCheck::run() {
  for (std::size_t i = 0; i < hull_.curves.size(); ++i) {
    bound_ = bound_of(hull_, hull_.curves[i]);
    check_kind(i);
  }
  const std::vector<double> bounds = bounds_beside(hull_);
  for (std::size_t i = 0; i < hull_.faces.size(); ++i) {
    const Face& face = hull_.faces[i];
    bound_ = bounds[i];
    if (face.kind == FaceKind::patch) check_patch(i);
    if (face.kind == FaceKind::facet) check_facet(i);
    if (face.kind != FaceKind::scroll) continue;
    check_order(i);
    for (const std::size_t k : {0U, 1U}) check_sides(i, k);
  }
  check_tracks();
  return off_;
}

bool OutlineCheck::is_straight(const Curve& curve) const {
  return std::all_of(curve.points.begin(), curve.points.end(), [&](const dvec3& p) {
    return distance_to_segment(p, curve.points.front(), curve.points.back()) <= tolerance_;
  });
}

void OutlineCheck::check_kind(std::size_t i) {
  const Curve& curve = hull_.curves[i];
  std::vector<const Face*> faces;
  for (const int face : curve.faces) {
    if (face >= 0) faces.push_back(&hull_.faces[to_size(face)]);
  }
  // Of a planar hull there is but one.
  if (faces.size() < 2 && hull_.dimension != 2) return;
  int patches = 0;
  for (const Face* face : faces) patches += face->kind == FaceKind::patch ? 1 : 0;
  const auto wrong = [&](const char* what) { faults_.add("kinds", at("curves", i) + what); };
  switch (curve.kind) {
    case HullCurveKind::edge:
      if (!is_edge(curve.source)) return wrong("an edge without one of the model's");
      return check_edge(curve);
    case HullCurveKind::join:
      if (patches != 2) return wrong("a join not between two patches");
      if (faces[0]->source == faces[1]->source) wrong("a join within one source face");
      break;
    case HullCurveKind::bitangent:
      if (patches != 1) wrong("a bitangent curve not along one patch");
      break;
    case HullCurveKind::ruling:
      if (patches > 0) wrong("a ruling along a patch");
      if (!is_straight(curve)) wrong("a ruling that is not straight");
      for (const Face* face : faces) {
        if (face->kind == FaceKind::scroll) check_ruling_ends(curve, *face);
      }
  }
  if (curve.source >= 0) wrong("only edges have a source");
}

void OutlineCheck::check_edge(const Curve& curve) {
  for (const dvec3& p : curve.points) see(distance_to_edge(curve.source, p));
}

double OutlineCheck::distance_to_edge(int edge, const dvec3& p) const {
  const int pieces = int(geometry_.source(edge).patches.size());
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < pieces && best > 0; ++i) {
    const auto jet = [&](double t) { return geometry_.jet(edge, {i, dvec2(t, 0)}); };
    best = std::min(best, closest_on_curve(geometry_.local(p), 0, 1, jet).distance);
  }
  return best;
}

/// Whether the contacts of either ruling support within the length where those of the other do.
bool has_same_contacts(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
                       double length) {
  const auto is_same = [&](const dvec3& step) {
    return std::abs(glm::dot(step, from.n)) <= length && std::abs(glm::dot(step, to.n)) <= length;
  };
  return length > 0 && is_same(to.a.p - from.a.p) && is_same(to.b.p - from.b.p);
}

/// Whether n and both contacts go on to the scroll's left, seen along contact a: on a convex hull
/// they do, also where a contact comes from an edge and leaves it at a sharp angle.
bool goes_on(const HullDocument::Ruling& from, const HullDocument::Ruling& to, double tolerance) {
  const dvec3 d = 0.5 * (from.b.p - from.a.p + to.b.p - to.a.p);
  const dvec3 on = unit(glm::cross(d, from.n + to.n));
  return glm::dot(to.n - from.n, on) > 0 && glm::dot(to.a.p - from.a.p, on) >= -tolerance &&
         glm::dot(to.b.p - from.b.p, on) >= -tolerance;
}

/// From one ruling to the next, n and the contacts go on: a step that makes an obtuse angle with
/// the one before, but for what the tolerance leaves of either's direction, goes on to the left.
/// Where a contact comes to an end in which its edge does not bend, n stands still before it turns:
/// the angle is a right one. Of a tolerant scroll, rulings with the same contacts to the resolution
/// have no order.
void OutlineCheck::check_order(std::size_t f) {
  const std::vector<HullDocument::Ruling>& rulings = hull_.faces[f].rulings;
  const double size = hull_.diagonal > 0 ? hull_.diagonal : 1;
  using Step = std::array<dvec3, 3>;
  Step last{};
  double last_length = 0;
  bool any = false;
  double area = 0;
  for (std::size_t i = 0; i + 1 < rulings.size(); ++i) {
    const HullDocument::Ruling& from = rulings[i];
    const HullDocument::Ruling& to = rulings[i + 1];
    const Step step = {to.n - from.n, (to.a.p - from.a.p) / size, (to.b.p - from.b.p) / size};
    area += glm::dot(from.n, glm::cross(step[1] + step[2], (from.b.p - from.a.p) / size));
    double length = 0;
    double along = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      length += glm::dot(step[k], step[k]);
      along += glm::dot(step[k], last[k]);
    }
    length = std::sqrt(length);
    if (!(length > tolerance_ / size)) continue;
    const bool is_obtuse = any && !(along > -(tolerance_ / size) * (length + last_length));
    if (is_obtuse && !goes_on(from, to, tolerance_)) {
      if (has_same_contacts(from, to, untold(hull_.faces[f]))) continue;
      faults_.add("order", at("faces", f) + "its rulings turn back after rulings[" +
                               std::to_string(i) + "]");
    }
    last = step;
    last_length = length;
    any = true;
  }
  // Along them, contact a has the scroll to the left.
  if (!(area >= -tolerance_ / size)) {
    faults_.add("order", at("faces", f) + "its rulings run backwards");
  }
}

std::vector<dvec3> OutlineCheck::points_of(const std::vector<int>& curves) const {
  std::vector<dvec3> points;
  for (const int c : curves) {
    const std::vector<dvec3>& more = hull_.curves[to_size(c)].points;
    points.insert(points.end(), more.begin(), more.end());
  }
  return points;
}

/// Where both run along borders, a scroll's contacts and the curve along them need not have the
/// same points, but either lies on the other's border. An edge has the points of both sides, and
/// ends where the face on the other side does.
void OutlineCheck::check_sides(std::size_t f, std::size_t k) {
  const Face& scroll = hull_.faces[f];
  if (scroll.curves[k].empty()) return;
  std::vector<dvec3> contacts;
  contacts.reserve(scroll.rulings.size());
  for (const HullDocument::Ruling& r : scroll.rulings) contacts.push_back(k == 0 ? r.a.p : r.b.p);
  const NearestPoint listed(contacts);
  const std::vector<Border> own = borders_of(scroll, k);
  std::vector<Border> others;
  std::set<int> edges;
  for (const int c : scroll.curves[k]) {
    const Curve& curve = hull_.curves[to_size(c)];
    if (curve.kind == HullCurveKind::edge) {
      if (is_edge(curve.source)) edges.insert(curve.source);
      continue;
    }
    for (const dvec3& p : curve.points) see(distance(p, listed, own));
    const int other = curve.faces[curve.faces[0] == int(f) ? 1 : 0];
    if (other >= 0) add_borders_of(other, others);
  }
  const NearestPoint curves(points_of(scroll.curves[k]));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const HullDocument::Ruling& r = scroll.rulings[i];
    // That a contact is on its source is checked as well.
    if (edges.count(k == 0 ? r.a.source : r.b.source) > 0) continue;
    const dvec3& p = contacts[i];
    double off = distance(p, curves, others);
    for (const int edge : edges) {
      if (off > listed_) off = std::min(off, distance_to_edge(edge, p));
    }
    see(off);
  }
}

/// Along a scroll's contacts, between neighbouring rulings.
std::vector<OutlineCheck::Border> OutlineCheck::borders_of(const Face& scroll,
                                                           std::size_t k) const {
  std::vector<Border> borders;
  for (std::size_t i = 0; i + 1 < scroll.rulings.size(); ++i) {
    const HullDocument::Contact& from = k == 0 ? scroll.rulings[i].a : scroll.rulings[i].b;
    const HullDocument::Contact& to = k == 0 ? scroll.rulings[i + 1].a : scroll.rulings[i + 1].b;
    if (from.source != to.source || geometry_.source(from.source).kind != SourceKind::face)
      continue;
    const auto border = outlines_.border(from.source, parameters(from), parameters(to));
    if (border) borders.push_back({from.source, *border});
  }
  return borders;
}

/// Of a patch's regions.
void OutlineCheck::add_borders_of(int face, std::vector<Border>& borders) const {
  for (const RegionOutline& region : outlines_.regions()) {
    if (region.face != face) continue;
    for (const std::vector<OutlineStretch>& loop : region.loops) {
      for (const OutlineStretch& stretch : loop) {
        if (stretch.kind != OutlineStretch::Kind::border) continue;
        borders.push_back({hull_.faces[to_size(face)].source, stretch});
      }
    }
  }
}

double OutlineCheck::distance(const dvec3& p, const NearestPoint& points,
                              const std::vector<Border>& borders) const {
  double best = points.distance(p);
  for (std::size_t b = 0; b < borders.size() && best > listed_; ++b) {
    best = std::min(best, distance_to_border(borders[b].source, borders[b].stretch, p));
  }
  return best;
}

/// The straight sides of a scroll are its first and its last ruling.
void OutlineCheck::check_ruling_ends(const Curve& curve, const Face& scroll) {
  if (scroll.rulings.empty()) return;
  double best = std::numeric_limits<double>::infinity();
  for (const HullDocument::Ruling* r : {&scroll.rulings.front(), &scroll.rulings.back()}) {
    for (const bool turned : {false, true}) {
      const dvec3& a = turned ? r->b.p : r->a.p;
      const dvec3& b = turned ? r->a.p : r->b.p;
      best = std::min(best, std::max(glm::distance(curve.points.front(), a),
                                     glm::distance(curve.points.back(), b)));
    }
  }
  see(best);
}

/// The source's point with these parameters. Patches that are no neighbours may have them too, of
/// these points that which is nearest to the curves.
std::optional<dvec3> OutlineCheck::point_near(int source, const dvec2& uv,
                                              const NearestPoint& curves) const {
  std::optional<dvec3> best;
  for (const SourcePlace& place : geometry_.places(source, uv)) {
    const dvec3 x = geometry_.jet(source, place).x + geometry_.origin();
    if (!best || curves.distance(x) < curves.distance(*best)) best = x;
  }
  return best;
}

void OutlineCheck::check_patch(std::size_t f) {
  const Face& face = hull_.faces[f];
  if (face.regions.empty()) faults_.add("regions", at("faces", f) + "a patch without regions");
  for (const HullDocument::Loop& loop : face.loops) {
    if (loop.curves.empty() || loop.uv.empty()) {
      faults_.add("regions", at("faces", f) + "an empty loop");
    } else {
      check_loop(face, loop);
    }
  }
  check_free_stretches(f);
}

/// Where a region's outline is neither a track nor a border, its points are those of the curves.
void OutlineCheck::check_free_stretches(std::size_t f) {
  const Face& face = hull_.faces[f];
  std::vector<dvec3> points;
  for (const HullDocument::Loop& loop : face.loops) {
    const std::vector<dvec3> more = points_of(loop.curves);
    points.insert(points.end(), more.begin(), more.end());
  }
  const NearestPoint curves(points);
  const auto check = [&](const dvec2& uv) {
    const std::optional<dvec3> x = point_near(face.source, uv, curves);
    if (!x) return see(std::numeric_limits<double>::infinity());
    see(curves.distance(*x));
  };
  for (const RegionOutline& region : outlines_.regions()) {
    if (region.face != int(f)) continue;
    for (const std::vector<OutlineStretch>& loop : region.loops) {
      for (const OutlineStretch& stretch : loop) {
        if (stretch.kind != OutlineStretch::Kind::free) continue;
        check(stretch.from);
        check(stretch.to);
      }
    }
  }
}

/// Each point of the loop that is no border's is one of its curves', and each point of these lies
/// on the loop.
void OutlineCheck::check_loop(const Face& face, const HullDocument::Loop& loop) {
  const std::vector<dvec3> points = points_of(loop.curves);
  const NearestPoint curves(points);
  std::vector<dvec3> own;
  std::vector<Border> borders;
  own.reserve(loop.uv.size());
  bool last_on_border = false;
  for (std::size_t k = 0; k < loop.uv.size(); ++k) {
    const std::size_t next = (k + 1) % loop.uv.size();
    const OutlineStretch stretch = outlines_.stretch(face.source, loop.uv[k], loop.uv[next]);
    const bool on_border = stretch.kind == OutlineStretch::Kind::border;
    const std::optional<dvec3> x = point_near(face.source, loop.uv[k], curves);
    if (!x) return see(std::numeric_limits<double>::infinity());
    own.push_back(*x);
    if (!(on_border && (last_on_border || k == 0))) see(curves.distance(*x));
    if (on_border) borders.push_back({face.source, stretch});
    last_on_border = on_border;
  }
  const NearestPoint listed(own);
  for (const dvec3& p : points) see(distance(p, listed, borders));
}

double OutlineCheck::distance_to_border(int source, const OutlineStretch& stretch,
                                        const dvec3& p) const {
  const int k = stretch.from.x == stretch.to.x ? 1 : 0;
  double best = std::numeric_limits<double>::infinity();
  for (const SourcePlace& from : geometry_.places(source, stretch.from)) {
    for (const SourcePlace& to : geometry_.places(source, stretch.to)) {
      if (from.patch != to.patch) continue;
      const auto along = [&](double t) {
        SourcePlace place = from;
        place.t[k] = t;
        SourceJet j = geometry_.jet(source, place);
        if (k == 1) {
          std::swap(j.dx[0], j.dx[1]);
          std::swap(j.dxx, j.dyy);
        }
        return j;
      };
      best =
          std::min(best, closest_on_curve(geometry_.local(p), from.t[k], to.t[k], along).distance);
    }
  }
  return best;
}

/// Each track of a scroll on a source face bounds a region, once from each side at most, and is
/// part of the outline of the same patch, where it runs the other way about if the patch is seen
/// from within.
void OutlineCheck::check_tracks() {
  using Key = std::array<double, 6>;
  std::multiset<Key> in_regions, in_loops;
  const auto add = [&](std::multiset<Key>& keys, int face, int source, const dvec2& from,
                       const dvec2& to) {
    if (outlines_.stretch(source, from, to).kind != OutlineStretch::Kind::track) return;
    keys.insert({double(face), double(source), from.x, from.y, to.x, to.y});
  };
  for (int f = 0; f < int(hull_.faces.size()); ++f) {
    const Face& face = hull_.faces[to_size(f)];
    for (const HullDocument::Loop& loop : face.loops) {
      for (std::size_t k = 0; k < loop.uv.size(); ++k) {
        add(in_loops, f, face.source, loop.uv[k], loop.uv[(k + 1) % loop.uv.size()]);
      }
    }
    for (const HullDocument::Region& region : face.regions) {
      for (const std::vector<dvec2>& loop : region.loops) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
          const dvec2& from = loop[k];
          const dvec2& to = loop[(k + 1) % loop.size()];
          add(in_regions, f, face.source, region.sign > 0 ? from : to, region.sign > 0 ? to : from);
        }
      }
    }
  }
  if (in_regions != in_loops) {
    faults_.add("regions", "the outlines of regions are not those of their patches");
  }
}

/// The area of the convex hull of points in a plane less that of the polygon which they make: zero
/// if that is convex and runs counter-clockwise once.
double lack_of_area(std::vector<dvec2> points) {
  const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
  const auto area = [&](const std::vector<dvec2>& polygon) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      sum += cross(polygon[k] - polygon[0], polygon[(k + 1) % polygon.size()] - polygon[0]) / 2;
    }
    return sum;
  };
  const double own = area(points);
  std::sort(points.begin(), points.end(),
            [](const dvec2& a, const dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<dvec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const dvec2& p : points) {
      while (hull.size() >= base + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return area(hull) - own;
}

std::vector<dvec3> OutlineCheck::points_of(const std::vector<DirectedCurve>& curves) const {
  std::vector<dvec3> line;
  for (const DirectedCurve& c : curves) {
    std::vector<dvec3> points = hull_.curves[to_size(c.first)].points;
    if (c.second < 0) std::reverse(points.begin(), points.end());
    line.insert(line.end(), points.begin(), points.end());
  }
  return line;
}

/// Points that run about a convex polygon, counter-clockwise seen against the normal; of a tolerant
/// facet, one that is convex if its points are no farther off than the resolution.
bool OutlineCheck::is_convex(const std::vector<dvec3>& points, const Face& facet) const {
  const auto [e, g] = tangent_frame(unit(facet.normal));
  std::vector<dvec2> flat;
  flat.reserve(points.size());
  double girth = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const dvec3 from_first = points[k] - points[0];
    flat.emplace_back(glm::dot(from_first, e), glm::dot(from_first, g));
    girth += glm::distance(points[k], points[(k + 1) % points.size()]);
  }
  return lack_of_area(flat) <= (tolerance_ + untold(facet)) * girth;
}

/// The facet's curves run along its sides, and these the same way about.
void OutlineCheck::check_facet_sides(std::size_t f) {
  constexpr int parts = 4;
  const Face& face = hull_.faces[f];
  const std::size_t count = face.contacts.size();
  if (count == 0) return faults_.add("outlines", at("faces", f) + "a facet without contacts");
  std::vector<dvec3> polygon;
  polygon.reserve(parts * count);
  std::vector<SideJet> sides;
  for (std::size_t k = 0; k < count; ++k) {
    const auto side = side_jet(face, k);
    if (!side) return see(std::numeric_limits<double>::infinity());
    for (int i = 0; i < parts; ++i) {
      polygon.push_back((*side)(double(i) / parts).x + geometry_.origin());
    }
    sides.push_back(*side);
  }
  // Neighbouring points lie along the same side, or the next one. Where it is no farther off than
  // what has been seen, others do not matter.
  std::size_t nearest = 0;
  for (const dvec3& p : points_of(face.outline)) {
    double off = std::numeric_limits<double>::infinity();
    const std::size_t first = nearest;
    const double seen = std::max(listed_, off_ + bound_);
    for (std::size_t i = 0; i < count && off > seen; ++i) {
      const std::size_t k = (first + i) % count;
      const double distance = closest_on_curve(geometry_.local(p), 0, 1, sides[k]).distance;
      if (!(distance < off)) continue;
      off = distance;
      nearest = k;
    }
    see(off);
  }
  if (!is_convex(polygon, face)) {
    faults_.add("outlines", at("faces", f) + "the facet's sides are not convex");
  }
}

/// A side over [0, 1]; none if it is in no one Bezier patch.
std::optional<OutlineCheck::SideJet> OutlineCheck::side_jet(const Face& facet,
                                                            std::size_t k) const {
  if (k >= facet.sides.size() || facet.sides[k].source < 0) {
    const dvec3 a = geometry_.local(facet.contacts[k].p);
    const dvec3 d = geometry_.local(facet.contacts[(k + 1) % facet.contacts.size()].p) - a;
    return [a, d](double s) { return SourceJet{1, a + s * d, {d, dvec3(0.0)}}; };
  }
  const HullDocument::Side& side = facet.sides[k];
  const HullDocument::Contact from = {side.source, side.from, dvec3(0.0)};
  const HullDocument::Contact to = {side.source, side.to, dvec3(0.0)};
  for (const SourcePlace& p : geometry_.places(from)) {
    for (const SourcePlace& q : geometry_.places(to)) {
      if (p.patch != q.patch) continue;
      return [this, source = side.source, p, d = q.t - p.t](double s) {
        SourceJet j = geometry_.jet(source, {p.patch, p.t + s * d});
        j.dxx = d.x * d.x * j.dxx + 2 * d.x * d.y * j.dxy + d.y * d.y * j.dyy;
        j.dx[0] = d.x * j.dx[0] + d.y * j.dx[1];
        return j;
      };
    }
  }
  return std::nullopt;
}

void OutlineCheck::check_facet(std::size_t f) {
  const Face& face = hull_.faces[f];
  if (face.boundary.size() < 3) {
    return faults_.add("outlines", at("faces", f) + "a facet without a boundary");
  }
  if (!is_convex(face.boundary, face)) {
    faults_.add("outlines", at("faces", f) + "the facet's boundary is not convex");
  }
  check_facet_sides(f);
  const std::vector<dvec3> along = points_of(face.outline);
  if (along.empty()) return faults_.add("outlines", at("faces", f) + "a facet without curves");
  const NearestPoint curves(along);
  const NearestPoint boundary(face.boundary);
  for (const dvec3& p : face.boundary) see(curves.distance(p));
  for (const dvec3& p : along) see(boundary.distance(p));
}

}  // namespace

double check_outlines(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                      double tolerance, double resolution, HullFaults& faults) {
  return OutlineCheck(geometry, outlines, tolerance, resolution, faults).run();
}

}  // namespace taut
