#include "taut/hull/hull_mesh.h"

#include <cmath>
#include <limits>

#include "taut/core/error.h"

namespace taut {

float float_above(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafterf(f, std::numeric_limits<float>::infinity()) : f;
}

HullMesh make_hull_mesh(const std::vector<dvec3>& vertices,
                        const std::vector<std::vector<int>>& polygons) {
  HullMesh mesh;
  // Euler: V - E + F = 2.
  mesh.reserve(vertices.size(), vertices.size() + polygons.size(), polygons.size());
  for (const dvec3& x : vertices) mesh.add_vertex({x.x, x.y, x.z});
  std::vector<OpenMesh::VertexHandle> corners;
  for (const std::vector<int>& polygon : polygons) {
    corners.clear();
    for (const int v : polygon) corners.emplace_back(v);
    if (!mesh.add_face(corners).is_valid()) {
      throw BackendError("OpenMesh refused a face of the hull");
    }
  }
  if (polygons.empty() && vertices.size() == 2) {
    const OpenMesh::VertexHandle a(0);
    const OpenMesh::VertexHandle b(1);
    const auto forth = mesh.new_edge(a, b);
    const auto back = mesh.opposite_halfedge_handle(forth);
    mesh.set_next_halfedge_handle(forth, back);
    mesh.set_next_halfedge_handle(back, forth);
    mesh.set_halfedge_handle(a, forth);
    mesh.set_halfedge_handle(b, back);
  }
  return mesh;
}

PolygonMesh polygons(const HullMesh& mesh) {
  PolygonMesh result;
  for (const auto v : mesh.vertices()) result.points.push_back(position(mesh, v));
  for (const auto f : mesh.faces()) {
    std::vector<int> polygon;
    for (const auto v : mesh.fv_range(f)) polygon.push_back(v.idx());
    result.polygons.push_back(std::move(polygon));
  }
  return result;
}

}  // namespace taut
