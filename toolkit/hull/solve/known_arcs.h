#pragma once

#include <vector>

#include "taut/core/progress.h"
#include "taut/hull/decide/map_graph.h"
#include "taut/hull/solve/ruling_search.h"

namespace taut {

/// The arcs that a direction map tells, each with the rulings in which it passes from cell to cell.
struct KnownArcs {
  MapGraph graph;
  std::vector<std::vector<Ruling>> rulings;  ///< by arc, in order, one at least

  /// The ruling next to an end of an arc.
  const Ruling& ruling_at(const MapGraph::End& end) const {
    const std::vector<Ruling>& own = rulings[std::size_t(end.arc)];
    return end.end == 0 ? own.front() : own.back();
  }
};

/// Finds them. Beside where an arc ends for want of resolution cells may tell contacts apart that
/// are one within it: arcs with an end of that kind, nowhere along which more than the resolution
/// is between the two contacts, are left out. Reports the step "trace". @throws Cancelled
KnownArcs known_arcs(const RulingSearch& search, const Progress& progress = {});

/// Makes one of the two arcs that end in a node, which has none then; the other one keeps its
/// number, and no rulings. @pre there are two such ends
void join_arcs(KnownArcs& known, int node);

}  // namespace taut
