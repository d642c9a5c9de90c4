#include "taut/hull/sample/edge_constraints.h"

#include <algorithm>
#include <array>

#include "taut/core/geometry.h"
#include "taut/hull/sample/vertex_facets.h"

namespace taut {
namespace {

/// The facet has a corner this near to the segment between two other points, or the segment is no
/// longer than that.
bool comes_near(const PointHull& polytope, int facet, int a, int b, double distance) {
  const dvec3& from = polytope.point(a);
  const dvec3& to = polytope.point(b);
  if (glm::distance(from, to) <= distance) return true;
  const std::array<int, 3>& corners = polytope.facet(facet).vertex;
  return std::any_of(corners.begin(), corners.end(), [&](int v) {
    return v != a && v != b && distance_to_segment(polytope.point(v), from, to) <= distance;
  });
}

}  // namespace

bool bisect_between(const PointHull& polytope, const std::vector<int>& facets,
                    EdgeConstraints& constraints, const InsertMiddle& insert) {
  for (const int f : facets) {
    const PointHull::Facet& own = polytope.facet(f);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = own.vertex[k];
      const int b = own.vertex[(k + 1) % 3];
      const int other = own.neighbor[k];
      if (a > b || std::find(facets.begin(), facets.end(), other) == facets.end()) continue;
      const std::optional<EdgeConstraints::Middle> middle = constraints.middle(a, b);
      if (!middle) continue;
      const auto number = int(polytope.points().size());
      if (!insert(*middle, f) && !insert(*middle, other)) return false;
      constraints.bisect(a, b, number);
      return true;
    }
  }
  return false;
}

bool restore_wanted(const PointHull& polytope, EdgeConstraints& constraints, double scale,
                    std::size_t most, const InsertMiddle& insert, const Progress& progress) {
  VertexFacets facets(polytope);
  const double narrow = scale * constraints.narrow();
  const auto restore = [&](int a, int b) {
    if (facets.joined(a, b) || polytope.points().size() >= most) return;
    const std::optional<EdgeConstraints::Middle> middle = constraints.middle(a, b);
    if (!middle) return;
    const auto number = int(polytope.points().size());
    const auto inserts_from = [&](int end) {
      const int facet = facets.below(scale * middle->point, end);
      return facet >= 0 && !comes_near(polytope, facet, a, b, narrow) && insert(*middle, facet);
    };
    if (!inserts_from(a) && !inserts_from(b)) return;
    facets.update();
    constraints.bisect(a, b, number);
  };
  const std::size_t before = polytope.points().size();
  for (std::size_t count = 0; count < polytope.points().size();) {
    count = polytope.points().size();
    for (const auto& [a, b] : constraints.wanted()) {
      progress.check();
      restore(a, b);
    }
  }
  return polytope.points().size() > before;
}

}  // namespace taut
