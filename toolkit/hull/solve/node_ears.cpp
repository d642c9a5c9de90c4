#include "taut/hull/solve/node_ears.h"

#include <algorithm>
#include <optional>

#include "taut/hull/solve/touching_plane.h"

namespace taut {
namespace {

class EarCutter {
 public:
  EarCutter(const RulingSearch& search, KnownArcs& known) : search_(search), known_(known) {}

  void run() {
    for (std::size_t k = 0; k < known_.graph.nodes.size(); ++k) {
      while (cut(int(k))) continue;
    }
  }

 private:
  struct Ear {
    std::size_t corner = 0;
    TouchingPlane plane;
  };

  MapGraph::Node& node(int k) { return known_.graph.nodes[std::size_t(k)]; }

  /// Cuts the flattest ear of a node. False if it needs none cut, or has none.
  bool cut(int k) {
    const std::size_t count = node(k).ends.size();
    if (count < 4) return false;
    const NodeCorners corners = corners_of(known_, node(k), search_.map());
    const double depth = search_.map().resolution;
    if (plane(corners.n, corners.contacts).off() <= depth) return false;
    std::optional<Ear> best;
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t before = (j + count - 1) % count;
      const TouchingPlane own = plane(corners.n, {corners.contacts[before], corners.contacts[j],
                                                  corners.contacts[(j + 1) % count]});
      const bool is_flat = !own.in_line && own.off() <= depth;
      if (is_flat && (!best || own.off() < best->plane.off())) best = Ear{j, own};
    }
    if (!best) return false;
    cut(k, *best);
    return true;
  }

  TouchingPlane plane(const dvec3& n, const std::vector<Contact>& contacts) const {
    return touching_plane(search_.geometry(), search_.query(), n, contacts);
  }

  void cut(int k, const Ear& ear) {
    std::vector<MapGraph::End>& ends = node(k).ends;
    std::rotate(ends.begin(), ends.begin() + std::ptrdiff_t(ear.corner), ends.end());
    // The arcs to both sides of the corner are the ear's: the last and the first one.
    const MapGraph::End own = ends.front();
    const MapGraph::End before = ends.back();
    const int arc = int(known_.graph.arcs.size());
    const int other = int(known_.graph.nodes.size());
    ends.front() = {arc, 1};
    ends.pop_back();
    MapGraph::Node cut_off;
    cut_off.ends = {before, own, {arc, 0}};
    for (const MapGraph::End& e : {before, own}) {
      known_.graph.arcs[std::size_t(e.arc)].node[std::size_t(e.end)] = other;
    }
    MapGraph::Arc between;
    between.node = {other, k};
    known_.graph.arcs.push_back(between);
    known_.graph.nodes.push_back(std::move(cut_off));
    known_.rulings.push_back({ruling(k, ear)});
  }

  /// Of the arc between an ear and what is left of the node.
  Ruling ruling(int k, const Ear& ear) {
    const std::vector<ClimbedContact>& c = ear.plane.contacts;
    const Ruling from = {ear.plane.n, {c[2].contact, c[0].contact}, {c[2].x, c[0].x}};
    dvec3 n(0.0);
    for (const MapGraph::End& end : node(k).ends) {
      if (std::size_t(end.arc) < known_.rulings.size()) n += known_.ruling_at(end).n;
    }
    Ruling to = from;
    to.n = unit(n);
    return search_.between(from, to).value_or(from);
  }

  const RulingSearch& search_;
  KnownArcs& known_;
};

/// The cell's plane is across a direction not far from this one: where three contacts are nearly in
/// line the cell does not tell it.
bool tells_plane(const MapCell& cell, const dvec3& beside) {
  if (cell.kind == MapCellKind::facet) return true;
  const auto d = DirectionMap::corners(cell);
  return glm::distance(cell.normal, beside) <= glm::distance(unit(d[0]), unit(d[3]));
}

}  // namespace

NodeCorners corners_of(const KnownArcs& known, const MapGraph::Node& node,
                       const DirectionMap& map) {
  NodeCorners corners;
  for (const MapGraph::End& end : node.ends) {
    const Ruling& r = known.ruling_at(end);
    corners.contacts.push_back(r.contact[end.end == 0 ? 0 : 1]);
    corners.beside.push_back(r.n);
    corners.n += r.n;
  }
  corners.n = unit(corners.n);
  const dvec3 beside = corners.n;
  for (const int k : node.cells) {
    const MapCell& cell = map.cells[std::size_t(k)];
    if (cell.has_plane() && tells_plane(cell, beside)) corners.n = cell.normal;
  }
  return corners;
}

void cut_ears(const RulingSearch& search, KnownArcs& known) { EarCutter(search, known).run(); }

}  // namespace taut
