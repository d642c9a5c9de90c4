#include "taut/hull/solve/known_arcs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/hull/decide/cell_contacts.h"
#include "taut/hull/decide/direction_cube.h"
#include "taut/hull/decide/graph_edits.h"
#include "taut/hull/decide/top_parts.h"
#include "taut/hull/solve/arc_pieces.h"
#include "taut/hull/solve/crossings.h"
#include "taut/hull/solve/level_pieces.h"

namespace taut {
namespace {

/// Depths below a plane, in units of the resolution, up to which what touches it may be told so.
constexpr double one_node_depths = 4;
/// Radius, as a share of the scene's size, of what is as high as that over the longest arcs that
/// are no longer than contacts can be told.
constexpr double least_radius = 0.1;

/// What a contact moves by where it is another one, as a share of the way to the other contact.
constexpr double jump_share = 0.1;

/// How far from the line through two contacts a third one is in line with them, as a share of the
/// way between them.
constexpr double line_share = 1e-3;

/// Rulings next to an end of an arc that may be of others.
constexpr std::size_t most_jumps = 8;

/// Shares of the step at which the graph is there, its arcs are cut and their rulings found.
constexpr double graph_share = 0.2;
constexpr double cut_share = 0.6;
constexpr double found_share = 0.7;

class ArcFinder {
 public:
  ArcFinder(const RulingSearch& search, const Progress& progress)
      : search_(search), progress_(progress), top_parts_(search.geometry()) {}

  KnownArcs run() {
    known_.graph = map_graph(search_.map(), search_.query());
    tell(graph_share);
    pass_narrow_facets();
    double crossings = 0;
    for (const MapGraph::Arc& arc : known_.graph.arcs) crossings += double(arc.crossings.size());
    double seen = 0;
    cut_arcs(known_.graph, [&](const MapCrossing& c) {
      tell(glm::mix(graph_share, cut_share, seen++ / crossings));
      return is_in_crossing(ruling_at(c));
    });
    find_rulings();
    while (drop_shallow_arcs() || contract_short_arcs()) find_rulings();
    join_crossings(search_, known_);
    if (drop_arcs_in_crossings()) find_rulings();
    return std::move(known_);
  }

 private:
  /// Of the step's share; what has to be done again is not told again.
  void tell(double share) {
    done_ = std::max(done_, share);
    progress_.update("trace", done_);
  }

  /// A facet that two arcs leave, or several in pairs between the same two contacts, has a side
  /// that is curved at least: else cells are so small that the contacts along the arcs, or between
  /// two of them that are as near to each other, are in one plane there.
  void pass_narrow_facets() {
    for (MapGraph::Node& node : known_.graph.nodes) {
      if (!node.is_facet || node.ends.empty() || has_curved_side(node) ||
          !arcs_pass(known_.graph, search_.map(), node)) {
        continue;
      }
      node.is_facet = false;
    }
    remove({});
  }

  void remove(const std::set<int>& arcs) {
    remove_arcs(known_.graph, search_.map(), arcs,
                [&](const MapGraph::Node& node) { return is_crossing(node); });
  }

  /// Its contacts touch each other where the model is no farther below.
  bool is_in_crossing(const Ruling& r) const {
    const std::vector<Ruling> found = touching_beside(search_, {r});
    return !found.empty() && glm::dot(r.point[0] - found[0].point[0], r.n) <=
                                 one_node_depths * search_.map().resolution;
  }

  bool is_crossing(const MapGraph::Node& node) {
    std::vector<Ruling> beside;
    for (const MapGraph::End& end : node.ends) {
      const MapGraph::Arc& arc = known_.graph.arcs[std::size_t(end.arc)];
      beside.push_back(ruling_at(end.end == 0 ? arc.crossings.front() : arc.crossings.back()));
    }
    return !touching_beside(search_, beside).empty();
  }

  bool has_curved_side(const MapGraph::Node& node) const {
    return std::any_of(node.cells.begin(), node.cells.end(), [&](int k) {
      const MapCell& cell = search_.map().cells[std::size_t(k)];
      if (!cell.has_plane()) return false;
      return !level_pieces(search_.geometry(), search_.query(), cell.normal,
                           search_.map().resolution)
                  .pieces.empty();
    });
  }

  void find_rulings() {
    known_.rulings.clear();
    const auto count = double(known_.graph.arcs.size());
    for (const MapGraph::Arc& arc : known_.graph.arcs) {
      tell(glm::mix(cut_share, found_share, double(known_.rulings.size()) / count));
      std::vector<Ruling>& own = known_.rulings.emplace_back();
      std::vector<bool> told;  // of each
      for (const MapCrossing& crossing : arc.crossings) {
        const Ruling& r = ruling_at(crossing);
        if (!own.empty() && glm::distance(own.back().n, r.n) <= same_contact) continue;
        own.push_back(r);
        told.push_back(is_told(crossing, r));
      }
      if (arc.is_closed()) continue;
      drop_untold(own, told);
      drop_points(own);
      drop_jumps(own);
      std::reverse(own.begin(), own.end());
      drop_jumps(own);
      std::reverse(own.begin(), own.end());
    }
  }

  /// Its contacts are those that the cell tells there: beside where several in line support, others
  /// may be as high as these to within the resolution.
  bool is_told(const MapCrossing& crossing, const Ruling& r) const {
    const std::vector<Box>& contacts = search_.map().cells[std::size_t(crossing.cell)].contacts;
    for (const std::size_t i : {0u, 1u}) {
      const Box& box = contacts[std::size_t(crossing.contact[i])];
      if (distance(box, r.point[i]) > search_.map().contact_extent()) return false;
    }
    return true;
  }

  /// What begins and ends an arc and is none of its rulings, if there are any.
  static void drop_untold(std::vector<Ruling>& own, const std::vector<bool>& told) {
    const auto first = std::find(told.begin(), told.end(), true);
    if (first == told.end()) return;
    const auto last = std::find(told.rbegin(), told.rend(), true).base();
    own.erase(own.begin() + (last - told.begin()), own.end());
    own.erase(own.begin(), own.begin() + (first - told.begin()));
  }

  /// Beside free ends the two contacts may be found to be one; such rulings tell nothing.
  static void drop_points(std::vector<Ruling>& own) {
    const auto is_point = [](const Ruling& r) {
      return glm::distance(r.point[0], r.point[1]) <= same_contact;
    };
    if (!std::all_of(own.begin(), own.end(), is_point)) std::erase_if(own, is_point);
  }

  /// What is before a jump near the beginning.
  static void drop_jumps(std::vector<Ruling>& own) {
    for (std::size_t k = std::min(own.size() / 2, most_jumps); k > 0; --k) {
      if (!jumps(own[k], own[k - 1])) continue;
      own.erase(own.begin(), own.begin() + std::ptrdiff_t(k));
      return;
    }
  }

  /// Beside where several contacts in line support, others than the arc's may be as high as these
  /// to within the resolution.
  static bool jumps(const Ruling& from, const Ruling& to) {
    const dvec3 along = to.point[0] - to.point[1];
    const double length = glm::length(along);
    for (const std::size_t i : {0u, 1u}) {
      const double off = glm::length(glm::cross(from.point[i] - to.point[i], unit(along)));
      const bool moves = glm::distance(from.point[i], to.point[i]) > jump_share * length;
      if (moves && off <= line_share * length) return true;
    }
    return false;
  }

  const Ruling& ruling_at(const MapCrossing& crossing) {
    const auto [found, is_new] =
        rulings_.try_emplace({place_on_cube(crossing.ends[0]), place_on_cube(crossing.ends[1]),
                              crossing.cell, crossing.contact},
                             Ruling{});
    if (is_new) found->second = search_.at(crossing);
    return found->second;
  }

  /// Those that lead from a crossing back to it and stay beside it. False if there are none.
  bool drop_arcs_in_crossings() {
    std::set<int> found;
    for (int k = 0; k < int(known_.graph.arcs.size()); ++k) {
      const MapGraph::Arc& arc = known_.graph.arcs[std::size_t(k)];
      const std::vector<Ruling>& rulings = known_.rulings[std::size_t(k)];
      const bool leads_back = !arc.is_closed() && arc.node[0] == arc.node[1];
      if (leads_back && !touching_beside(search_, rulings).empty()) found.insert(k);
    }
    if (!found.empty()) remove(found);
    return !found.empty();
  }

  /// False if there are none.
  bool drop_shallow_arcs() {
    std::set<int> shallow;
    const int count = int(known_.graph.arcs.size());
    for (int k = 0; k < count; ++k) {
      tell(glm::mix(found_share, 1.0, double(k) / count));
      const MapGraph::Arc& arc = known_.graph.arcs[std::size_t(k)];
      if (arc.is_closed()) continue;
      const bool ends_freely = std::any_of(arc.node.begin(), arc.node.end(), [&](int node) {
        const MapGraph::Node& own = known_.graph.nodes[std::size_t(node)];
        return own.ends.size() == 1 && !own.is_facet;
      });
      if (ends_freely && is_shallow(known_.rulings[std::size_t(k)])) shallow.insert(k);
    }
    if (!shallow.empty()) remove(shallow);
    return !shallow.empty();
  }

  /// Nodes that all but touch one plane, with the arcs between them, are one: two at a time, as
  /// three of which any two do need not touch one. False if there are none.
  bool contract_short_arcs() {
    std::set<int> found;
    std::map<int, int> partners;  // of nodes
    const auto is_taken = [&](int node, int by) {
      const auto partner = partners.find(node);
      return partner != partners.end() && partner->second != by;
    };
    for (int k = 0; k < int(known_.graph.arcs.size()); ++k) {
      const MapGraph::Arc& arc = known_.graph.arcs[std::size_t(k)];
      const auto [a, b] = arc.node;
      if (arc.is_closed() || is_taken(a, b) || is_taken(b, a)) continue;
      const bool is_one =
          a == b ? is_short(known_.rulings[std::size_t(k)]) : ends_are_one(k) || lies_in_node(k);
      if (!is_one) continue;
      found.insert(k);
      if (a == b) continue;
      partners[a] = b;
      partners[b] = a;
    }
    if (found.empty()) return false;
    contract_arcs(known_.graph, search_.map(), found,
                  [&](const MapGraph::Node& node) { return is_crossing(node); });
    return true;
  }

  /// All along it each of its contacts is as one, or one of others that are in line with it.
  bool is_short(const std::vector<Ruling>& rulings) const {
    const Ruling& middle = rulings[rulings.size() / 2];
    const double extent = extent_of_one();
    return std::all_of(rulings.begin(), rulings.end(), [&](const Ruling& r) {
      const bool is_one = glm::distance(middle.point[0], r.point[0]) <= extent &&
                          glm::distance(middle.point[1], r.point[1]) <= extent;
      return glm::distance(middle.n, r.n) <= extent && (is_one || jumps(r, middle));
    });
  }

  /// Of an arc and both of its nodes: what supports along the arc and beside these.
  std::vector<Ruling> rulings_about(int k) const {
    std::vector<Ruling> about = known_.rulings[std::size_t(k)];
    for (const int node : known_.graph.arcs[std::size_t(k)].node) {
      for (const MapGraph::End& end : known_.graph.nodes[std::size_t(node)].ends) {
        about.push_back(known_.ruling_at(end));
      }
    }
    return about;
  }

  /// What supports about a short arc does so in its middle, to within the resolution.
  bool ends_are_one(int k) const {
    const std::vector<Ruling>& own = known_.rulings[std::size_t(k)];
    if (!is_short(own)) return false;
    const dvec3& n = own[own.size() / 2].n;
    const double least = glm::dot(own[own.size() / 2].point[0], n) - depth_of_one();
    const std::vector<Ruling> about = rulings_about(k);
    return std::all_of(about.begin(), about.end(), [&](const Ruling& r) {
      for (const std::size_t i : {0u, 1u}) {
        if (glm::dot(r.point[i], n) >= least) continue;
        const ClimbedContact there = climb(search_.geometry(), r.contact[i], n);
        const bool is_other =
            glm::distance(there.x, r.point[i]) > glm::distance(there.x, r.point[1 - i]);
        if (there.h < least || is_other) return false;
      }
      return true;
    });
  }

  /// What supports about an arc along which planes hardly turn does so, where it is, in the plane
  /// of one of its nodes, to within the resolution; unless along curves.
  bool lies_in_node(int k) const {
    const std::vector<Ruling> about = rulings_about(k);
    const auto supports = [&](const dvec3& n) {
      const double least = search_.query()(n, about.front().contact[0]).h - depth_of_one();
      return std::all_of(about.begin(), about.end(), [&](const Ruling& r) {
        return glm::distance(r.n, n) <= extent_of_one() &&
               std::min(glm::dot(r.point[0], n), glm::dot(r.point[1], n)) >= least;
      });
    };
    for (const int at : known_.graph.arcs[std::size_t(k)].node) {
      const MapGraph::Node& node = known_.graph.nodes[std::size_t(at)];
      const bool lies = std::any_of(node.cells.begin(), node.cells.end(), [&](int c) {
        const MapCell& cell = search_.map().cells[std::size_t(c)];
        return cell.has_plane() && supports(cell.normal);
      });
      if (lies) return !has_curved_side(node);
    }
    return false;
  }

  double depth_of_one() const { return one_node_depths * search_.map().resolution; }
  /// By how much planes turn that touch what is no deeper.
  double extent_of_one() const { return std::sqrt(2 * depth_of_one() / least_radius); }

  bool is_shallow(const std::vector<Ruling>& rulings) const {
    // In the middle an arc is deepest, mostly.
    return is_shallow(rulings[rulings.size() / 2]) &&
           std::all_of(rulings.begin(), rulings.end(),
                       [&](const Ruling& r) { return is_shallow(r); });
  }
  bool is_shallow(const Ruling& r) const {
    const double rho = search_.map().resolution;
    return glm::distance(r.point[0], r.point[1]) <= rho ||
           top_parts_.hang_together(r.n, r.contact[0], r.contact[1], rho);
  }

  const RulingSearch& search_;
  const Progress& progress_;
  TopParts top_parts_;
  KnownArcs known_;
  double done_ = 0;
  using CrossingKey =
      std::tuple<std::array<long long, 3>, std::array<long long, 3>, int, std::array<int, 2>>;
  std::map<CrossingKey, Ruling> rulings_;
};

}  // namespace

KnownArcs known_arcs(const RulingSearch& search, const Progress& progress) {
  return ArcFinder(search, progress).run();
}

void join_arcs(KnownArcs& known, int node) {
  std::vector<MapGraph::End>& ends = known.graph.nodes[std::size_t(node)].ends;
  const MapGraph::End into = ends[0], out = ends[1];
  ends.clear();
  MapGraph::Arc& arc = known.graph.arcs[std::size_t(into.arc)];
  if (into.arc == out.arc) {
    arc.node = {-1, -1};
    return;
  }
  const auto turn = [&](int k) {
    MapGraph::Arc& own = known.graph.arcs[std::size_t(k)];
    std::swap(own.node[0], own.node[1]);
    reverse(known.rulings[std::size_t(k)]);
    for (const int at : own.node) {
      if (at < 0) continue;
      for (MapGraph::End& e : known.graph.nodes[std::size_t(at)].ends) {
        if (e.arc == k) e.end = 1 - e.end;
      }
    }
  };
  if (into.end == 0) turn(into.arc);
  if (out.end == 1) turn(out.arc);
  MapGraph::Arc& other = known.graph.arcs[std::size_t(out.arc)];
  arc.node[1] = std::exchange(other.node, {-1, -1})[1];
  std::vector<MapGraph::End>& there = known.graph.nodes[std::size_t(arc.node[1])].ends;
  const auto last = std::find_if(there.begin(), there.end(), [&](const MapGraph::End& e) {
    return e.arc == out.arc && e.end == 1;
  });
  *last = {into.arc, 1};
  std::vector<Ruling>& rulings = known.rulings[std::size_t(into.arc)];
  const std::vector<Ruling> more = std::exchange(known.rulings[std::size_t(out.arc)], {});
  rulings.insert(rulings.end(), more.begin(), more.end());
}

}  // namespace taut
