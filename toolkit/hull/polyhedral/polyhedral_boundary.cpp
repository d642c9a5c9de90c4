#include "taut/hull/polyhedral/polyhedral_boundary.h"

#include <algorithm>

#include "taut/core/geometry.h"

namespace taut {
namespace {

class PolyhedralBoundary {
 public:
  PolyhedralBoundary(const Model& model, const HullMesh& mesh) : mesh_(mesh) {
    boundary_.frame = scene_frame(model.control_box());
    points_.reserve(mesh.n_vertices());
    contacts_.reserve(mesh.n_vertices());
    for (const auto v : mesh.vertices()) {
      points_.push_back(boundary_.frame.to_frame(position(mesh, v)));
      const Source s = model.source(mesh.data(v).source);
      contacts_.push_back({s.instance, SourceKind::vertex, s.index, 0, 0});
    }
  }

  HullBoundary run() {
    int count = 0;
    for (const auto f : mesh_.faces()) count = std::max(count, face(f) + 1);
    boundary_.faces.resize(std::size_t(count));
    for (const auto f : mesh_.faces()) {
      if (boundary_.faces[std::size_t(face(f))].contacts.empty()) add_facet(f);
    }
    boundary_.curves.reserve(mesh_.n_edges());
    for (const auto e : mesh_.edges()) {
      const auto h = mesh_.halfedge_handle(e, 0);
      const std::array<int, 2> sides = {face(mesh_.face_handle(h)),
                                        face(mesh_.opposite_face_handle(h))};
      if (sides[0] == sides[1]) continue;
      HullCurve curve;
      curve.faces = sides;
      curve.points = {point(mesh_.from_vertex_handle(h)), point(mesh_.to_vertex_handle(h))};
      boundary_.curves.push_back(std::move(curve));
    }
    return std::move(boundary_);
  }

 private:
  int face(OpenMesh::FaceHandle f) const { return mesh_.data(f).hull_face; }
  const dvec3& point(OpenMesh::VertexHandle v) const { return points_[std::size_t(v.idx())]; }

  /// The next side of the outline of the mesh faces that are one facet.
  OpenMesh::HalfedgeHandle next_side(OpenMesh::HalfedgeHandle h) const {
    const int own = face(mesh_.face_handle(h));
    h = mesh_.next_halfedge_handle(h);
    while (face(mesh_.opposite_face_handle(h)) == own) {
      h = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(h));
    }
    return h;
  }

  void add_facet(OpenMesh::FaceHandle f) {
    const int number = face(f);
    for (const auto start : mesh_.fh_range(f)) {
      if (face(mesh_.opposite_face_handle(start)) == number) continue;
      HullFace& facet = boundary_.faces[std::size_t(number)];
      facet.source = mesh_.data(f).source;
      facet.contacts.reserve(mesh_.valence(f));
      facet.points.reserve(mesh_.valence(f));
      OpenMesh::HalfedgeHandle h = start;
      do {
        const auto v = mesh_.from_vertex_handle(h);
        facet.contacts.push_back(contacts_[std::size_t(v.idx())]);
        facet.points.push_back(point(v));
        h = next_side(h);
      } while (h != start);
      facet.n = plane_normal(facet.points);
      facet.offset = glm::dot(facet.points[0], facet.n);
      for (const dvec3& p : facet.points)
        facet.offset = std::max(facet.offset, glm::dot(p, facet.n));
      return;
    }
  }

  const HullMesh& mesh_;
  std::vector<dvec3> points_;      // per vertex
  std::vector<Contact> contacts_;  // per vertex
  HullBoundary boundary_;
};

}  // namespace

HullBoundary polyhedral_boundary(const Model& model, const HullMesh& mesh) {
  return PolyhedralBoundary(model, mesh).run();
}

}  // namespace taut
