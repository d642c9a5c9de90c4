#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// A direction in which separating curves meet: three or more contacts support in it, or all of a
/// curve, which makes a facet of the hull; or two surfaces or curves touch each other (a crossing:
/// one contact and point, and a slot for each separating curve that ends there, counter-clockwise).
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

  bool is_curved(std::size_t side) const { return !sides.empty() && sides[side].piece >= 0; }
  bool is_crossing() const { return points.size() == 1 && sides.empty(); }
};

/// The separating curves of a scene's support function on the sphere of directions: a planar graph
/// whose nodes are facets and whose arcs end in nodes (SeparatingArc::facet are indices into
/// nodes), in free ends, or close up.
struct SeparatingGraph {
  std::vector<SeparatingArc> arcs;
  std::vector<FacetNode> nodes;
  std::vector<Unresolved> unresolved;
  long newton_iterations = 0;
  /// Of the refinement of cells; those of the caller's query are counted there.
  long support_queries = 0;
  /// Cells, of the finest that were looked at, which are neither proven on nor off and which no
  /// known contact accounts for; in them curves were sought in vain.
  long cells_searched = 0;
  /// The search was given up since it took too many cells of support queries, as `unresolved` tells
  /// (not since too much of it failed): there may be much that it has not come to.
  bool exhausted = false;
};

/// Where curves are sought beside those between samples.
struct CurveSearch {
  bool cells = true;                  ///< in mixed cells
  const DirectionMap* map = nullptr;  ///< where it tells that contacts exchange
};

/// Finds and traces the separating curves that part the samples from each other: between every two
/// neighbours on the samples' polytope whose contacts no climb joins there is a curve; it is traced
/// to its ends, and so are all that leave its facets. Every ruling is checked against the support
/// function, to within ContactGeometry::tie().
///
/// The same where a side of a mixed cell leads from a point that supports to one that does not, and
/// on small circles about the normals of poles that support.
///
/// Mixed cells through which no curve runs by then are refined: their quarters are proven on or
/// off, or a curve is found across their sides, and so on for those that are left as long as they
/// become fewer; in the last of them, where curvature does not exclude it, free ends of the hull
/// are sought. A curve can be missed only there, and in cells that other curves cross. Or curves
/// are sought in all cells of the map in which contacts exchange and that none crosses by then.
/// @throws Cancelled
SeparatingGraph trace_separating_curves(const ContactGeometry& geometry, SupportQuery& query,
                                        const std::vector<Sample>& samples,
                                        const std::vector<CulledCell>& cells,
                                        const CurveSearch& search = {},
                                        const Progress& progress = {});

}  // namespace taut
