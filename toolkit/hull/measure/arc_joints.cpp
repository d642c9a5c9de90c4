#include "taut/hull/measure/arc_joints.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/core/geometry.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {
namespace {

/// Adds the crease along a ruling, from the normal on its one side to that on the other, as n goes
/// along the arc: half its length times the angle that n turns by about it. What else it turns by
/// is an error.
void add_crease(const Ruling& r, const dvec3& before, const dvec3& after, Sums& sums) {
  const dvec3 way = r.point[1] - r.point[0];
  const double half = 0.5 * glm::length(way);
  const double about =
      std::atan2(glm::dot(glm::cross(before, after), unit(way)), glm::dot(before, after));
  sums.value[curvature] += half * about;
  sums.error[curvature] += half * std::max(angle_between(before, after) - std::abs(about), 0.0);
}

/// What a step of the contacts may make the curvature of a joint be off by.
double step_error(const Ruling& before, const Ruling& after, double gap) {
  double error = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = glm::distance(before.point[i], after.point[i]);
    if (step > std::max(gap, same_contact)) error += 0.5 * std::numbers::pi * step;
  }
  return error;
}

/// The facet in which the arc begins (0) or ends (1) has a normal of its own.
void add_end(const HullBoundary& boundary, const SeparatingArc& arc, std::size_t end, Sums& sums) {
  if (arc.facet[end] < 0) return;
  const ArcPiece& piece = end == 0 ? arc.pieces.front() : arc.pieces.back();
  if (piece.rulings.empty()) return;
  const Ruling& r = end == 0 ? piece.rulings.front() : piece.rulings.back();
  const dvec3& n = boundary.faces[std::size_t(arc.facet[end])].n;
  add_crease(r, end == 0 ? n : r.n, end == 0 ? r.n : n, sums);
}

}  // namespace

ScrollPieces pieces_of_scrolls(const HullBoundary& boundary) {
  ScrollPieces in_scroll;
  in_scroll.reserve(boundary.arcs.size());
  for (const SeparatingArc& arc : boundary.arcs) in_scroll.emplace_back(arc.pieces.size(), false);
  for (const HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::scroll) continue;
    std::vector<bool>& used = in_scroll[std::size_t(face.scroll.arc)];
    for (int k = 0; k < face.scroll.count; ++k) {
      used[std::size_t(face.scroll.first + k) % used.size()] = true;
    }
  }
  return in_scroll;
}

void add_creases(const SeparatingArc& arc, const std::vector<bool>& in_scroll, Sums& sums) {
  for (std::size_t p = 0; p < arc.pieces.size();) {
    std::vector<dvec3> ends;
    double angle = 0;
    const Ruling* last = nullptr;
    for (; p < arc.pieces.size() && !in_scroll[p]; ++p) {
      for (const Ruling& r : arc.pieces[p].rulings) {
        if (last != nullptr) angle += angle_between(last->n, r.n);
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

void add_joints(const HullBoundary& boundary, const ScrollPieces& in_scroll, Sums& sums) {
  for (std::size_t a = 0; a < boundary.arcs.size(); ++a) {
    const SeparatingArc& arc = boundary.arcs[a];
    for (std::size_t p = 0; p < arc.pieces.size(); ++p) {
      if (p == 0 && !arc.closed) continue;
      const std::size_t previous = (p == 0 ? arc.pieces.size() : p) - 1;
      const ArcPiece& before = arc.pieces[previous];
      const ArcPiece& after = arc.pieces[p];
      if (before.rulings.empty() || after.rulings.empty()) continue;
      if (!in_scroll[a][previous] && !in_scroll[a][p]) continue;
      const Ruling& last = before.rulings.back();
      const Ruling& first = after.rulings.front();
      add_crease(first, last.n, first.n, sums);
      sums.error[curvature] += step_error(last, first, boundary.gap);
    }
    if (arc.pieces.empty()) continue;
    for (const std::size_t end : {0, 1}) add_end(boundary, arc, end, sums);
  }
}

}  // namespace taut
