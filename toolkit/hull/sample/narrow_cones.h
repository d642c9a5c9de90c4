#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/polytope/point_hull.h"

namespace taut {

/// Certifies vertices of a polytope whose facets' normals, nearly opposite or nearly in a plane,
/// make a cone without depth (certificate.h): those of thin bodies and sharp edges. Such a cone is
/// cut into deep ones by more directions, which are asked for: one across each edge between two
/// facets more than a right angle apart, outward, and one in the middle of all.
class NarrowCones {
 public:
  /// A direction that was asked for.
  struct Asked {
    dvec3 n = dvec3(0.0);
    Support support;
  };
  /// What is known of a vertex.
  struct Certificate {
    double depth = 0;  ///< of the shallowest of its cones, not positive if they prove nothing
    std::vector<Asked> asked;
    std::vector<int> facets;  ///< about the vertex
  };

  NarrowCones(const SceneContent& scene, const PointHull& hull, Stop stop)
      : hull_(hull), query_(scene, std::move(stop)) {}

  /// Of a vertex of this alive facet. `normals`: the directions that were asked for already, per
  /// facet place, of those that are alive. `hint`: the vertex's contact.
  Certificate certify(int vertex, int facet, const std::vector<dvec3>& normals,
                      const Contact& hint);

  const SupportQuery& query() const { return query_; }

 private:
  /// A facet about a vertex, and the corner to which its side from the vertex leads.
  struct Turn {
    int facet;
    int to;
    dvec3 along;
  };
  std::vector<Turn> turns(int vertex, int facet) const;
  const Asked& ask(std::pair<int, int> place, const dvec3& n, const Contact& hint);

  const PointHull& hull_;
  SupportQuery query_;
  std::map<std::pair<int, int>, Asked> asked_;  ///< by the edge's ends, or the vertex twice
};

/// Cones that are less deep are cut.
inline constexpr double narrow_depth = 1.0 / 8;

}  // namespace taut
