#include "taut/hull/solve/known_arcs.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "taut/hull/decide/cell_contacts.h"
#include "taut/hull/decide/graph_edits.h"
#include "taut/hull/decide/top_parts.h"

namespace taut {
namespace {

class ArcFinder {
 public:
  ArcFinder(const RulingSearch& search, const Progress& progress)
      : search_(search), progress_(progress), top_parts_(search.geometry()) {}

  KnownArcs run() {
    known_.graph = map_graph(search_.map(), search_.query());
    find_rulings();
    while (drop_shallow_arcs()) find_rulings();
    return std::move(known_);
  }

 private:
  void find_rulings() {
    known_.rulings.clear();
    for (const MapGraph::Arc& arc : known_.graph.arcs) {
      progress_.check();
      std::vector<Ruling>& own = known_.rulings.emplace_back();
      for (const MapCrossing& crossing : arc.crossings) {
        const Ruling& r = ruling_at(crossing);
        if (own.empty() || glm::distance(own.back().n, r.n) > same_contact) own.push_back(r);
      }
    }
  }

  const Ruling& ruling_at(const MapCrossing& crossing) {
    const auto [found, is_new] =
        rulings_.try_emplace({rounded_direction(crossing.ends[0]),
                              rounded_direction(crossing.ends[1]), crossing.cell, crossing.contact},
                             Ruling{});
    if (is_new) found->second = search_.at(crossing);
    return found->second;
  }

  /// False if there are none.
  bool drop_shallow_arcs() {
    std::set<int> shallow;
    for (int k = 0; k < int(known_.graph.arcs.size()); ++k) {
      const MapGraph::Arc& arc = known_.graph.arcs[std::size_t(k)];
      if (arc.is_closed()) continue;
      const bool ends_freely = std::any_of(arc.node.begin(), arc.node.end(), [&](int node) {
        const MapGraph::Node& own = known_.graph.nodes[std::size_t(node)];
        return own.ends.size() == 1 && !own.is_facet;
      });
      if (ends_freely && is_shallow(known_.rulings[std::size_t(k)])) shallow.insert(k);
    }
    if (!shallow.empty()) remove_arcs(known_.graph, search_.map(), shallow);
    return !shallow.empty();
  }

  bool is_shallow(const std::vector<Ruling>& rulings) const {
    // In the middle an arc is deepest, mostly.
    return is_shallow(rulings[rulings.size() / 2]) &&
           std::all_of(rulings.begin(), rulings.end(),
                       [&](const Ruling& r) { return is_shallow(r); });
  }
  bool is_shallow(const Ruling& r) const {
    return top_parts_.hang_together(r.n, r.contact[0], r.contact[1], search_.map().resolution);
  }

  const RulingSearch& search_;
  const Progress& progress_;
  TopParts top_parts_;
  KnownArcs known_;
  using CrossingKey =
      std::tuple<std::array<long long, 3>, std::array<long long, 3>, int, std::array<int, 2>>;
  std::map<CrossingKey, Ruling> rulings_;
};

}  // namespace

KnownArcs known_arcs(const RulingSearch& search, const Progress& progress) {
  return ArcFinder(search, progress).run();
}

}  // namespace taut
