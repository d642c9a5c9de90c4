#pragma once

#include <map>
#include <utility>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// The points from which the angles of an edge's normals are measured (crease()), one for each
/// piece of an edge. From a point inside of a thin model they turn by half a turn where a tangent
/// passes it by closely, so that sums over arcs miss it. From far behind, against the mean of the
/// normals there, they hardly turn. A piece with normals so far apart that this does not see them
/// from below all has the point inside.
class CreaseOrigins {
 public:
  CreaseOrigins(const ContactGeometry& geometry, const HullBoundary& boundary, const dvec3& inside);

  /// @pre kind edge
  const dvec3& of(const Contact& c) const;
  /// The same for a side of a patch that lies on an edge.
  const dvec3& of(const PatchRegion& region, Side side) const;

 private:
  using Key = std::pair<int, int>;  // instance and piece
  struct Seen {
    dvec3 x;
    dvec3 n;
  };
  struct Piece {
    std::vector<Seen> seen;
    dvec3 origin;
  };

  Key key(const Contact& c) const;
  Contact on_edge(const PatchRegion& region, Side side) const;
  void add_arcs(const HullBoundary& boundary);
  void add_face(const HullFace& face);
  void add(const Contact& c, const dvec3& x, const dvec3& n) {
    pieces_[key(c)].seen.push_back({x, n});
  }
  dvec3 origin_of(const std::vector<Seen>& seen) const;

  const ContactGeometry& geometry_;
  dvec3 inside_;
  std::map<Key, Piece> pieces_;
};

}  // namespace taut
