#include "taut/hull/sample/vertex_facets.h"

#include <algorithm>

namespace taut {

VertexFacets::VertexFacets(const PointHull& polytope)
    : polytope_(polytope), some_facet_(polytope.points().size(), -1) {
  for (const int v : polytope.simplex()) inside_ += 0.25 * polytope.point(v);
  for (std::size_t f = 0; f < polytope.facets().size(); ++f) {
    if (!polytope.facets()[f].alive) continue;
    for (const int v : polytope.facets()[f].vertex) some_facet_[std::size_t(v)] = int(f);
  }
}

void VertexFacets::update() {
  some_facet_.resize(polytope_.points().size(), -1);
  for (const int f : polytope_.created()) {
    for (const int v : polytope_.facet(f).vertex) some_facet_[std::size_t(v)] = f;
  }
}

bool VertexFacets::has(int facet, int vertex) const {
  if (facet < 0 || !polytope_.facet(facet).alive) return false;
  const std::array<int, 3>& own = polytope_.facet(facet).vertex;
  return std::find(own.begin(), own.end(), vertex) != own.end();
}

std::vector<int> VertexFacets::about(int vertex) const {
  std::vector<int> facets;
  const int first = some_facet_[std::size_t(vertex)];
  if (!has(first, vertex)) return facets;
  int f = first;
  do {
    facets.push_back(f);
    const PointHull::Facet& own = polytope_.facet(f);
    const auto k =
        std::size_t(std::find(own.vertex.begin(), own.vertex.end(), vertex) - own.vertex.begin());
    f = own.neighbor[k];
  } while (f != first);
  return facets;
}

bool VertexFacets::joined(int a, int b) const {
  const std::vector<int> facets = about(a);
  return std::any_of(facets.begin(), facets.end(), [&](int f) { return has(f, b); });
}

/// Of the point in the direction from inside, over the facet: 1 on its plane, more above.
double VertexFacets::polar_height(int facet, const dvec3& point) const {
  const std::array<int, 3>& own = polytope_.facet(facet).vertex;
  const dvec3& a = polytope_.point(own[0]);
  const dvec3 n = glm::cross(polytope_.point(own[1]) - a, polytope_.point(own[2]) - a);
  return glm::dot(n, point - inside_) / glm::dot(n, a - inside_);
}

int VertexFacets::below(const dvec3& point, int vertex) const {
  int best = some_facet_[std::size_t(vertex)];
  if (!has(best, vertex)) return -1;
  double highest = polar_height(best, point);
  for (bool climbs = true; climbs;) {
    climbs = false;
    for (const int f : polytope_.facet(best).neighbor) {
      const double h = polar_height(f, point);
      if (!(h > highest)) continue;
      highest = h;
      best = f;
      climbs = true;
    }
  }
  return highest > 1 ? best : -1;
}

}  // namespace taut
