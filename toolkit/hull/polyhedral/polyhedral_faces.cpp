#include "taut/hull/polyhedral/polyhedral_faces.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace taut {
namespace {

/// Slivers side by side that are passed on the way to a face with a normal.
constexpr std::size_t sliver_steps = 16;

}  // namespace

double PolyhedralFaces::height(const dvec3& p, OpenMesh::FaceHandle f) const {
  const auto corner = mesh_.to_vertex_handle(mesh_.halfedge_handle(f));
  return glm::dot(p - point_at(corner), normals_[std::size_t(f.idx())]);
}

void PolyhedralFaces::join_coplanar() {
  std::vector<int> face(mesh_.n_faces(), -1);
  std::vector<OpenMesh::FaceHandle> stack;
  int count = 0;
  for (const auto start : mesh_.faces()) {
    if (face[std::size_t(start.idx())] >= 0) continue;
    face[std::size_t(start.idx())] = count;
    stack.assign(1, start);
    while (!stack.empty()) {
      const auto f = stack.back();
      stack.pop_back();
      for (const auto g : mesh_.ff_range(f)) {
        const auto corners = mesh_.fv_range(g);
        const bool flat = std::all_of(corners.begin(), corners.end(), [&](auto v) {
          return std::abs(height(point_at(v), start)) <= width_;
        });
        if (face[std::size_t(g.idx())] >= 0 || !flat) continue;
        face[std::size_t(g.idx())] = count;
        stack.push_back(g);
      }
    }
    ++count;
  }
  for (const auto f : mesh_.faces()) mesh_.data(f).hull_face = face[std::size_t(f.idx())];
  mark_features();
}

void PolyhedralFaces::join_slivers() {
  if (width_ == 0) return;
  const auto length = [&](OpenMesh::HalfedgeHandle h) {
    return glm::distance(point_at(mesh_.from_vertex_handle(h)),
                         point_at(mesh_.to_vertex_handle(h)));
  };
  const auto longest_side = [&](OpenMesh::FaceHandle f) {
    const auto sides = mesh_.fh_range(f);
    return *std::max_element(sides.begin(), sides.end(),
                             [&](auto a, auto b) { return length(a) < length(b); });
  };
  const auto is_sliver = [&](OpenMesh::FaceHandle f) {
    const auto side = longest_side(f);
    const dvec3& from = point_at(mesh_.from_vertex_handle(side));
    const dvec3 along = unit(point_at(mesh_.to_vertex_handle(side)) - from);
    const auto corners = mesh_.fv_range(f);
    return std::all_of(corners.begin(), corners.end(), [&](auto v) {
      return glm::length(glm::cross(point_at(v) - from, along)) <= width_;
    });
  };
  std::vector<int> face(mesh_.n_faces());
  for (const auto f : mesh_.faces()) face[std::size_t(f.idx())] = mesh_.data(f).hull_face;
  bool any = false;
  for (const auto f : mesh_.faces()) {
    OpenMesh::FaceHandle across = f;
    for (std::size_t step = 0; is_sliver(across) && step < sliver_steps; ++step) {
      across = mesh_.opposite_face_handle(longest_side(across));
    }
    if (across == f) continue;
    face[std::size_t(f.idx())] = mesh_.data(across).hull_face;
    any = true;
  }
  if (!any) return;
  std::map<int, int> numbers;
  for (const auto f : mesh_.faces()) {
    const auto [number, is_new] = numbers.try_emplace(face[std::size_t(f.idx())], numbers.size());
    mesh_.data(f).hull_face = number->second;
  }
  mark_features();
}

void PolyhedralFaces::mark_features() {
  for (const auto e : mesh_.edges()) {
    const auto f = mesh_.face_handle(mesh_.halfedge_handle(e, 0));
    const auto g = mesh_.face_handle(mesh_.halfedge_handle(e, 1));
    mesh_.data(e).feature = mesh_.data(f).hull_face != mesh_.data(g).hull_face;
  }
}

void PolyhedralFaces::label() {
  std::vector<int> vertex_of(points_.points().size(), -1);
  for (std::size_t v = 0; v < corners_.size(); ++v) vertex_of[std::size_t(corners_[v])] = int(v);
  std::vector<int> valences(corners_.size(), 0);
  for (const auto h : mesh_.halfedges()) {
    ++valences[std::size_t(mesh_.to_vertex_handle(h).idx())];
  }
  std::vector<OpenMesh::FaceHandle> stack;
  points_.for_each_polygon([&](int source, const std::vector<int>& corners) {
    // All corners lie on the same face; the tip of a cone has many more.
    int touching = -1;
    for (const int c : corners) {
      const int v = vertex_of[std::size_t(c)];
      if (v < 0) continue;
      if (touching < 0 || valences[std::size_t(v)] < valences[std::size_t(touching)]) touching = v;
    }
    if (touching < 0) return;
    const auto visit = [&](OpenMesh::FaceHandle f) {
      if (mesh_.data(f).source >= 0) return;
      const bool lies_in = std::all_of(corners.begin(), corners.end(), [&](int c) {
        return std::abs(height(points_.points()[std::size_t(c)], f)) <= width_;
      });
      if (!lies_in) return;
      mesh_.data(f).source = source;
      stack.push_back(f);
    };
    for (const auto f : mesh_.vf_range(OpenMesh::VertexHandle(touching))) visit(f);
    while (!stack.empty()) {
      const auto f = stack.back();
      stack.pop_back();
      for (const auto g : mesh_.ff_range(f)) {
        if (mesh_.data(g).hull_face == mesh_.data(f).hull_face) visit(g);
      }
    }
  });
}

}  // namespace taut
