#include <algorithm>
#include <cmath>

#include "taut/envelope/gauss_triangles.h"

namespace taut {
namespace {

/// Cells along each side of the faces of a cube about the sphere.
constexpr int cells_a_side = 32;

/// How much lower than a point, in the scene's frame, what is hidden is at least: ten times what
/// surfaces may rise over the triangles that stand for them.
constexpr double hidden_depth = 1e-4;

}  // namespace

InnerPoints::InnerPoints(const std::vector<dvec3>& points) {
  for (int face = 0; face < 6; ++face) {
    for (int i = 0; i < cells_a_side; ++i) {
      for (int j = 0; j < cells_a_side; ++j) {
        dvec3 n(0.0);
        n[face / 2] = face % 2 == 0 ? 1 : -1;
        n[(face / 2 + 1) % 3] = (2.0 * i + 1) / cells_a_side - 1;
        n[(face / 2 + 2) % 3] = (2.0 * j + 1) / cells_a_side - 1;
        highest_.push_back(*std::max_element(
            points.begin(), points.end(),
            [&](const dvec3& a, const dvec3& b) { return glm::dot(a, n) < glm::dot(b, n); }));
      }
    }
  }
}

std::size_t InnerPoints::cell_of(const dvec3& n) {
  const dvec3 size = glm::abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto index = [&](int k) {
    const double t = 0.5 * (n[k % 3] / size[axis] + 1);
    return std::clamp(int(t * cells_a_side), 0, cells_a_side - 1);
  };
  const int face = 2 * axis + (n[axis] > 0 ? 0 : 1);
  return std::size_t((face * cells_a_side + index(axis + 1)) * cells_a_side + index(axis + 2));
}

bool InnerPoints::surely_hides(std::span<const dvec3> x, std::span<const dvec3> n,
                               double rise) const {
  dvec3 sum(0.0);
  for (const dvec3& direction : n) sum += direction;
  const dvec3& p = highest_[cell_of(sum)];
  for (const dvec3& point : x) {
    for (const dvec3& direction : n) {
      if (!(glm::dot(point - p, direction) + rise < -hidden_depth)) return false;
    }
  }
  return true;
}

bool InnerPoints::surely_hides(const GaussTriangles& triangles,
                               const GaussTriangles::Triangle& t) const {
  std::array<dvec3, 3> x{};
  std::array<dvec3, 3> n{};
  for (std::size_t k = 0; k < 3; ++k) {
    const GaussTriangles::Node& node = triangles.nodes[std::size_t(t.node[k])];
    x[k] = node.x;
    n[k] = node.n;
  }
  double bend = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    bend += std::abs(glm::dot(n[k] - n[next], x[k] - x[next]));
  }
  return surely_hides(x, n, bend / 8);
}

void InnerPoints::remove_hidden(GaussTriangles& triangles) const {
  std::erase_if(triangles.triangles,
                [&](const GaussTriangles::Triangle& t) { return surely_hides(triangles, t); });
  std::vector<int> number(triangles.nodes.size(), -1);
  std::vector<GaussTriangles::Node> nodes;
  for (GaussTriangles::Triangle& t : triangles.triangles) {
    for (int& node : t.node) {
      int& known = number[std::size_t(node)];
      if (known < 0) {
        known = int(nodes.size());
        nodes.push_back(triangles.nodes[std::size_t(node)]);
      }
      node = known;
    }
  }
  triangles.nodes = std::move(nodes);
}

}  // namespace taut
