#pragma once

#include <array>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/direction_map.h"

namespace taut {

/// Where an arc passes the side between two cells of a direction map.
struct MapCrossing {
  /// Directions of the ends of the side: to the right of the way along the arc, seen from outside
  /// of the sphere, and to its left.
  std::array<dvec3, 2> ends = {dvec3(0.0), dvec3(0.0)};
  /// A cell that tells the contacts apart which support at the two, and the numbers that it has for
  /// those that exchange here. (Others that are in line with them may exchange on the same side.)
  int cell = -1;
  std::array<int, 2> contact = {-1, -1};
};

/// Arcs and nodes of a direction map: a planar graph on the sphere, whatever the cells tell.
///
/// What a side between two cells shows, which arcs cross it, is told once, from its ends, for both.
/// Through cells that tell their contacts apart arcs pass from crossing to crossing; all others
/// that touch each other make a node, from which as many arcs leave as cross its border.
/// Where two cells do not agree on their side, as at ends of arcs for want of resolution, crossings
/// are left over in one of them, which is a node as well. (Two arcs that both cross one side, and
/// that no cell tells, are missed.)
struct MapGraph {
  /// A curve of directions in which two contacts support at once.
  struct Arc {
    std::vector<MapCrossing> crossings;  ///< in order along it, at least one
    std::array<int, 2> node = {-1, -1};  ///< in which it begins and ends; none if it is closed
    bool is_closed() const { return node[0] < 0; }
  };
  /// An end of an arc: it begins (0) or ends (1) there.
  struct End {
    int arc = -1;
    int end = 0;
  };
  /// Directions that are not told apart, with what leaves them; at least one arc, if it is not of
  /// a facet.
  struct Node {
    std::vector<int> cells;
    std::vector<End> ends;  ///< counter-clockwise from outside
    bool is_facet = false;  ///< one of its cells holds the normal of a plane with all that touches
  };
  std::vector<Arc> arcs;
  std::vector<Node> nodes;

  /// Parts of the sphere between them, by Euler's formula: contacts that stay one.
  int regions() const;
};

/// The query is of the scene whose map it is. @throws Cancelled
MapGraph map_graph(const DirectionMap& map, SupportQuery& query);

}  // namespace taut
