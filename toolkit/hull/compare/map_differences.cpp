#include "taut/hull/compare/map_differences.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/hull/mesh/contact_faces.h"
#include "taut/hull/trace/map_crossings.h"
#include "taut/hull/trace/map_support.h"

namespace taut {
namespace {

/// How far places between two rulings of an arc may be from the segments between theirs, as a share
/// of the distance between the two.
constexpr double chord_share = 0.25;
/// Places looked at between two rulings; the share is wider than what is between these.
constexpr int chord_steps = 4;
/// Halvings of the angle between two directions until they are one.
constexpr int parting_halvings = 30;
/// Share of contacts' extent within which two directions are one for a first look.
constexpr double rough_share = 0.25;
/// Places looked at between two contacts on one patch or edge, whether they are one.
constexpr int dent_steps = 16;
/// Spots told, at most.
constexpr std::size_t spot_limit = 16;

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(x - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(x, a + t * along);
}

class Comparison {
 public:
  Comparison(const ContactGeometry& geometry, SupportQuery& query, const DirectionMap& map,
             const HullBoundary& boundary)
      : geometry_(geometry),
        query_(query),
        map_(map),
        boundary_(boundary),
        faces_(geometry, boundary),
        crossings_(map),
        support_(geometry, query, map.contact_extent()) {}

  MapDifferences run() {
    for (const SeparatingArc& arc : boundary_.arcs) crossings_.add(arc);
    gather_points();
    compare_rulings();
    for (std::size_t k = 0; k < map_.cells.size() && found_.spots.size() < spot_limit; ++k) {
      const MapCell& cell = map_.cells[k];
      if (cell.kind == MapCellKind::undecided) continue;
      compare_middle(cell);
      if (cell.kind == MapCellKind::arc || cell.kind == MapCellKind::node ||
          cell.kind == MapCellKind::in_line) {
        // Of coarse cells those beside are too far away.
        const std::vector<int> around =
            cell.level < fine_level ? std::vector<int>() : crossings_.around(int(k));
        const bool is_known = is_crossed(cell, int(k)) ||
                              std::any_of(around.begin(), around.end(),
                                          [&](int other) { return is_crossed(cell, other); });
        if (!is_known) compare_curves(cell);
      } else if (cell.kind == MapCellKind::facet) {
        compare_facet(cell);
      }
    }
    return std::move(found_);
  }

 private:
  void tell(const SupportSample& at, const char* reason) {
    found_.samples.push_back({at.n, at.contact});
    const bool known = std::any_of(found_.spots.begin(), found_.spots.end(), [&](const auto& u) {
      return u.reason == reason && glm::distance(u.n, at.n) < same_spot;
    });
    if (!known) found_.spots.push_back({at.n, reason});
  }

  void gather_points() {
    for (const HullCurve& curve : boundary_.curves) {
      points_.insert(points_.end(), curve.points.begin(), curve.points.end());
    }
    for (const HullFace& face : boundary_.faces) {
      points_.insert(points_.end(), face.points.begin(), face.points.end());
    }
    for (const SeparatingArc& arc : boundary_.arcs) {
      for (const ArcPiece& piece : arc.pieces) {
        for (const Ruling& r : piece.rulings) {
          points_.push_back(r.point[0]);
          points_.push_back(r.point[1]);
        }
      }
    }
  }

  /// Both contacts of a ruling lie in one plane, which supports.
  void compare_rulings() {
    for (const SeparatingArc& arc : boundary_.arcs) {
      for (const ArcPiece& piece : arc.pieces) {
        for (std::size_t k = 0; k < piece.rulings.size(); ++k) {
          const Ruling& r = piece.rulings[k];
          const bool is_level = std::abs(glm::dot(r.point[0] - r.point[1], r.n)) <= map_.resolution;
          if (is_level && (k != piece.rulings.size() / 2 || supports(r))) continue;
          tell({r.n, r.contact[0], r.point[0]}, "a ruling lies in no supporting plane");
        }
      }
    }
  }

  bool supports(const Ruling& r) {
    const SupportSample s = seen(geometry_, query_, r.n, r.contact[0]);
    return glm::dot(s.x - r.point[0], r.n) <= near * map_.resolution;
  }

  /// A place of the boundary's curves comes within the resolution of the plane.
  bool reaches(const dvec3& n, double h) const {
    return std::any_of(points_.begin(), points_.end(), [&](const dvec3& x) {
      return glm::dot(x, n) >= h - near * map_.resolution;
    });
  }

  void compare_middle(const MapCell& cell) {
    const Contact& c = cell.contact;
    if (c.instance < 0 || !faces_.surely_uncovered(c)) return;
    const std::array<dvec3, 4> d = DirectionMap::corners(cell);
    const dvec3 n = unit(d[0] + d[3]);
    const dvec3 x = geometry_.point(c);
    if (reaches(n, glm::dot(x, n))) return;
    // Beside an arc it is not told on which side of it a point lies.
    if (is_on_arc(n, x, x)) return;
    tell({n, c, x}, "a support point lies on no face that was found");
  }

  /// Of two directions in which different contacts support, two between them on the great arc,
  /// nearer to each other than so much, or next to each other.
  std::array<SupportSample, 2> exchange(SupportSample a, SupportSample b, double turn) {
    for (int k = 0; k < parting_halvings && glm::distance(a.n, b.n) > turn; ++k) {
      const dvec3 n = unit(a.n + b.n);
      if (n == a.n || n == b.n) break;
      const SupportSample middle = seen(geometry_, query_, n, a.contact);
      (glm::distance(middle.x, a.x) <= glm::distance(middle.x, b.x) ? a : b) = middle;
    }
    return {a, b};
  }

  void compare_curves(const MapCell& cell) {
    for (const auto& [from, to] : support_.partings(cell)) {
      // Roughly first: most are known.
      std::array<SupportSample, 2> ends = {from, to};
      bool is_known = false;
      for (const double turn : {rough_share * map_.contact_extent(), 0.0}) {
        ends = exchange(ends[0], ends[1], turn);
        const auto& [a, b] = ends;
        is_known = glm::distance(a.x, b.x) <= map_.contact_extent() || is_on_arc(a.n, a.x, b.x) ||
                   is_in_facet(a.n, a.x, b.x) || are_one(a, b);
        if (is_known) break;
      }
      if (is_known) continue;
      for (const SupportSample& end : ends) {
        tell(end, "a separating curve that the map of directions tells was not found");
      }
    }
  }

  /// Between two contacts on one patch or edge the dent is no deeper than what must be taken for
  /// none. (Of a deep dent some pairs of contacts have only a shallow part between them.)
  bool are_one(const SupportSample& a, const SupportSample& b) const {
    const Contact from = geometry_.canonical(a.contact);
    const Contact to = geometry_.canonical(b.contact);
    const std::optional<Contact> on_own =
        from.kind <= to.kind ? beside(to, from) : beside(from, to);
    if (!on_own) return false;
    const Contact& other = from.kind <= to.kind ? from : to;
    const double h = std::max(glm::dot(a.x, a.n), glm::dot(b.x, a.n));
    for (int step = 1; step < dent_steps; ++step) {
      const double t = double(step) / dent_steps;
      Contact c = other;
      c.u = glm::mix(other.u, on_own->u, t);
      c.v = glm::mix(other.v, on_own->v, t);
      if (glm::dot(geometry_.point(c), a.n) < h - tie_share * map_.resolution) return false;
    }
    return true;
  }

  /// A contact as one of a patch or edge that it lies on or ends.
  std::optional<Contact> beside(const Contact& c, const Contact& element) const {
    if (c.instance != element.instance) return std::nullopt;
    if (c.kind == element.kind) {
      return c.element == element.element ? std::optional(c) : std::nullopt;
    }
    if (element.kind != SourceKind::face) return std::nullopt;
    Contact result = element;
    const Patch& patch = geometry_.patch(element);
    if (c.kind == SourceKind::edge) {
      for (const Side side : all_sides) {
        const Border& border = patch.borders[std::size_t(side)];
        if (border.piece != c.element) continue;
        const dvec2 uv = on_side(side, border.piece_reversed ? 1 - c.u : c.u);
        result.u = uv.x;
        result.v = uv.y;
        return result;
      }
      return std::nullopt;
    }
    for (int corner = 0; corner < 4; ++corner) {
      if (patch.corner_vertex[std::size_t(corner)] != c.element) continue;
      result.u = corner < 2 ? 0 : 1;
      result.v = corner % 2;
      return result;
    }
    return std::nullopt;
  }

  /// A scroll runs over the directions and both of the places, be they inside of a ruling: contacts
  /// may lie in line.
  bool is_on_arc(const dvec3& n, const dvec3& a, const dvec3& b) const {
    return std::any_of(boundary_.arcs.begin(), boundary_.arcs.end(), [&](const auto& arc) {
      return std::any_of(arc.pieces.begin(), arc.pieces.end(), [&](const ArcPiece& piece) {
        for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
          if (is_between(piece.rulings[k - 1], piece.rulings[k], n, a, b)) return true;
        }
        return false;
      });
    });
  }

  /// A curve between two of a cell's contacts crosses it, or another one.
  bool is_crossed(const MapCell& cell, int crossed) const {
    const std::vector<Box>& contacts = cell.contacts;
    const std::vector<MapCrossings::Stretch>& stretches = crossings_.of(crossed);
    return std::any_of(stretches.begin(), stretches.end(), [&](const auto& stretch) {
      std::array<std::size_t, 2> nearest = {};
      for (const std::size_t i : {0u, 1u}) {
        const dvec3& from = stretch.from.point[i];
        const dvec3& to = stretch.to.point[i];
        const double slack = chord_share * glm::distance(from, to) + map_.contact_extent();
        double least = infinity;
        for (std::size_t c = 0; c < contacts.size(); ++c) {
          const double gap =
              distance_to_segment(0.5 * (contacts[c].lower + contacts[c].upper), from, to);
          if (gap >= least) continue;
          least = gap;
          nearest[i] = c;
        }
        const Box& box = contacts[nearest[i]];
        if (least > slack + 0.5 * glm::distance(box.lower, box.upper)) return false;
      }
      return nearest[0] != nearest[1];
    });
  }

  bool is_between(const Ruling& from, const Ruling& to, const dvec3& n, const dvec3& a,
                  const dvec3& b) const {
    const double turn = glm::distance(from.n, to.n);
    const double way = std::max(glm::distance(from.point[0], to.point[0]),
                                glm::distance(from.point[1], to.point[1]));
    const double slack = map_.contact_extent();
    const double turn_slack = chord_share * turn + slack;
    const double way_slack = chord_share * way + slack;
    if (glm::distance(n, from.n) > turn + turn_slack) return false;
    for (int step = 0; step <= chord_steps; ++step) {
      const double t = double(step) / chord_steps;
      if (glm::distance(n, glm::mix(from.n, to.n, t)) > turn_slack) continue;
      const dvec3 first = glm::mix(from.point[0], to.point[0], t);
      const dvec3 second = glm::mix(from.point[1], to.point[1], t);
      if (distance_to_segment(a, first, second) <= way_slack &&
          distance_to_segment(b, first, second) <= way_slack) {
        return true;
      }
    }
    return false;
  }

  bool is_in_facet(const dvec3& n, const dvec3& a, const dvec3& b) const {
    return std::any_of(boundary_.faces.begin(), boundary_.faces.end(), [&](const HullFace& face) {
      if (face.kind != FaceKind::facet || glm::dot(face.n, n) <= 0) return false;
      const double low = std::min(glm::dot(face.n, a), glm::dot(face.n, b));
      return low >= face.offset - near * map_.resolution;
    });
  }

  /// A facet or a ruling has the normal, to within what the resolution leaves open over so wide a
  /// facet; over less than contacts' extents surfaces are flat.
  void compare_facet(const MapCell& cell) {
    if (cell.width <= 2 * map_.contact_extent()) return;
    const double turn = 2 * near * map_.resolution / cell.width;
    const auto is_near = [&](const dvec3& n) { return glm::distance(n, cell.normal) <= turn; };
    const bool is_known =
        std::any_of(boundary_.faces.begin(), boundary_.faces.end(),
                    [&](const HullFace& face) {
                      return face.kind == FaceKind::facet && is_near(face.n);
                    }) ||
        std::any_of(boundary_.arcs.begin(), boundary_.arcs.end(), [&](const SeparatingArc& arc) {
          return std::any_of(arc.pieces.begin(), arc.pieces.end(), [&](const ArcPiece& piece) {
            return std::any_of(piece.rulings.begin(), piece.rulings.end(),
                               [&](const Ruling& r) { return is_near(r.n); });
          });
        });
    if (is_known) return;
    // A patch may be as flat.
    const bool is_on_patch = geometry_.canonical(cell.contact).kind == SourceKind::face;
    if (is_on_patch && !faces_.surely_uncovered(cell.contact)) return;
    const SupportSample s = seen(geometry_, query_, cell.normal, cell.contact);
    tell(s, "a facet that the map of directions tells was not found");
  }

  /// In units of the resolution: either answer is right nearer than this.
  static constexpr double near = 4;
  static constexpr double same_spot = 1e-6;
  static constexpr int fine_level = 6;

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DirectionMap& map_;
  const HullBoundary& boundary_;
  ContactFaces faces_;
  MapCrossings crossings_;
  MapSupport support_;
  std::vector<dvec3> points_;
  MapDifferences found_;
};

}  // namespace

MapDifferences map_differences(const ContactGeometry& geometry, SupportQuery& query,
                               const DirectionMap& map, const HullBoundary& boundary) {
  return Comparison(geometry, query, map, boundary).run();
}

}  // namespace taut
