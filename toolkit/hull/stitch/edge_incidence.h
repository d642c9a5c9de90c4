#pragma once

#include <map>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/solve/separating_graph.h"
#include "taut/hull/stitch/trim_loops.h"

namespace taut {

/// What lies on the hull beside the model's edges and seams. At each point of an edge that the hull
/// touches, the directions that support it make an arc across the tangent; beyond its two ends lies
/// the surface to the left and to the right of the edge: a patch that ends in it, a scroll, or a
/// facet of which it is a side.
class EdgeIncidence {
 public:
  EdgeIncidence(const ContactGeometry& geometry, const SeparatingGraph& graph,
                const std::vector<TrimRegion>& regions);

  /// One side of a stretch of an edge: a piece of an arc, a stretch of a region's outline, or a
  /// facet.
  struct Neighbor {
    int arc = -1;
    int piece = -1;
    int contact = 0;   ///< which of the piece's contacts lies on the edge
    double sense = 0;  ///< positive if the edge's parameter grows along the arc
    int region = -1;
    std::size_t loop = 0, index = 0;
    int node = -1;
    bool empty() const { return arc < 0 && region < 0 && node < 0; }
  };
  /// A stretch of a piece of an edge, from < to, with what lies to its left and to its right, seen
  /// from outside along the growing parameter.
  struct Stretch {
    int instance = -1;
    int piece = -1;
    double from = 0;
    double to = 0;
    Neighbor low;   ///< to the left
    Neighbor high;  ///< to the right
  };
  /// All stretches of edges on the hull along which nothing changes.
  std::vector<Stretch> overlay() const;

  /// The parameters, of a border that the piece lies on, strictly between two of them at which
  /// something changes, in order from the first to the second.
  std::vector<double> breaks(int instance, int piece, bool reversed, double from, double to) const;

 private:
  struct Interval {
    double from, to;
    bool low;
    Neighbor neighbor;
  };
  struct Edge {
    std::vector<Interval> intervals;
    std::vector<double> ends() const;
  };
  void add_arc(const ContactGeometry& geometry, const SeparatingArc& arc, int index, double depth);
  void add_facet(const FacetNode& node, int index);
  void add_region(const ContactGeometry& geometry, const TrimRegion& region, int index);

  std::map<std::pair<int, int>, Edge> edges_;  // by instance and piece
};

}  // namespace taut
