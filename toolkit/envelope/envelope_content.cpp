#include "taut/envelope/envelope_content.h"

#include <algorithm>

namespace taut {

Contact EnvelopeContent::told(const Contact& c) const {
  if (c.kind != SourceKind::vertex) return c;
  const Part& part = geometry.part(c);
  if (c.element < part.point_count()) return c;
  const int index = scene.model().instances()[std::size_t(c.instance)].part;
  if (is_corner[std::size_t(index)][std::size_t(c.element)] != 0) return c;
  const auto& ends = geometry.ends(c);
  if (ends.empty()) return c;
  const int instance = ends[0].instance >= 0 ? ends[0].instance : c.instance;
  return {instance, SourceKind::edge, ends[0].piece, double(ends[0].end), 0};
}

Contact EnvelopeContent::start(std::uint32_t triangle, const dvec3& n) const {
  const GaussTriangles::Triangle& t = triangles.triangles[triangle];
  Contact c = elements.contact(t.element);
  std::array<const GaussTriangles::Node*, 3> node{};
  for (std::size_t k = 0; k < 3; ++k) node[k] = &triangles.nodes[std::size_t(t.node[k])];
  // n is a sum of the corners' directions with these factors; the middle where they span nothing.
  dvec3 b(glm::dot(n, glm::cross(node[1]->n, node[2]->n)),
          glm::dot(n, glm::cross(node[2]->n, node[0]->n)),
          glm::dot(n, glm::cross(node[0]->n, node[1]->n)));
  if (b.x + b.y + b.z < 0) b = -b;
  b = glm::max(b, dvec3(0.0));
  const double sum = b.x + b.y + b.z;
  b = sum > 0 ? b / sum : dvec3(1.0 / 3);
  const dvec2 uv = b.x * node[0]->uv + b.y * node[1]->uv + b.z * node[2]->uv;
  c.u = std::clamp(uv.x, 0.0, 1.0);
  c.v = std::clamp(uv.y, 0.0, 1.0);
  return c;
}

}  // namespace taut
