#include "taut/hull/stitch/edge_incidence.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// Parameters that agree to this are the same place of an edge.
constexpr double same_edge_parameter = 1e-7;
/// Halvings with which a ruling along the edge is found.
constexpr int halving_limit = 60;

/// Positive where a supporting direction of an edge may still turn to the left of the edge before
/// it reaches the end of those that support: `towards` leads from this end into them.
double turn(const ContactJet& edge, const dvec3& n, const dvec3& towards) {
  return glm::dot(towards, glm::cross(unit(edge.dx[0]), n));
}

/// Rulings of a piece, from one to another, that are on one side of the edge which one of their
/// contacts runs along.
struct Run {
  std::size_t first, last;
  double from, to;  ///< parameters of the edge
  double side;      ///< positive: to its left
};

/// In order.
std::vector<Run> runs_along(const ContactSystem& system, const std::vector<Ruling>& rulings,
                            std::size_t i) {
  const auto side = [&](const Ruling& r) {
    const dvec3 d = r.point[0] - r.point[1];
    return turn(system.geometry().jet(r.contact[i]), r.n, i == 0 ? d : -d);
  };
  // Where no ruling is found between two, from one to the other.
  const auto side_between = [&](const Ruling& a, const Ruling& b, double s) {
    const std::optional<Ruling> r = ruling_between(system, a, b, s);
    return r ? side(*r) : (1 - s) * side(a) + s * side(b);
  };
  std::vector<Run> runs;
  double from = rulings.front().contact[i].u;
  std::size_t k = 0;
  while (k + 1 < rulings.size()) {
    std::size_t next = k + 1;
    const double here = side_between(rulings[k], rulings[next], 0.5);
    while (next + 1 < rulings.size() && side(rulings[next]) * here > 0 &&
           side_between(rulings[next], rulings[next + 1], 0.5) * here > 0) {
      ++next;
    }
    double to = rulings[next].contact[i].u;
    if (next + 1 < rulings.size()) {
      // The parameter turns between the middles of the two chords about `next`.
      const bool before = side(rulings[next]) * here <= 0;
      const Ruling& a = before ? rulings[next - 1] : rulings[next];
      const Ruling& b = before ? rulings[next] : rulings[next + 1];
      double lower = before ? 0.5 : 0.0;
      double upper = before ? 1.0 : 0.5;
      for (int h = 0; h < halving_limit && upper - lower > 1e-15; ++h) {
        const double middle = 0.5 * (lower + upper);
        (side_between(a, b, middle) * here > 0 ? lower : upper) = middle;
      }
      to = ruling_between(system, a, b, upper).value_or(b).contact[i].u;
    }
    runs.push_back({k, next, from, to, here});
    from = to;
    k = next;
  }
  return runs;
}

/// Where arcs end they may be tangent to the edge, and noise tells the side: over how far their
/// planes and contacts move heights differ by less than they are known.
void unite_shallow_ends(const std::vector<Ruling>& rulings, std::size_t i, double depth,
                        std::vector<Run>& runs) {
  const auto is_shallow = [&](const Run& run) {
    const Ruling& a = rulings[run.first];
    const Ruling& b = rulings[run.last];
    return glm::distance(a.n, b.n) * glm::distance(a.point[i], b.point[i]) <= depth;
  };
  while (runs.size() > 1 && is_shallow(runs.front())) {
    runs[1].first = runs[0].first;
    runs[1].from = runs[0].from;
    runs.erase(runs.begin());
  }
  while (runs.size() > 1 && is_shallow(runs.back())) {
    runs[runs.size() - 2].last = runs.back().last;
    runs[runs.size() - 2].to = runs.back().to;
    runs.pop_back();
  }
}

}  // namespace

EdgeIncidence::EdgeIncidence(const ContactGeometry& geometry, const SeparatingGraph& graph,
                             const std::vector<TrimRegion>& regions) {
  for (int a = 0; a < int(graph.arcs.size()); ++a) {
    add_arc(geometry, graph.arcs[std::size_t(a)], a, graph.depth);
  }
  for (int k = 0; k < int(graph.nodes.size()); ++k) {
    add_facet(graph.nodes[std::size_t(k)], k);
  }
  for (int r = 0; r < int(regions.size()); ++r) {
    add_region(geometry, regions[std::size_t(r)], r);
  }
}

/// The parameter along the edge grows or falls along an arc, and turns where a ruling is tangent to
/// the edge.
void EdgeIncidence::add_arc(const ContactGeometry& geometry, const SeparatingArc& arc, int index,
                            double depth) {
  const ContactSystem system(geometry);
  for (int p = 0; p < int(arc.pieces.size()); ++p) {
    const std::vector<Ruling>& rulings = arc.pieces[std::size_t(p)].rulings;
    for (std::size_t i = 0; i < 2; ++i) {
      const Contact& first = rulings.front().contact[i];
      if (first.kind != SourceKind::edge) continue;
      std::vector<Run> runs = runs_along(system, rulings, i);
      unite_shallow_ends(rulings, i, depth, runs);
      Edge& own = edges_[{first.instance, first.element}];
      for (const Run& run : runs) {
        if (std::abs(run.to - run.from) < same_edge_parameter) continue;
        own.intervals.push_back({std::min(run.from, run.to),
                                 std::max(run.from, run.to),
                                 run.side > 0,
                                 {index, p, int(i), run.to - run.from, -1, 0, 0, -1}});
      }
    }
  }
}

/// The facet lies to the left of its sides.
void EdgeIncidence::add_facet(const FacetNode& node, int index) {
  for (std::size_t k = 0; k < node.sides.size(); ++k) {
    if (!node.is_curved(k)) continue;
    const EdgeStretch& s = node.sides[k];
    edges_[{s.instance, s.piece}].intervals.push_back({std::min(s.from, s.to),
                                                       std::max(s.from, s.to),
                                                       s.from < s.to,
                                                       {-1, -1, 0, 0, -1, 0, 0, index}});
  }
}

void EdgeIncidence::add_region(const ContactGeometry& geometry, const TrimRegion& region,
                               int index) {
  const Contact any{region.instance, SourceKind::face, region.patch, 0, 0};
  const Patch& patch = geometry.part(any).patches()[std::size_t(region.patch)];
  for (std::size_t l = 0; l < region.loops.size(); ++l) {
    for (std::size_t k = 0; k < region.loops[l].size(); ++k) {
      const TrimStretch& s = region.loops[l][k];
      if (s.arc >= 0) continue;
      const Border& border = patch.borders[std::size_t(s.side)];
      if (border.piece < 0) continue;
      const auto on_piece = [&](double t) {
        return geometry.first({region.instance, SourceKind::edge, border.piece,
                               border.piece_reversed ? 1 - t : t, 0});
      };
      const Contact first = on_piece(s.from);
      const double from = first.u;
      const double to = on_piece(s.to).u;
      // The region lies to the left of its outline.
      edges_[{first.instance, first.element}].intervals.push_back(
          {std::min(from, to), std::max(from, to), from < to, {-1, -1, 0, 0, index, l, k, -1}});
    }
  }
}

std::vector<double> EdgeIncidence::Edge::ends() const {
  std::vector<double> all;
  for (const Interval& i : intervals) {
    all.push_back(i.from);
    all.push_back(i.to);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> distinct;
  for (const double t : all) {
    if (distinct.empty() || t - distinct.back() > same_edge_parameter) distinct.push_back(t);
  }
  return distinct;
}

std::vector<EdgeIncidence::Stretch> EdgeIncidence::overlay() const {
  std::vector<Stretch> result;
  for (const auto& [place, edge] : edges_) {
    const std::vector<double> ends = edge.ends();
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      Stretch s{place.first, place.second, ends[k], ends[k + 1], {}, {}};
      const double middle = 0.5 * (s.from + s.to);
      for (const Interval& i : edge.intervals) {
        if (i.from < middle && middle < i.to) (i.low ? s.low : s.high) = i.neighbor;
      }
      if (!s.low.empty() || !s.high.empty()) result.push_back(s);
    }
  }
  return result;
}

std::vector<double> EdgeIncidence::breaks(int instance, int piece, bool reversed, double from,
                                          double to) const {
  std::vector<double> result;
  const auto found = edges_.find({instance, piece});
  if (found == edges_.end()) return result;
  for (const double end : found->second.ends()) {
    const double t = reversed ? 1 - end : end;
    if (t > std::min(from, to) + same_edge_parameter &&
        t < std::max(from, to) - same_edge_parameter) {
      result.push_back(t);
    }
  }
  std::sort(result.begin(), result.end());
  if (from > to) std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace taut
