#include "taut/hull/sample/narrow_cones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/hull/polytope/certificate.h"

namespace taut {
namespace {

/// Sides of a vertex that turn by no more than twice this, in radians, have one between them that
/// makes deep cones with both.
constexpr double narrow_turn = 1;

}  // namespace

/// The facets about the vertex, clockwise from outside: across the side that leads away from it the
/// next one lies.
std::vector<NarrowCones::Turn> NarrowCones::turns(int vertex, int facet) const {
  std::vector<Turn> result;
  int at = facet;
  do {
    const PointHull::Facet& own = hull_.facet(at);
    const auto k =
        std::size_t(std::find(own.vertex.begin(), own.vertex.end(), vertex) - own.vertex.begin());
    const int to = own.vertex[(k + 1) % 3];
    result.push_back({at, to, unit(hull_.point(to) - hull_.point(vertex))});
    at = own.neighbor[k];
  } while (at != facet);
  return result;
}

const NarrowCones::Asked& NarrowCones::ask(std::pair<int, int> place, const dvec3& n,
                                           const Contact& hint) {
  const auto [found, is_new] = asked_.try_emplace(place);
  if (is_new || found->second.n != n) found->second = {n, query_(n, hint)};
  return found->second;
}

NarrowCones::Certificate NarrowCones::certify(int vertex, int facet,
                                              const std::vector<dvec3>& normals,
                                              const Contact& hint) {
  Certificate result;
  std::vector<dvec3> around;
  const std::vector<Turn> turns = this->turns(vertex, facet);
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const dvec3& n = normals[std::size_t(turns[k].facet)];
    const dvec3& next = normals[std::size_t(turns[(k + 1) % turns.size()].facet)];
    result.facets.push_back(turns[k].facet);
    around.push_back(n);
    if (glm::dot(n, next) >= 0) continue;
    const std::pair<int, int> edge = std::minmax(vertex, turns[k].to);
    result.asked.push_back(ask(edge, unit(glm::cross(turns[k].along, n - next)), hint));
    around.push_back(result.asked.back().n);
  }
  // Between the sides where there are any: normals of facets tell it less well.
  dvec3 axis(0.0);
  for (const Asked& side : result.asked) axis += side.n;
  const double least = std::cos(narrow_turn) * double(result.asked.size());
  axis = glm::length(axis) > least ? unit(axis) : deepest_axis(around).axis;
  result.asked.push_back(ask({vertex, vertex}, axis, hint));
  result.depth = 1;
  for (std::size_t k = 0; k < around.size(); ++k) {
    const std::array cone = {axis, around[k], around[(k + 1) % around.size()]};
    result.depth = std::min(result.depth, cone_depth(cone));
  }
  return result;
}

}  // namespace taut
