#include "taut/envelope/gauss_triangles.h"

#include <algorithm>

namespace taut {
namespace {

/// A normal whose length is no larger, as a share of the longer tangent's square, says nothing.
constexpr double least_normal = 1e-9;

}  // namespace

SurfaceNormal surface_normal(const ContactGeometry& geometry, const Contact& c,
                             const ContactJet& j) {
  const dvec3 normal = glm::cross(j.dx[0], j.dx[1]);
  const double largest = std::max(glm::length(j.dx[0]), glm::length(j.dx[1]));
  if (glm::length(normal) > least_normal * largest * largest) return {unit(normal), true};
  const dvec3 limit = unit_normal(geometry.patch(c).bezier, c.u, c.v);
  return {geometry.to_frame(c.instance, limit), false};
}

void GaussTriangles::append(const GaussTriangles& other) {
  const auto offset = int(nodes.size());
  nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
  for (Triangle t : other.triangles) {
    for (int& node : t.node) node += offset;
    triangles.push_back(t);
  }
}

ElementNumbers::ElementNumbers(const Model& model) : model_(&model), first_(1, 0) {
  for (std::size_t i = 0; i < model.instances().size(); ++i) {
    const Part& p = part(i);
    first_.push_back(first_.back() +
                     int(p.patches().size() + p.pieces().size() + p.vertices().size()));
  }
}

int ElementNumbers::number(const Contact& c) const {
  const auto instance = std::size_t(c.instance);
  int number = first_[instance] + c.element;
  if (c.kind != SourceKind::face) number += int(part(instance).patches().size());
  if (c.kind == SourceKind::vertex) number += int(part(instance).pieces().size());
  return number;
}

Contact ElementNumbers::contact(int number) const {
  const auto next = std::upper_bound(first_.begin(), first_.end(), number);
  const auto instance = std::size_t(next - first_.begin()) - 1;
  const Part& p = part(instance);
  int rest = number - first_[instance];
  if (rest < int(p.patches().size())) return {int(instance), SourceKind::face, rest, 0, 0};
  rest -= int(p.patches().size());
  if (rest < int(p.pieces().size())) return {int(instance), SourceKind::edge, rest, 0, 0};
  return {int(instance), SourceKind::vertex, rest - int(p.pieces().size()), 0, 0};
}

}  // namespace taut
