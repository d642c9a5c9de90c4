#include "taut/hull/solve/edge_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"

namespace taut {
namespace {

/// Parameters of the places on all edges and seams.
class EdgePlaces {
 public:
  EdgePlaces(const ContactGeometry& geometry, double depth, double distance, double level_distance)
      : geometry_(geometry), depth_(depth), distance_(distance), level_distance_(level_distance) {}

  void add(const Contact& c) {
    for_each_line(c, [&](const Line& line, double t) {
      places_[line].try_emplace(t, t);
      return t;
    });
  }
  /// What is told as a contact on a line is one on the other in its stead, also where it is told as
  /// one of the patch on the line's other side.
  void move(const Contact& from, const Contact& to) {
    std::map<Line, double> there;
    for_each_line(to, [&](const Line& line, double t) { return there[line] = t; });
    for_each_line(from, [&](const Line& line, double t) {
      const auto found = there.find(line);
      if (found != there.end()) moved_[line][t] = found->second;
      return t;
    });
  }
  /// Of a curved side that goes on from stretch to stretch two ends are its own.
  void add(const FacetNode& node) {
    const std::size_t count = node.sides.size();
    for (std::size_t k = 0; k < count; ++k) {
      const EdgeStretch& s = node.sides[k];
      if (s.piece < 0) continue;
      const EdgeStretch& before = node.sides[(k + count - 1) % count];
      const EdgeStretch& after = node.sides[(k + 1) % count];
      std::set<double>& level = level_[{s.instance, s.piece, -1, 0}];
      for (const double t : {s.from, s.to}) add(s.at(t));
      if (!goes_on(before, s)) level.insert(s.from);
      if (!goes_on(s, after)) level.insert(s.to);
    }
  }

  /// Places follow each other with less than the distance between them: all are the line's end if
  /// that is among them (the nearer one if both are, and are two points), else the first that is no
  /// end of a curved side, or the first.
  void unite() {
    for (auto& [line, places] : places_) {
      places.try_emplace(0.0, 0.0);
      places.try_emplace(1.0, 1.0);
      const std::set<double>& level = level_[line];
      const auto is_level = [&](double t) { return level.count(t) > 0; };
      // What has another place where it is needs none farther away.
      const auto is_alone = [&, &line = line, all = &places](double t) {
        return is_level(t) && std::none_of(all->begin(), all->end(), [&](const auto& p) {
                 return !is_level(p.first) && length(line, p.first, t) <= distance_;
               });
      };
      const auto& [instance, piece, patch, side] = line;
      const bool is_bent =
          piece >= 0 && geometry_.is_beside_bent({instance, SourceKind::edge, piece, 0, 0});
      for (auto first = places.begin(); first != places.end();) {
        auto last = std::next(first);
        for (auto before = first; last != places.end(); before = last++) {
          const bool wide = is_bent || is_alone(before->first) || is_alone(last->first);
          const double gap = length(line, before->first, last->first);
          if (gap > (wide ? level_distance_ : distance_)) break;
          if (gap > depth_ && bend(line, before->first, last->first) > depth_) break;
        }
        const auto exact =
            std::find_if(first, last, [&](const auto& p) { return !is_level(p.first); });
        const bool ends = std::prev(last)->first == 1;
        const bool begins = first->first == 0 && !(ends && length(line, 0, 1) <= geometry_.tie());
        const double at = (exact == last ? first : exact)->first;
        for (; first != last; ++first) {
          const bool to_end = ends && (!begins || first->first > 0.5);
          first->second = to_end ? 1 : begins ? 0 : at;
        }
      }
    }
  }

  void settle(Contact& c) const {
    for_each_line(c, [&](const Line& line, double told) {
      const double t = place_of(line, told);
      const auto places = places_.find(line);
      const auto place =
          places == places_.end() ? decltype(places->second.end()){} : places->second.find(t);
      // That of a line which it has come upon is as it is.
      return places == places_.end() || place == places->second.end() ? t : place->second;
    });
  }
  void settle(EdgeStretch& s) const {
    if (s.piece < 0) return;
    for (double* t : {&s.from, &s.to}) {
      Contact c = s.at(*t);
      settle(c);
      *t = c.u;
    }
  }

 private:
  /// Instance, an edge's piece or -1, a patch or -1, and the patch's side.
  using Line = std::tuple<int, int, int, int>;

  /// Calls it with the lines that the contact lies on, and its parameter there, which becomes what
  /// is returned.
  template <class Contact_, class Visit>
  void for_each_line(Contact_& c, Visit visit) const {
    if (c.kind == SourceKind::edge) {
      set(c.u, visit({c.instance, c.element, -1, 0}, c.u));
      return;
    }
    if (c.kind != SourceKind::face) return;
    const dvec2 uv = parameters(c);
    for (const Side side : all_sides) {
      const double across = along_v(side) ? uv.x : uv.y;
      if (across != (at_upper_end(side) ? 1 : 0)) continue;
      const Border& border = geometry_.patch(c).borders[std::size_t(side)];
      Line line = {c.instance, border.piece, -1, 0};
      bool reversed = border.piece_reversed;
      if (border.piece < 0) {
        const bool first =
            border.neighbor < 0 ||
            std::pair(c.element, side) <= std::pair(border.neighbor, border.neighbor_side);
        line = first ? Line{c.instance, -1, c.element, int(side)}
                     : Line{c.instance, -1, border.neighbor, int(border.neighbor_side)};
        reversed = !first && border.reversed;
      }
      const double t = along_v(side) ? uv.y : uv.x;
      const double there = visit(line, reversed ? 1 - t : t);
      set(along_v(side) ? c.v : c.u, reversed ? 1 - there : there);
    }
  }
  static void set(double& t, double to) { t = to; }
  static void set(const double&, double) {}

  bool goes_on(const EdgeStretch& s, const EdgeStretch& after) const {
    if (s.piece < 0 || after.piece < 0) return false;
    const double gap =
        glm::distance(geometry_.point(s.at(s.to)), geometry_.point(after.at(after.from)));
    return gap <= geometry_.tie();
  }

  double place_of(const Line& line, double t) const {
    const auto moved = moved_.find(line);
    if (moved == moved_.end()) return t;
    const auto at = moved->second.lower_bound(t - same_parameter);
    return at != moved->second.end() && at->first <= t + same_parameter ? at->second : t;
  }
  /// Parameters t of a join differ so much by being told as 1 - (1 - t).
  static constexpr double same_parameter = std::numeric_limits<double>::epsilon();

  Contact at(const Line& line, double t) const {
    const auto& [instance, piece, patch, side] = line;
    return piece >= 0 ? Contact{instance, SourceKind::edge, piece, t, 0}
                      : on_side(instance, patch, Side(side), t);
  }

  /// How far one of two places is from the tangent in the other, or all of the way, if the line
  /// turns back.
  double bend(const Line& line, double a, double b) const {
    const auto& [instance, piece, patch, side] = line;
    const std::size_t along = piece < 0 && along_v(Side(side)) ? 1 : 0;
    const ContactJet from = geometry_.jet(at(line, a)), to = geometry_.jet(at(line, b));
    const dvec3 way = to.x - from.x;
    if (glm::dot(from.dx[along], to.dx[along]) < 0) return glm::length(way);
    const auto off = [&](const ContactJet& j) {
      return glm::length(glm::cross(way, unit(j.dx[along])));
    };
    return std::max(off(from), off(to));
  }

  /// That of chords from one place to another.
  double length(const Line& line, double from, double to) const {
    double sum = 0;
    dvec3 before = geometry_.point(at(line, from));
    for (int k = 1; k <= chords; ++k) {
      const dvec3 x = geometry_.point(at(line, std::lerp(from, to, double(k) / chords)));
      sum += glm::distance(x, before);
      before = x;
    }
    return sum;
  }
  static constexpr int chords = 8;

  const ContactGeometry& geometry_;
  double depth_;
  double distance_;
  double level_distance_;
  std::map<Line, std::set<double>> level_;           // ends of curved sides
  std::map<Line, std::map<double, double>> places_;  // as they were: as they are
  std::map<Line, std::map<double, double>> moved_;   // before they are places
};

template <class Visit>
void for_each_end(SeparatingGraph& graph, Visit visit) {
  for (SeparatingArc& arc : graph.arcs) {
    for (ArcPiece& piece : arc.pieces) {
      for (Ruling* r : {&piece.rulings.front(), &piece.rulings.back()}) {
        for (std::size_t i = 0; i < 2; ++i) visit(r->contact[i], r->point[i], r->n);
      }
    }
  }
  for (FacetNode& node : graph.nodes) {
    for (std::size_t k = 0; k < node.contacts.size(); ++k)
      visit(node.contacts[k], node.points[k], node.n);
  }
}

/// From a contact with the plane across n to another place of its element heights do not change, to
/// within the depth, and if it is an edge's that does not turn back.
bool is_straight_on(const ContactGeometry& geometry, const Contact& c, const Contact& to,
                    const dvec3& n, double depth) {
  const ContactJet own = geometry.jet(c), other = geometry.jet(to);
  const bool turns = own.dimension == 1 && glm::dot(own.dx[0], other.dx[0]) < 0;
  return !turns && glm::dot(own.x - other.x, n) <= depth;
}

}  // namespace

void unite_edge_places(const ContactGeometry& geometry, SeparatingGraph& graph, double depth,
                       double distance, double level_distance,
                       const std::function<bool(const Contact&)>& touches) {
  EdgePlaces places(geometry, depth, distance, std::max(distance, level_distance));
  for_each_end(graph, [&](Contact& c, const dvec3&, const dvec3& n) {
    const Contact border = moved_to_border(geometry, c, distance);
    const Contact own = is_straight_on(geometry, c, border, n, depth) ? border : c;
    c = own;
    const Contact bent = moved_to_bent(geometry, own, level_distance);
    if (parameters(bent) != parameters(own) && touches(bent)) {
      places.move(own, bent);
      c = bent;
    }
    places.add(c);
  });
  for (const FacetNode& node : graph.nodes) places.add(node);
  places.unite();
  for_each_end(graph, [&](Contact& c, dvec3& x, const dvec3&) {
    places.settle(c);
    x = geometry.point(c);
  });
  for (FacetNode& node : graph.nodes) {
    for (EdgeStretch& s : node.sides) places.settle(s);
  }
}

}  // namespace taut
