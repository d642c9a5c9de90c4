#include "taut/hull/sample/farthest_support.h"

#include <algorithm>
#include <array>
#include <utility>

#include "taut/hull/polytope/certificate.h"
#include "taut/hull/sample/sampled_start.h"
#include "taut/hull/sample/vertex_facets.h"

namespace taut {
namespace {

/// How much more than the largest distance seen the bound may be.
constexpr double slack = 1e-3;
/// Queries for the cone of a vertex, after which what is known of it must do.
constexpr int most_bisections = 4096;

/// A triangle of directions in which a vertex is the highest.
struct Cone {
  std::array<SeenPlane, 3> corners;
  double bound = 0;
};

class ConeSearch {
 public:
  ConeSearch(SupportQuery& query, const std::vector<dvec3>& frame_points)
      : query_(query), frame_points_(frame_points) {}

  void see(int vertex, const SeenPlane& plane);
  /// What certificate.h bounds the distance by in the directions of a vertex's cone.
  double bound(int vertex, const std::vector<SeenPlane>& planes) const;
  /// Narrows the bound of a vertex where that could be the largest.
  void search(int vertex, const std::vector<SeenPlane>& planes, const Progress& progress);
  bool may_be_farther(double bound) const { return bound > (1 + slack) * seen_; }
  void count(double bound) { result_.bound = std::max(result_.bound, bound); }
  FarthestSupport result() const { return result_; }

 private:
  double gap(int vertex, const SeenPlane& plane) const {
    return plane.h_bound - glm::dot(plane.n, frame_points_[std::size_t(vertex)]) + gap_rounding;
  }
  Cone cone(int vertex, const std::array<SeenPlane, 3>& corners) const {
    return {corners, bound(vertex, {corners.begin(), corners.end()})};
  }
  std::array<Cone, 2> bisected(int vertex, const Cone& cone);

  SupportQuery& query_;
  const std::vector<dvec3>& frame_points_;
  double seen_ = 0;
  FarthestSupport result_;
};

void ConeSearch::see(int vertex, const SeenPlane& plane) {
  const double distance = gap(vertex, plane);
  if (distance <= seen_) return;
  seen_ = distance;
  result_.vertex = vertex;
  result_.plane = plane;
}

double ConeSearch::bound(int vertex, const std::vector<SeenPlane>& planes) const {
  std::vector<dvec3> normals;
  double largest = 0;
  for (const SeenPlane& plane : planes) {
    normals.push_back(plane.n);
    largest = std::max(largest, gap(vertex, plane));
  }
  return distance_bound(largest, cone_depth(normals));
}

/// Across the longest side.
std::array<Cone, 2> ConeSearch::bisected(int vertex, const Cone& cone) {
  std::size_t longest = 0;
  const auto length = [&](std::size_t side) {
    return glm::distance(cone.corners[side].n, cone.corners[(side + 1) % 3].n);
  };
  for (std::size_t side = 1; side < 3; ++side) {
    if (length(side) > length(longest)) longest = side;
  }
  const SeenPlane& a = cone.corners[longest];
  const SeenPlane& b = cone.corners[(longest + 1) % 3];
  const SeenPlane& c = cone.corners[(longest + 2) % 3];
  const dvec3 n = unit(a.n + b.n);
  const Support s = query_(n, a.contact);
  const SeenPlane middle = {n, s.h_bound, s.point, s.contact};
  see(vertex, middle);
  return {this->cone(vertex, {a, middle, c}), this->cone(vertex, {middle, b, c})};
}

void ConeSearch::search(int vertex, const std::vector<SeenPlane>& planes,
                        const Progress& progress) {
  const auto lower = [](const Cone& a, const Cone& b) { return a.bound < b.bound; };
  std::vector<Cone> cones;  // a heap, the largest bound first
  for (std::size_t k = 1; k + 1 < planes.size(); ++k) {
    cones.push_back(cone(vertex, {planes[0], planes[k], planes[k + 1]}));
  }
  std::make_heap(cones.begin(), cones.end(), lower);
  for (int k = 0; k < most_bisections && may_be_farther(cones.front().bound); ++k) {
    progress.check();
    std::pop_heap(cones.begin(), cones.end(), lower);
    const Cone largest = cones.back();
    cones.pop_back();
    for (const Cone& half : bisected(vertex, largest)) {
      cones.push_back(half);
      std::push_heap(cones.begin(), cones.end(), lower);
    }
  }
  count(cones.front().bound);
}

}  // namespace

FarthestSupport farthest_support(SupportQuery& query, const PointHull& polytope,
                                 const std::vector<dvec3>& frame_points,
                                 const std::function<SeenPlane(int facet)>& plane_of,
                                 const Progress& progress) {
  const VertexFacets facets(polytope);
  ConeSearch search(query, frame_points);
  for (std::size_t f = 0; f < polytope.facets().size(); ++f) {
    progress.check_rarely(f);
    if (!polytope.facets()[f].alive) continue;
    for (const int v : polytope.facets()[f].vertex) search.see(v, plane_of(int(f)));
  }
  const auto planes_about = [&](int v) {
    std::vector<SeenPlane> planes;
    for (const int f : facets.about(v)) planes.push_back(plane_of(f));
    return planes;
  };
  std::vector<std::pair<double, int>> wanted;
  for (int v = 0; v < int(polytope.points().size()); ++v) {
    progress.check_rarely(std::size_t(v));
    const std::vector<SeenPlane> planes = planes_about(v);
    if (planes.empty()) continue;  // no vertex of the boundary any more
    const double bound = search.bound(v, planes);
    if (search.may_be_farther(bound)) {
      wanted.emplace_back(-bound, v);
    } else {
      search.count(bound);
    }
  }
  // The largest first, as what is seen there spares others.
  std::sort(wanted.begin(), wanted.end());
  for (const auto& [bound, v] : wanted) {
    if (search.may_be_farther(-bound)) {
      search.search(v, planes_about(v), progress);
    } else {
      search.count(-bound);
    }
  }
  return search.result();
}

}  // namespace taut
