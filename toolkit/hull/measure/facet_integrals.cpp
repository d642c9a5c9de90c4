#include "taut/hull/measure/facet_integrals.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// The segment between a curved side and its chord, as the triangles between neighbouring rays from
/// where the side begins: begin + r (x - begin) has the area element r (x - begin) x dx/dt dr dt.
/// Two nodes in r are exact for its third degree. Of the side's normals the facet's own is the
/// lower end, as borders of patches have it.
void add_side(const ContactGeometry& geometry, const HullFace& face, const dvec3& begin,
              const EdgeStretch& side, const dvec3& origin, const dvec3& crease_origin,
              Sums& sums) {
  const dvec3 tip = begin - origin;
  const double sense = side.to < side.from ? -1 : 1;
  const double offset = std::sqrt(1.0 / 12);
  const auto f = [&](double t, double, Quantities& sample) {
    const ContactJet j = geometry.jet(side.at(t));
    const dvec3 ray = j.x - begin;
    const dvec3 element = glm::cross(ray, j.dx[0]);
    for (const double r : {0.5 - offset, 0.5 + offset}) {
      const dvec3 A = r * element;
      add_element(sample, tip + r * ray, A, glm::dot(A, face.n), 0.5);
    }
    sample[curvature] -= sense * crease(j.x - crease_origin, sense * j.dx[0], face.n);
  };
  integrate<16>(f, tolerances, side.from, side.to, sums, single_halvings);
}

/// A plane polygon, by the tetrahedra over a fan of triangles with the interior point as tip: the
/// integral of x_i x_j over one is det / 120 ((sum of x)_i (sum of x)_j + sum of x_i x_j).
void add_polygon(const HullFace& face, const dvec3& origin, Sums& sums) {
  using Vector = glm::vec<3, long double>;
  const auto at = [&](std::size_t k) {
    return Vector(face.points[k % face.points.size()]) - Vector(origin);
  };
  Vector total(0);
  for (std::size_t k = 0; k < face.points.size(); ++k) {
    total += 0.5L * glm::cross(at(k) - at(0), at(k + 1) - at(0));
  }
  const long double size = glm::length(total);
  if (!(size > 0)) return;
  const Vector n = total / size;
  auto& sum = sums.value;
  sum[area] += size;
  for (int i = 0; i < 3; ++i) sum[vector_area + std::size_t(i)] += total[i];
  for (std::size_t k = 1; k + 1 < face.points.size(); ++k) {
    const Vector a = at(0), b = at(k), c = at(k + 1);
    const Vector corners = a + b + c;
    const long double det = glm::dot(a, glm::cross(b, c));
    const long double twice = glm::dot(n, glm::cross(b - a, c - a));
    const auto product = [&](int i, int j) {
      return det / 120 * (corners[i] * corners[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    };
    sum[volume] += det / 6;
    for (int i = 0; i < 3; ++i) {
      const auto q = std::size_t(i);
      sum[moment + q] += det / 24 * corners[i];
      sum[second + q] += product(i, i);
      sum[second + 3 + q] += product((i + 1) % 3, (i + 2) % 3);
      sum[surface_moment + q] += twice / 6 * corners[i];
    }
  }
}

}  // namespace

void add_facet(const ContactGeometry& geometry, const HullFace& face, const dvec3& origin,
               const CreaseOrigins& creases, Sums& sums) {
  add_polygon(face, origin, sums);
  for (std::size_t k = 0; k < face.sides.size(); ++k) {
    if (face.sides[k].piece >= 0) {
      const EdgeStretch& side = face.sides[k];
      add_side(geometry, face, face.points[k], side, origin, creases.of(side.at(0.5)), sums);
    }
  }
}

bool is_polyhedron(const HullBoundary& boundary) {
  const auto is_polygon = [](const HullFace& face) {
    return face.kind == FaceKind::facet && face.sides.empty();
  };
  const auto is_segment = [](const HullCurve& curve) {
    return curve.points.size() == 2 && curve.faces[0] >= 0 && curve.faces[1] >= 0;
  };
  return boundary.arcs.empty() && !boundary.curves.empty() &&
         std::all_of(boundary.faces.begin(), boundary.faces.end(), is_polygon) &&
         std::all_of(boundary.curves.begin(), boundary.curves.end(), is_segment);
}

void add_creases(const HullBoundary& boundary, Sums& sums) {
  for (const HullCurve& curve : boundary.curves) {
    const dvec3 side = curve.points.back() - curve.points.front();
    const dvec3& m = boundary.faces[std::size_t(curve.faces[0])].n;
    const dvec3& n = boundary.faces[std::size_t(curve.faces[1])].n;
    sums.value[curvature] += 0.5 * glm::length(side) * exterior_angle(m, n, unit(side));
  }
}

}  // namespace taut
