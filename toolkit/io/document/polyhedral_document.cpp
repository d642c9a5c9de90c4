#include "taut/io/document/polyhedral_document.h"

#include <algorithm>
#include <limits>

#include "taut/hull/result/hull_sources.h"

namespace taut {
namespace {

/// By points of size one, the products of which neither overflow nor vanish.
dvec3 facet_normal(const std::vector<dvec3>& boundary, double diagonal) {
  std::vector<dvec3> points;
  points.reserve(boundary.size());
  for (const dvec3& p : boundary) points.push_back((p - boundary[0]) / diagonal);
  return plane_normal(points);
}

}  // namespace

HullDocument hull_document(const Model& model, const HullMesh& mesh,
                           const std::vector<std::string>& files) {
  HullSources sources(model, files);
  for (const auto v : mesh.vertices()) sources.add(mesh.data(v).source);
  for (const auto f : mesh.faces()) sources.add(mesh.data(f).source);
  sources.finish();

  HullDocument document;
  document.diagonal = diagonal(model.control_box());
  document.dimension = mesh.n_faces() == 0  ? int(mesh.n_vertices()) - 1
                       : mesh.n_faces() > 2 ? 3
                                            : 2;
  document.sources = sources.make();
  for (const auto f : mesh.faces()) {
    // The two sides of a planar hull are one face.
    if (document.dimension == 2 && f.idx() > 0) break;
    HullDocument::Face& face = document.faces.emplace_back();
    face.source = sources.place(mesh.data(f).source);
    for (const auto h : mesh.fh_range(f)) {
      const auto v = mesh.from_vertex_handle(h);
      face.outline.emplace_back(mesh.edge_handle(h).idx(), h.idx() % 2 == 0 ? 1 : -1);
      face.boundary.push_back(position(mesh, v));
      face.contacts.push_back({sources.place(mesh.data(v).source), {}, position(mesh, v)});
    }
    face.normal = facet_normal(face.boundary, document.diagonal);
    face.offset = -std::numeric_limits<double>::infinity();
    for (const dvec3& p : face.boundary) {
      face.offset = std::max(face.offset, glm::dot(face.normal, p));
    }
  }
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge_handle(e, 0);
    const auto opposite = mesh.halfedge_handle(e, 1);
    const auto face = [&](OpenMesh::HalfedgeHandle side) {
      const int f = mesh.face_handle(side).idx();
      return f < int(document.faces.size()) ? f : -1;
    };
    document.curves.push_back(
        {HullCurveKind::ruling,
         {face(h), face(opposite)},
         -1,
         {position(mesh, mesh.from_vertex_handle(h)), position(mesh, mesh.to_vertex_handle(h))}});
  }
  return document;
}

HullDocument hull_document(const Scene& scene, const HullMesh& mesh,
                           const std::vector<std::string>& files) {
  HullDocument document = hull_document(scene.model(), mesh, files);
  document.diagonal = scene.diagonal();
  return document;
}

}  // namespace taut
