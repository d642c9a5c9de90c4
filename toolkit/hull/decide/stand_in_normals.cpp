#include "taut/hull/decide/stand_in_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/core/disjoint_sets.h"
#include "taut/core/geometry.h"

namespace taut {
namespace {

/// Differences of neighbouring control points along u or v; of a patch without weights
/// derivatives, but for a factor, are their means.
std::vector<dvec3> differences(NetShape shape, const dvec4* p, bool along_u) {
  std::vector<dvec3> result;
  const int row = shape.q + 1;
  for (int i = 0; i + (along_u ? 1 : 0) <= shape.p; ++i) {
    for (int j = 0; j + (along_u ? 0 : 1) <= shape.q; ++j) {
      const int k = i * row + j;
      result.push_back(euclidean(p[k + (along_u ? row : 1)]) - euclidean(p[k]));
    }
  }
  return result;
}

}  // namespace

bool StandInNormals::is_stand_in(const Chart& chart) const {
  return chart.kind == SourceKind::face &&
         pieces_.geometry().patch(pieces_.element(chart.element).contact).stand_in;
}

/// Normals are means of products of differences along u and v.
const StandInNormals::Cone& StandInNormals::cone(int element) {
  Cone& cone = cones_[std::size_t(element)];
  if (cone.angle >= 0) return cone;
  cone.angle = std::numbers::pi;
  const MapElement& e = pieces_.element(element);
  if (e.rational) return cone;
  const StoredNet& net = e.root->exact;
  const std::vector<dvec3> along_u = differences(net.shape, net.points, true);
  const std::vector<dvec3> along_v = differences(net.shape, net.points, false);
  dvec3 sum(0.0);
  for (const dvec3& a : along_u) {
    for (const dvec3& b : along_v) sum += glm::cross(a, b);
  }
  cone.axis = unit(sum);
  double largest = 0;
  for (const dvec3& a : along_u) {
    for (const dvec3& b : along_v) {
      largest = std::max(largest, angle_between(glm::cross(a, b), cone.axis));
    }
  }
  cone.angle = largest < 0.5 * std::numbers::pi ? largest : std::numbers::pi;
  return cone;
}

bool StandInNormals::are_points(const Branches& branches, const Branch& branch, double budget) {
  DisjointSets sets(branches.charts().size());
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (is_stand_in(branches.chart(glue.a)) && is_stand_in(branches.chart(glue.b))) {
      sets.unite(glue.a, glue.b);
    }
  }
  const double extent = glm::distance(branch.lower, branch.upper);
  return std::all_of(branch.charts.begin(), branch.charts.end(), [&](int k) {
    if (!is_stand_in(branches.chart(k))) return true;
    const Cone& own = cone(branches.chart(k).element);
    const Cone& first = cone(branches.chart(sets.find(k)).element);
    // Patches may be seen from either side.
    const dvec3 axis = aligned(own.axis, first.axis);
    const double off = angle_between(axis, first.axis) + own.angle;
    return 2 * off * extent <= budget;
  });
}

}  // namespace taut
