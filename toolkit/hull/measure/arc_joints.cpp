#include "taut/hull/measure/arc_joints.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/hull/contact/contact_system.h"

namespace taut {
namespace {

double turn(const dvec3& m, const dvec3& n) {
  return std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n));
}

double length(const Ruling& r) { return glm::distance(r.point[0], r.point[1]); }

double open_joint(const Ruling& before, const Ruling& after, double gap) {
  double open = 0.5 * length(after) * turn(before.n, after.n);
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = glm::distance(before.point[i], after.point[i]);
    if (step > std::max(gap, same_contact)) open += 0.5 * std::numbers::pi * step;
  }
  return open;
}

/// The facet in which the arc begins (0) or ends (1) has a normal of its own.
double open_end(const HullBoundary& boundary, const SeparatingArc& arc, std::size_t end) {
  if (arc.facet[end] < 0) return 0;
  const ArcPiece& piece = end == 0 ? arc.pieces.front() : arc.pieces.back();
  if (piece.rulings.empty()) return 0;
  const Ruling& r = end == 0 ? piece.rulings.front() : piece.rulings.back();
  return 0.5 * length(r) * turn(r.n, boundary.faces[std::size_t(arc.facet[end])].n);
}

}  // namespace

bool is_crease(const ArcPiece& piece) {
  if (piece.rulings.empty()) return false;
  const std::array<Contact, 2>& c = piece.rulings[0].contact;
  return c[0].kind == SourceKind::vertex && c[1].kind == SourceKind::vertex;
}

void add_vertex_creases(const SeparatingArc& arc, Sums& sums) {
  for (std::size_t p = 0; p < arc.pieces.size();) {
    std::vector<dvec3> ends;
    double angle = 0;
    const Ruling* last = nullptr;
    for (; p < arc.pieces.size() && is_crease(arc.pieces[p]); ++p) {
      for (const Ruling& r : arc.pieces[p].rulings) {
        if (last != nullptr) angle += turn(last->n, r.n);
        last = &r;
      }
      ends.insert(ends.end(), last->point.begin(), last->point.end());
    }
    double longest = 0;
    for (const dvec3& a : ends) {
      for (const dvec3& b : ends) longest = std::max(longest, glm::distance(a, b));
    }
    sums.value[curvature] += 0.5 * longest * angle;
    if (ends.empty()) ++p;
  }
}

double open_joints(const HullBoundary& boundary) {
  double open = 0;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (std::size_t p = 0; p < arc.pieces.size(); ++p) {
      if (p == 0 && !arc.closed) continue;
      const ArcPiece& before = arc.pieces[(p == 0 ? arc.pieces.size() : p) - 1];
      const ArcPiece& after = arc.pieces[p];
      if (before.rulings.empty() || after.rulings.empty()) continue;
      if (is_crease(before) && is_crease(after)) continue;
      open += open_joint(before.rulings.back(), after.rulings.front(), boundary.gap);
    }
    if (arc.pieces.empty()) continue;
    for (const std::size_t end : {0, 1}) open += open_end(boundary, arc, end);
  }
  return open;
}

}  // namespace taut
