#include "taut/hull/contact_planes.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"
#include "taut/hull/facet_contacts.h"

namespace taut {
namespace {

/// Sine of the angle below which control points are in line.
constexpr double least_sine = 1e-6;
/// Normals of one plane differ by no more: they are told by pieces as small as a thousandth.
constexpr double same_normal = 1e-9;

std::vector<dvec3> control_points(const BezierCurve& curve) {
  std::vector<dvec3> points;
  points.reserve(curve.points.size());
  for (const dvec4& p : curve.points) points.push_back(euclidean(p));
  return points;
}

/// The normal of the points' plane, by the largest triangle with the longest chord from the first;
/// zero where they do not lie in one, or lie on a line.
dvec3 plane_normal(const std::vector<dvec3>& points, double tie) {
  const dvec3& a = points.front();
  dvec3 chord(0.0);
  for (const dvec3& p : points) {
    if (glm::length(p - a) > glm::length(chord)) chord = p - a;
  }
  dvec3 normal(0.0);
  for (const dvec3& p : points) {
    const dvec3 cross = glm::cross(chord, p - a);
    if (glm::length(cross) > glm::length(normal)) normal = cross;
  }
  if (glm::length(normal) < least_sine * glm::dot(chord, chord)) return dvec3(0.0);
  normal = glm::normalize(normal);
  const bool plane = std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
    return std::abs(glm::dot(p - a, normal)) <= tie;
  });
  return plane ? normal : dvec3(0.0);
}

}  // namespace

std::vector<ContactPlane> contact_planes(const ContactGeometry& geometry, SupportQuery& query) {
  std::vector<ContactPlane> planes;
  const Model& model = geometry.scene().model();
  for (int i = 0; i < int(model.instances().size()); ++i) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int k = 0; k < int(part.pieces().size()); ++k) {
      const Contact piece{i, SourceKind::edge, k, 0, 0};
      if (geometry.is_repeated(piece)) continue;
      const std::vector<dvec3> points = control_points(geometry.curve(piece));
      const dvec3 normal = plane_normal(points, geometry.tie());
      if (normal == dvec3(0.0)) continue;
      for (const dvec3& n : {normal, -normal}) {
        const double offset = glm::dot(points.front(), n);
        const auto known = std::find_if(planes.begin(), planes.end(), [&](const ContactPlane& p) {
          return glm::distance(p.n, n) < std::max(same_normal, geometry.tie()) &&
                 std::abs(p.offset - offset) <= geometry.tie();
        });
        if (known != planes.end()) {
          known->pieces.push_back(piece);
        } else if (query(n, piece).h <= offset + geometry.tie()) {
          planes.push_back({n, offset, {piece}});
        }
      }
    }
  }
  return planes;
}

}  // namespace taut
