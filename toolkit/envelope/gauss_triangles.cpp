#include "taut/envelope/gauss_triangles.h"

#include <algorithm>

namespace taut {

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
