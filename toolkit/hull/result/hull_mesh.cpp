#include "taut/hull/result/hull_mesh.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <tuple>

namespace taut {
namespace {

/// Sides of the polygons are numbered through: per side, that along which the neighbour lies.
std::vector<int> opposite_sides(const std::vector<std::vector<int>>& polygons,
                                const Progress& progress) {
  struct Side {
    int low, high, number;
    bool rises;
  };
  std::vector<Side> sides;
  for (const std::vector<int>& polygon : polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const int from = polygon[k];
      const int to = polygon[(k + 1) % polygon.size()];
      sides.push_back({std::min(from, to), std::max(from, to), int(sides.size()), from < to});
    }
  }
  std::size_t compared = 0;
  std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) {
    progress.check_rarely(++compared);
    return std::tie(a.low, a.high, a.rises) < std::tie(b.low, b.high, b.rises);
  });
  std::vector<int> opposite(sides.size());
  for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
    const Side& a = sides[k];
    const Side& b = sides[k + 1];
    assert(a.low == b.low && a.high == b.high && !a.rises && b.rises);
    opposite[std::size_t(a.number)] = b.number;
    opposite[std::size_t(b.number)] = a.number;
  }
  return opposite;
}

}  // namespace

float float_above(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafterf(f, std::numeric_limits<float>::infinity()) : f;
}

HullMesh make_hull_mesh(const std::vector<dvec3>& vertices,
                        const std::vector<std::vector<int>>& polygons, const Progress& progress) {
  HullMesh mesh;
  // Euler: V - E + F = 2.
  mesh.reserve(vertices.size(), vertices.size() + polygons.size(), polygons.size());
  for (const dvec3& x : vertices) mesh.add_vertex({x.x, x.y, x.z});
  // OpenMesh's add_face() looks for every edge among all of its corner's: quadratic about the tip
  // of a cone.
  const std::vector<int> opposite = opposite_sides(polygons, progress);
  std::vector<OpenMesh::HalfedgeHandle> side;
  side.reserve(opposite.size());
  for (const std::vector<int>& polygon : polygons) {
    progress.check();
    const OpenMesh::FaceHandle face = mesh.new_face();
    const std::size_t first = side.size();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const OpenMesh::VertexHandle from(polygon[k]);
      const OpenMesh::VertexHandle to(polygon[(k + 1) % polygon.size()]);
      const auto other = std::size_t(opposite[side.size()]);
      side.push_back(other < side.size() ? mesh.opposite_halfedge_handle(side[other])
                                         : mesh.new_edge(from, to));
      mesh.set_face_handle(side.back(), face);
      mesh.set_halfedge_handle(from, side.back());
      if (k > 0) mesh.set_next_halfedge_handle(side[side.size() - 2], side.back());
    }
    mesh.set_next_halfedge_handle(side.back(), side[first]);
    mesh.set_halfedge_handle(face, side.back());
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
