#include "taut/hull/decide/cell_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/bounds/contact_climb.h"
#include "taut/hull/decide/farthest.h"

namespace taut {
namespace {

/// Rounds of Newton's kind for the plane of a node: contacts of a plane, and the plane of these.
constexpr int plane_rounds = 4;
/// In units of the resolution: three points span a plane if the planes across directions of a cell
/// part by more over the least of their distances from a line. What is thinner is near them all
/// across it.
constexpr double least_span = 4;

/// In units of the resolution: how far planes across directions of a cell part over a flat spot
/// that is waited for to become none.
constexpr double spot = 64;

/// How near a facet's normal is to the middle of its cells, in their half widths: cells beside one
/// that holds it would have to be split for ever.
constexpr double facet_reach = 1.5;

}  // namespace

double CellPlanes::width() const { return glm::distance(view_.corners()[0], view_.corners()[3]); }

bool CellPlanes::is_spot() const {
  Box box;
  for (const Branch& branch : branches_.all()) box.include({branch.lower, branch.upper});
  return diagonal(box) * width() <= spot * rho_;
}

void CellPlanes::collect_points() {
  points_.clear();
  for (const SeenPiece& s : view_.seen()) {
    const StoredNet& net = s.piece->net;
    const dvec4* p = net.points;
    for (int k = 0; k < net.shape.size(); ++k) points_.push_back(euclidean(p[k]));
  }
}

std::optional<CellPlanes::Plane> CellPlanes::facet() {
  collect_points();
  const dvec3 o = view_.q();
  const dvec3 along =
      unit(farthest(points_, [&](const dvec3& x) { return glm::distance(x, o); }) - o);
  const dvec3 beside =
      farthest(points_, [&](const dvec3& x) { return glm::length(glm::cross(x - o, along)); }) - o;
  const double reach = glm::length(glm::cross(beside, along));
  if (reach * width() < least_span * rho_) return std::nullopt;
  const dvec3 n = aligned(unit(glm::cross(beside, along)), axes_.own);
  double lower = 0;
  double upper = 0;
  for (const dvec3& x : points_) {
    lower = std::min(lower, glm::dot(x - o, n));
    upper = std::max(upper, glm::dot(x - o, n));
    if (upper - lower > 2 * rho_) return std::nullopt;  // on either side
  }
  if (!is_near(n)) return std::nullopt;
  return Plane{n, reach};
}

/// To the middle, in the cell's coordinates from -1 to 1.
bool CellPlanes::is_near(const dvec3& normal) const {
  const auto& d = view_.corners();
  const dvec3 to_plane = normal / glm::dot(normal, axes_.own);
  const double half = 0.5 * glm::dot(d[3] - d[0], axes_.first);
  const dvec3 off = (to_plane - 0.5 * (d[0] + d[3])) / half;
  return !(std::abs(glm::dot(off, axes_.first)) > facet_reach) &&
         !(std::abs(glm::dot(off, axes_.second)) > facet_reach);
}

/// From that through the middles of the branches on.
CellPlanes::Plane CellPlanes::node() const {
  const MapPieces& pieces = view_.pieces();
  const std::vector<Branch>& all = branches_.all();
  std::array<dvec3, 3> x;
  std::array<Contact, 3> contact;
  for (const std::size_t k : {0u, 1u, 2u}) {
    const MapPiece& piece =
        *view_.seen()[std::size_t(branches_.chart(all[k].charts[0]).pieces[0])].piece;
    contact[k] = pieces.element_of(piece).contact;
    contact[k].u = 0.5 * (piece.u.lower + piece.u.upper);
    contact[k].v = 0.5 * (piece.v.lower + piece.v.upper);
    x[k] = 0.5 * (all[k].lower + all[k].upper);
  }
  const auto normal = [&] {
    return aligned(unit(glm::cross(x[1] - x[0], x[2] - x[0])), axes_.own);
  };
  Plane plane{normal()};
  for (int round = 0; round < plane_rounds; ++round) {
    for (const std::size_t k : {0u, 1u, 2u}) {
      const ClimbedContact top = climb(pieces.geometry(), contact[k], plane.normal);
      // Beyond the branch is another contact.
      const dvec3 off = glm::max(all[k].lower - top.x, top.x - all[k].upper);
      if (std::max({off.x, off.y, off.z}) <= rho_) x[k] = top.x;
    }
    plane.normal = normal();
  }
  const double longest =
      std::max({glm::distance(x[0], x[1]), glm::distance(x[1], x[2]), glm::distance(x[2], x[0])});
  plane.width = glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / longest;
  return plane;
}

}  // namespace taut
