#include "plates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/hull/polyhedral/polyhedral_hull.h"
#include "taut/hull/result/hull_mesh.h"
#include "taut/hull/result/measures.h"

namespace taut_test {

using namespace taut;  // NOLINT: what is tested

namespace {

/// Angle between the normals of two triangles of one facet: rounding, far below that of plates.
constexpr double same_plane = 1e-9;

std::vector<dvec3> both_centers(const Plate& plate) {
  std::vector<dvec3> centers;
  for (const dvec3& c : plate.centers) {
    centers.push_back(c);
    centers.push_back(c + dvec3(0, 0, plate.thickness));
  }
  return centers;
}

/// Planes of facets that are not horizontal.
int slopes(const std::vector<dvec3>& area) {
  std::vector<dvec3> normals;
  for (const dvec3& A : area) {
    const dvec3 n = unit(A);
    const auto is_same = [&](const dvec3& other) { return glm::distance(n, other) < same_plane; };
    const bool known = std::any_of(normals.begin(), normals.end(), is_same);
    if (!known && std::abs(n.z) < 1 - same_plane) normals.push_back(n);
  }
  return int(normals.size());
}

}  // namespace

Shape Plate::shape() const {
  Shape shape;
  for (const dvec3& c : both_centers(*this)) {
    shape.curves.push_back(shapes::circle(c, dvec3(radius, 0, 0), dvec3(0, radius, 0)));
  }
  return shape;
}

Plate plate_of_four(double radius, double thickness, double shift_x, double shift_y,
                    double raised) {
  return {
      radius, thickness, {{0, 0, 0}, {40 + shift_x, 0, 0}, {0, 30 + shift_y, raised}, {40, 30, 0}}};
}

Plate random_plate(unsigned seed) {
  Random random(seed);
  const auto one_of = [&](std::vector<double> values) {
    return values[std::size_t(uniform(random, 0, double(values.size())))];
  };
  const double radius = one_of({0.5, 1, 3});
  const double thickness = one_of({0.5, 1.5});
  const double shift_x = uniform(random, 0, 1);
  const double shift_y = uniform(random, 0, 1);
  return plate_of_four(radius, thickness, shift_x, shift_y, log_uniform(random, 0.01, 1));
}

/// V(P + D) = V(P) + r sum over facets of area sin(angle to the disc's plane) + pi r^2 times the
/// height, for the slices of P + D are those of P plus discs; mean widths add up, and that of a
/// disc is pi r / 2 (Schneider, Convex Bodies, 2014, sections 4.1 and 5.1).
PlateMeasures measures_of(const Plate& plate) {
  const HullMesh mesh = polyhedral_hull(make_model({{}, {}, both_centers(plate)})).mesh;
  std::vector<dvec3> area(mesh.n_faces(), dvec3(0.0));
  for (const auto f : mesh.faces()) {
    for (const auto h : mesh.fh_range(f)) {
      area[std::size_t(f.idx())] += 0.5 * glm::cross(position(mesh, mesh.from_vertex_handle(h)),
                                                     position(mesh, mesh.to_vertex_handle(h)));
    }
  }
  PlateMeasures sum;
  sum.volume = measure(polygons(mesh)).volume;
  double lowest = 0, highest = 0;
  for (const auto v : mesh.vertices()) {
    lowest = std::min(lowest, position(mesh, v).z);
    highest = std::max(highest, position(mesh, v).z);
  }
  const double r = plate.radius;
  sum.volume += std::numbers::pi * r * r * (highest - lowest);
  for (const dvec3& A : area) sum.volume += r * glm::length(dvec2(A));
  sum.facets = slopes(area) + 2;
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge_handle(e, 0);
    const dvec3& A = area[std::size_t(mesh.face_handle(h).idx())];
    const dvec3& B = area[std::size_t(mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx())];
    const double angle = std::atan2(glm::length(glm::cross(A, B)), glm::dot(A, B));
    sum.mean_width += mesh.calc_edge_length(e) * angle / (4 * std::numbers::pi);
    const dvec3 along =
        position(mesh, mesh.to_vertex_handle(h)) - position(mesh, mesh.from_vertex_handle(h));
    if (angle > same_plane && along.z != 0) ++sum.scrolls;
  }
  sum.mean_width += std::numbers::pi * r / 2;
  return sum;
}

}  // namespace taut_test
