#pragma once

#include <algorithm>
#include <vector>

#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// A direction in which separating curves meet: three or more contacts support in it, or all of a
/// curve, which makes a facet of the hull; or two surfaces touch each other (a crossing:
/// one point, with a contact and a slot for each separating curve that ends there).
struct FacetNode {
  dvec3 n = dvec3(0.0);
  /// Counter-clockwise from outside; with their points in the scene's frame.
  std::vector<Contact> contacts;
  std::vector<dvec3> points;
  /// As in FacetContacts.
  std::vector<EdgeStretch> sides;
  /// Per side from contact i to i + 1: the arc that leaves across it, contact i being the arc's
  /// contact 0 if it begins here (end 0), contact 1 if it ends here (end 1). None leaves across a
  /// curved side.
  struct Slot {
    int arc = -1;
    int end = 0;
  };
  std::vector<Slot> slots;

  bool is_crossing = false;

  bool is_curved(std::size_t side) const { return !sides.empty() && sides[side].piece >= 0; }
  bool has_curved_side() const {
    return std::any_of(sides.begin(), sides.end(), [](const auto& s) { return s.piece >= 0; });
  }
};

/// The separating curves of a scene's support function on the sphere of directions: a planar graph
/// whose nodes are facets and whose arcs end in nodes (SeparatingArc::facet are indices into
/// nodes), in free ends, or close up.
struct SeparatingGraph {
  std::vector<SeparatingArc> arcs;
  std::vector<FacetNode> nodes;
  std::vector<Unresolved> unresolved;
  long newton_iterations = 0;
  double depth = 0;  ///< to which heights are known, in the scene's frame
};

}  // namespace taut
