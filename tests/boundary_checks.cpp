#include "boundary_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut_test {
namespace {

using taut::Contact;
using taut::dvec2;
using taut::EdgeStretch;
using taut::FaceKind;
using taut::HullBoundary;
using taut::HullCurve;
using taut::HullFace;
using taut::PatchRegion;
using taut::Ruling;
using taut::Side;
using taut::SourceKind;
using taut::TrimStretch;
using rvec2 = glm::vec<2, real>;

const taut::ArcPiece& piece_of(const HullBoundary& boundary, const TrimStretch& s) {
  return boundary.arcs.at(std::size_t(s.arc)).pieces.at(std::size_t(s.piece));
}

/// A contact's parameters in a patch, of one on the patch's border too.
dvec2 parameters(const taut::ContactGeometry& geometry, const Contact& c, int patch) {
  if (c.kind == SourceKind::edge) {
    for (const auto& side : geometry.sides(c)) {
      if (side.patch == patch) return on_side(side.side, side.reversed ? 1 - c.u : c.u);
    }
  }
  return {c.u, c.v};
}

dvec2 end_of(const taut::ContactGeometry& geometry, const HullBoundary& boundary,
             const PatchRegion& region, const TrimStretch& s, bool last) {
  if (s.arc < 0) return on_side(s.side, last ? s.to : s.from);
  const std::vector<Ruling>& rulings = piece_of(boundary, s).rulings;
  const Ruling& r = last == s.reversed ? rulings.front() : rulings.back();
  return parameters(geometry, r.contact.at(std::size_t(s.contact)), region.patch);
}

/// Sums up an outline's sides as seen from a point.
class Winding {
 public:
  explicit Winding(const dvec2& at) : at_(at) {}

  real distance(const dvec2& a, const dvec2& b) const {
    const rvec2 p = rvec2(a) - at_;
    const rvec2 edge = rvec2(b) - rvec2(a);
    const real square = glm::dot(edge, edge);
    const real t = square > 0 ? std::clamp(-glm::dot(p, edge) / square, real(0), real(1)) : 0;
    return glm::length(p + t * edge);
  }
  /// Crossings of the ray towards growing u.
  void add(const dvec2& a, const dvec2& b) {
    place_.distance = std::min(place_.distance, distance(a, b));
    const rvec2 p = rvec2(a) - at_;
    const rvec2 q = rvec2(b) - at_;
    if ((p.y > 0) == (q.y > 0)) return;
    const real u = p.x - p.y * (q.x - p.x) / (q.y - p.y);
    if (u > 0) place_.winding += q.y > p.y ? 1 : -1;
  }
  PlaceInLoops place() const { return place_; }

 private:
  rvec2 at_;
  PlaceInLoops place_ = {0, std::numeric_limits<real>::infinity()};
};

/// Adds a part of an arc, bisected where it is long against its distance.
void add_part(const taut::ContactSystem& system, const TrimStretch& s, int patch,
              const Ruling& from, const Ruling& to, int depth, Winding& winding) {
  const auto at = [&](const Ruling& r) {
    return parameters(system.geometry(), r.contact.at(std::size_t(s.contact)), patch);
  };
  const dvec2 a = at(from);
  const dvec2 b = at(to);
  if (depth > 0 && winding.distance(a, b) < glm::distance(a, b)) {
    const std::optional<Ruling> middle = ruling_between(system, from, to, 0.5);
    if (!middle) depth = 1;
    add_part(system, s, patch, from, middle.value_or(to), depth - 1, winding);
    if (middle) add_part(system, s, patch, *middle, to, depth - 1, winding);
  } else if (s.reversed) {
    winding.add(b, a);
  } else {
    winding.add(a, b);
  }
}

/// Collects what is wrong with a boundary.
class BoundaryCheck {
 public:
  BoundaryCheck(const taut::Scene& scene, const HullBoundary& boundary)
      : scene_(scene), boundary_(boundary), geometry_(scene), query_(scene) {}

  BoundaryFacts run(int directions) {
    check_curves();
    check_facet_outlines();
    check_sides();
    check_regions();
    check_residuals();
    check_directions(directions);
    check_points(directions);
    return facts_;
  }

 private:
  static constexpr double same_point = 1e-9;
  /// Points whose support is decided by less than this, or whose place by less, are passed over.
  static constexpr double undecided = 1e-6;
  static constexpr double supports = 1e-12;

  static void raise(double& largest, double value) {
    largest = std::isnan(value) ? std::numeric_limits<double>::infinity()
                                : std::max(largest, std::abs(value));
  }

  int vertex_number(const dvec3& x) {
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      if (glm::distance(vertices_[k], x) <= same_point) return int(k);
    }
    vertices_.push_back(x);
    return int(vertices_.size()) - 1;
  }

  int characteristic(const HullFace& face) const {
    if (face.kind == FaceKind::facet) return 1;
    if (face.kind == FaceKind::patch) return 2 - int(face.loops.size());
    const taut::SeparatingArc& arc = boundary_.arcs.at(std::size_t(face.scroll.arc));
    if (!arc.closed || face.scroll.count < int(arc.pieces.size())) return 1;
    // An annulus, or a cone about its apex.
    return 2 - (face.scroll_curves[0].empty() ? 0 : 1) - (face.scroll_curves[1].empty() ? 0 : 1);
  }

  bool is_bare(const HullFace& face) const {
    const taut::SeparatingArc& arc = boundary_.arcs.at(std::size_t(face.scroll.arc));
    const Ruling& first = arc.pieces.at(std::size_t(face.scroll.first)).rulings.front();
    for (std::size_t i = 0; i < 2; ++i) {
      const bool at_vertex = first.contact[i].kind == SourceKind::vertex;
      if (!at_vertex && face.scroll_curves[i].empty()) return true;
    }
    return false;
  }

  void check_curves() {
    for (const HullCurve& curve : boundary_.curves) {
      const int count = int(boundary_.faces.size());
      const auto is_face = [&](int f) { return f >= 0 && f < count; };
      if (!is_face(curve.faces[0]) || !is_face(curve.faces[1])) ++facts_.open_curves;
      if (curve.closed || curve.points.empty()) continue;
      --facts_.euler;
      vertex_number(curve.points.front());
      vertex_number(curve.points.back());
    }
    facts_.euler += long(vertices_.size());
    for (int f = 0; f < int(boundary_.faces.size()); ++f) {
      const HullFace& face = boundary_.faces[std::size_t(f)];
      facts_.euler += characteristic(face);
      if (face.kind == FaceKind::scroll && is_bare(face)) ++facts_.bare_scrolls;
      for (const auto& loop : face.loops) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
          const auto [number, direction] = loop[k];
          const HullCurve& curve = boundary_.curves.at(std::size_t(number));
          if (curve.faces[direction > 0 ? 0 : 1] != f) ++facts_.misplaced;
          const auto [next_number, next_direction] = loop[(k + 1) % loop.size()];
          const HullCurve& next = boundary_.curves.at(std::size_t(next_number));
          const dvec3& end = direction > 0 ? curve.points.back() : curve.points.front();
          const dvec3& begin = next_direction > 0 ? next.points.front() : next.points.back();
          raise(facts_.loop_gap, glm::distance(end, begin));
        }
      }
    }
  }

  void check_facet_outlines() {
    std::vector<std::map<int, int>> balance(boundary_.faces.size());
    std::vector<bool> has_curves(boundary_.faces.size(), false);
    for (const HullCurve& curve : boundary_.curves) {
      if (curve.points.empty()) continue;
      for (const std::size_t k : {0, 1}) {
        if (curve.faces[k] < 0) continue;
        const auto f = std::size_t(curve.faces[k]);
        has_curves[f] = true;
        if (curve.closed) continue;
        ++balance[f][vertex_number(k == 0 ? curve.points.front() : curve.points.back())];
        --balance[f][vertex_number(k == 0 ? curve.points.back() : curve.points.front())];
      }
    }
    for (std::size_t f = 0; f < boundary_.faces.size(); ++f) {
      if (boundary_.faces[f].kind != FaceKind::facet) continue;
      const bool closes = std::all_of(balance[f].begin(), balance[f].end(),
                                      [](const auto& b) { return b.second == 0; });
      if (!has_curves[f] || !closes) ++facts_.open_facets;
    }
  }

  static bool is_curved(const EdgeStretch& side) { return side.piece >= 0; }

  dvec3 point_on(const EdgeStretch& side, double s) const {
    const double t = taut::Interval{side.from, side.to}.at(s);
    return geometry_.point({side.instance, SourceKind::edge, side.piece, t, 0});
  }

  void check_sides() {
    constexpr int parts = 8;
    for (const HullFace& face : boundary_.faces) {
      if (face.kind != FaceKind::facet) continue;
      const std::size_t count = face.contacts.size();
      const bool curved = std::any_of(face.sides.begin(), face.sides.end(), is_curved);
      const bool fits = face.sides.empty() || face.sides.size() == count;
      if (!fits || (count < 3 && !curved)) {
        ++facts_.open_facets;
        continue;
      }
      for (std::size_t k = 0; k < face.sides.size(); ++k) {
        const EdgeStretch& side = face.sides[k];
        if (!is_curved(side)) continue;
        raise(facts_.side, glm::distance(point_on(side, 0), face.points.at(k)));
        raise(facts_.side, glm::distance(point_on(side, 1), face.points.at((k + 1) % count)));
        for (int i = 0; i <= parts; ++i) {
          const dvec3 x = point_on(side, double(i) / parts);
          raise(facts_.tie, glm::dot(x, face.n) - face.offset);
          points_.push_back(x);
        }
      }
    }
  }

  void check_regions() {
    for (const HullFace& face : boundary_.faces) {
      for (const PatchRegion& region : face.regions) {
        for (const auto& loop : region.loops) {
          for (std::size_t k = 0; k < loop.size(); ++k) {
            const dvec2 end = end_of(geometry_, boundary_, region, loop[k], true);
            const dvec2 begin =
                end_of(geometry_, boundary_, region, loop[(k + 1) % loop.size()], false);
            raise(facts_.region_gap, glm::distance(end, begin));
          }
        }
      }
    }
  }

  void check_contact(const dvec3& n, const Contact& c, const dvec3& x) {
    const taut::ContactJet jet = geometry_.jet(c);
    raise(facts_.point, glm::distance(jet.x, x));
    // At a pole one derivative vanishes; its rounding is that of the other.
    double length = 0;
    for (int a = 0; a < jet.dimension; ++a) {
      length = std::max(length, glm::length(jet.dx[std::size_t(a)]));
    }
    for (int a = 0; a < jet.dimension; ++a) {
      if (length > 0) raise(facts_.stationary, glm::dot(jet.dx[std::size_t(a)], n) / length);
    }
  }

  void check_support(const dvec3& n, const Contact& c, const dvec3& x) {
    const double error = std::abs(query_(n, c).h - glm::dot(x, n));
    if (!(error <= facts_.support)) facts_.worst_support = n;
    raise(facts_.support, error);
  }

  /// Between two neighbouring ones, also near free ends, where all lengths are small.
  void check_between(const taut::ContactSystem& system, const Ruling& from, const Ruling& to) {
    constexpr double slack = 1e-9;
    for (const double s : {0.25, 0.6, 0.85}) {
      const std::optional<Ruling> r = taut::ruling_between(system, from, to, s);
      if (!r) {
        ++facts_.no_rulings;
        continue;
      }
      BoundaryFacts own;
      std::swap(own, facts_);
      bool outside = false;
      for (std::size_t i = 0; i < 2; ++i) {
        const Contact& c = r->contact[i];
        check_contact(r->n, c, r->point[i]);
        check_support(r->n, c, r->point[i]);
        const taut::ContactJet jet = geometry_.jet(c);
        // As lengths: about a pole parameters are less exact.
        const auto beyond = [](double t, const dvec3& dx) {
          return (std::abs(t - 0.5) - 0.5) * std::min(1.0, glm::length(dx)) > slack;
        };
        outside = outside || beyond(c.u, jet.dx[0]) || beyond(c.v, jet.dx[1]);
      }
      std::swap(own, facts_);
      raise(facts_.between, std::max({own.point, own.stationary, own.support}));
      raise(facts_.between, glm::dot(r->point[0] - r->point[1], r->n));
      if (outside) ++facts_.no_rulings;
    }
  }

  void check_residuals() {
    const taut::ContactSystem system(geometry_);
    for (const taut::SeparatingArc& arc : boundary_.arcs) {
      for (const taut::ArcPiece& piece : arc.pieces) {
        for (const Ruling& r : piece.rulings) {
          for (std::size_t i = 0; i < 2; ++i) {
            check_contact(r.n, r.contact[i], r.point[i]);
            check_support(r.n, r.contact[i], r.point[i]);
            points_.push_back(r.point[i]);
          }
          raise(facts_.tie, glm::dot(r.point[0] - r.point[1], r.n));
        }
        for (std::size_t k = 0; k + 1 < piece.rulings.size(); ++k) {
          check_between(system, piece.rulings[k], piece.rulings[k + 1]);
        }
      }
    }
    for (const HullFace& face : boundary_.faces) {
      for (std::size_t k = 0; k < face.contacts.size(); ++k) {
        check_contact(face.n, face.contacts[k], face.points.at(k));
        check_support(face.n, face.contacts[k], face.points[k]);
        raise(facts_.tie, glm::dot(face.points[k], face.n) - face.offset);
        points_.push_back(face.points[k]);
      }
    }
    for (const HullCurve& curve : boundary_.curves) {
      points_.insert(points_.end(), curve.points.begin(), curve.points.end());
    }
  }

  /// Whether the point lies in the region; near its outline it may.
  bool may_lie_in(const PatchRegion& region, const dvec2& uv) const {
    const PlaceInLoops place = place_in_loops(geometry_, boundary_, region, uv);
    return place.winding == 1 || place.distance < undecided;
  }

  bool may_lie_on_patch(const Contact& c) const {
    for (const HullFace& face : boundary_.faces) {
      for (const PatchRegion& region : face.regions) {
        if (region.instance != c.instance || region.patch != c.element) continue;
        if (may_lie_in(region, {c.u, c.v})) return true;
      }
    }
    return false;
  }

  /// Of an edge's piece or vertex: whether an arc, a facet or a region's border has it.
  bool may_lie_on_curve(const Contact& c) const {
    const auto is_same = [&](const Contact& other) {
      return other.instance == c.instance && other.kind == c.kind && other.element == c.element;
    };
    for (const taut::SeparatingArc& arc : boundary_.arcs) {
      for (const taut::ArcPiece& piece : arc.pieces) {
        for (std::size_t i = 0; i < 2; ++i) {
          double low = 2;
          double high = -1;
          for (const Ruling& r : piece.rulings) {
            if (!is_same(geometry_.canonical(r.contact[i])) && !is_same(r.contact[i])) continue;
            if (c.kind == SourceKind::vertex) return true;
            low = std::min(low, r.contact[i].u);
            high = std::max(high, r.contact[i].u);
          }
          if (low - undecided <= c.u && c.u <= high + undecided) return true;
        }
      }
    }
    for (const HullFace& face : boundary_.faces) {
      for (const Contact& other : face.contacts) {
        const Contact own = geometry_.canonical(other);
        if (is_same(own) && std::abs(own.u - c.u) <= undecided) return true;
      }
      for (const EdgeStretch& side : face.sides) {
        if (c.kind != SourceKind::edge || side.instance != c.instance || side.piece != c.element) {
          continue;
        }
        const auto [low, high] = std::minmax(side.from, side.to);
        if (low - undecided <= c.u && c.u <= high + undecided) return true;
      }
      for (const PatchRegion& region : face.regions) {
        if (region.instance == c.instance && borders_on(region, c)) return true;
      }
    }
    return false;
  }

  bool borders_on(const PatchRegion& region, const Contact& c) const {
    for (const auto& loop : region.loops) {
      for (const TrimStretch& s : loop) {
        if (s.arc >= 0) continue;
        const auto at = [&](double t) {
          const dvec2 uv = on_side(s.side, t);
          return geometry_.canonical({region.instance, SourceKind::face, region.patch, uv.x, uv.y});
        };
        const Contact from = at(s.from);
        const Contact to = at(s.to);
        const Contact middle = at(0.5 * (s.from + s.to));
        if (c.kind == SourceKind::vertex) {
          for (const Contact& end : {from, to}) {
            if (end.kind == c.kind && end.element == c.element) return true;
          }
        } else if (middle.kind == SourceKind::edge && middle.element == c.element) {
          const taut::Border& border = geometry_.part(middle)
                                           .patches()[std::size_t(region.patch)]
                                           .borders[std::size_t(s.side)];
          const double t = border.piece_reversed ? 1 - c.u : c.u;
          const auto [low, high] = std::minmax(s.from, s.to);
          if (low - undecided <= t && t <= high + undecided) return true;
        }
      }
    }
    return false;
  }

  void check_directions(int directions) {
    Random random(4711);
    facts_.directions = directions;
    for (int k = 0; k < directions; ++k) {
      const dvec3 n = random_direction(random);
      const taut::Support s = query_(n);
      for (const dvec3& x : points_) {
        facts_.overshoot = std::max(facts_.overshoot, glm::dot(x, n) - s.h);
      }
      const Contact c = geometry_.canonical(s.contact);
      const Contact at = geometry_.first(s.contact);
      const bool on_face = at.kind == SourceKind::face && may_lie_on_patch(at);
      if (on_face || (c.kind != SourceKind::face && may_lie_on_curve(c))) continue;
      ++facts_.misses;
      facts_.missed = n;
    }
  }

  /// Whether the surface bends away from the tangent plane on both sides.
  static bool strictly_convex(const taut::ContactJet& j, const dvec3& n) {
    const double uu = glm::dot(j.dxx, n) / glm::dot(j.dx[0], j.dx[0]);
    const double vv = glm::dot(j.dyy, n) / glm::dot(j.dx[1], j.dx[1]);
    const double uv = glm::dot(j.dxy, n) / (glm::length(j.dx[0]) * glm::length(j.dx[1]));
    return uu < -undecided && vv < -undecided && uu * vv - uv * uv > undecided;
  }

  void check_point(const Contact& c, int sign) {
    const taut::ContactJet jet = geometry_.jet(c);
    const dvec3 across = glm::cross(jet.dx[0], jet.dx[1]);
    if (!(glm::length(across) > undecided)) return;
    const dvec3 n = double(sign) * glm::normalize(across);
    ++facts_.points;
    const double gap = query_(n, c).h - glm::dot(jet.x, n);
    int winding = 0;
    bool near = false;
    for (const HullFace& face : boundary_.faces) {
      for (const PatchRegion& region : face.regions) {
        if (region.instance != c.instance || region.patch != c.element || region.sign != sign) {
          continue;
        }
        const PlaceInLoops place = place_in_loops(geometry_, boundary_, region, {c.u, c.v});
        winding += place.winding;
        near = near || place.distance < undecided;
      }
    }
    const bool on_hull = gap < supports;
    if (winding != 0 && !near && gap > boundary_.gap && !strictly_convex(jet, n)) ++facts_.flat;
    if (near || (!on_hull && gap < undecided) || (on_hull && !strictly_convex(jet, n))) {
      ++facts_.undecided;
    } else if (winding != (on_hull ? 1 : 0)) {
      ++facts_.mismatches;
      facts_.mismatch = c;
    }
  }

  void check_points(int count) {
    constexpr int least = 8;  // of a patch
    Random random(815);
    const taut::Model& model = scene_.model();
    const int each = std::max(least, count / std::max(1, model.patch_count()));
    for (int i = 0; i < int(model.instances().size()); ++i) {
      const taut::Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
      for (int p = 0; p < int(part.patches().size()); ++p) {
        if (geometry_.is_repeated({i, SourceKind::face, p, 0, 0})) continue;  // told as the first
        for (int k = 0; k < each; ++k) {
          const double u = uniform(random, 0, 1);
          const double v = uniform(random, 0, 1);
          for (const int sign : {1, -1}) check_point({i, SourceKind::face, p, u, v}, sign);
        }
      }
    }
  }

  const taut::Scene& scene_;
  const HullBoundary& boundary_;
  taut::ContactGeometry geometry_;
  taut::SupportQuery query_;
  BoundaryFacts facts_;
  std::vector<dvec3> vertices_;
  std::vector<dvec3> points_;
};

}  // namespace

PlaceInLoops place_in_loops(const taut::ContactGeometry& geometry, const HullBoundary& boundary,
                            const PatchRegion& region, const dvec2& uv) {
  constexpr int bisections = 40;
  const taut::ContactSystem system(geometry);
  Winding winding(uv);
  for (const auto& loop : region.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const TrimStretch& s = loop[k];
      if (s.arc < 0) {
        winding.add(on_side(s.side, s.from), on_side(s.side, s.to));
      } else {
        const std::vector<Ruling>& rulings = piece_of(boundary, s).rulings;
        for (std::size_t r = 0; r + 1 < rulings.size(); ++r) {
          add_part(system, s, region.patch, rulings[r], rulings[r + 1], bisections, winding);
        }
      }
      // Rounding apart, the next begins where this one ends.
      winding.add(end_of(geometry, boundary, region, s, true),
                  end_of(geometry, boundary, region, loop[(k + 1) % loop.size()], false));
    }
  }
  return winding.place();
}

BoundaryFacts boundary_facts(const taut::Scene& scene, const taut::Hull& hull, int directions) {
  return BoundaryCheck(scene, *hull.boundary).run(directions);
}

std::ostream& operator<<(std::ostream& out, const BoundaryFacts& f) {
  const auto vector = [&](const dvec3& x) -> std::ostream& {
    return out << '(' << x.x << ", " << x.y << ", " << x.z << ')';
  };
  out << "open curves " << f.open_curves << ", misplaced " << f.misplaced << ", bare scrolls "
      << f.bare_scrolls << ", loop gap " << f.loop_gap << ", region gap " << f.region_gap
      << ", open facets " << f.open_facets << ", Euler " << f.euler << "; point " << f.point
      << ", stationary " << f.stationary << ", tie " << f.tie << ", side " << f.side << ", support "
      << f.support << " at ";
  vector(f.worst_support) << ", between " << f.between << ", none " << f.no_rulings << "; missed "
                          << f.misses << " of " << f.directions << " as ";
  vector(f.missed) << ", overshoot " << f.overshoot << "; mismatches " << f.mismatches << " of "
                   << f.points << " (" << f.undecided << " undecided, " << f.flat
                   << " flat) as patch " << f.mismatch.element << " (" << f.mismatch.u << ", "
                   << f.mismatch.v << ")";
  return out;
}

}  // namespace taut_test
