#include "taut/hull/solve/joint_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace taut {
namespace {

/// What pieces miss each other by where one follows the other is within the bounds of both.
void bound_pieces(SeparatingArc& arc, double tie) {
  for (std::size_t k = arc.closed ? 0 : 1; k < arc.pieces.size(); ++k) {
    ArcPiece& before = arc.pieces[(k == 0 ? arc.pieces.size() : k) - 1];
    ArcPiece& after = arc.pieces[k];
    for (std::size_t i = 0; i < 2; ++i) {
      const double missed =
          glm::distance(before.rulings.back().point[i], after.rulings.front().point[i]);
      if (missed <= tie) continue;
      for (ArcPiece* piece : {&before, &after}) piece->tolerant = std::max(piece->tolerant, missed);
    }
  }
}

/// What the end of an arc misses corners of the facet by in which it ends is within the bounds of
/// both.
void bound_ends(HullBoundary& boundary, double tie) {
  for (SeparatingArc& arc : boundary.arcs) {
    for (const std::size_t end : {0u, 1u}) {
      if (arc.closed || arc.facet[end] < 0) continue;
      HullFace& facet = boundary.faces[std::size_t(arc.facet[end])];
      ArcPiece& piece = end == 0 ? arc.pieces.front() : arc.pieces.back();
      for (const dvec3& x : (end == 0 ? piece.rulings.front() : piece.rulings.back()).point) {
        double missed = infinity;
        for (const dvec3& corner : facet.points)
          missed = std::min(missed, glm::distance(x, corner));
        if (missed <= tie) continue;
        piece.tolerant = std::max(piece.tolerant, missed);
        facet.tolerant = std::max(facet.tolerant, missed);
      }
    }
  }
}

/// From one ruling to the next: n and both contacts.
using Step = std::array<dvec3, 3>;

Step step_between(const Ruling& from, const Ruling& to) {
  return {to.n - from.n, to.point[0] - from.point[0], to.point[1] - from.point[1]};
}
double dot(const Step& a, const Step& b) {
  return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

/// n and both contacts go on to the left of contact a's way, as they do on a convex hull.
bool goes_on(const Ruling& from, const Ruling& to, double tie) {
  const dvec3 across = to.point[1] - to.point[0] + from.point[1] - from.point[0];
  const dvec3 on = unit(glm::cross(across, from.n + to.n));
  const Step step = step_between(from, to);
  return glm::dot(step[0], on) > 0 && glm::dot(step[1], on) >= -tie &&
         glm::dot(step[2], on) >= -tie;
}

/// Where rulings turn back, along a surface so nearly flat that rounding tells in which order they
/// follow each other, contacts are not known to be where planes touch.
void bound_turns(SeparatingArc& arc, double tie) {
  Step last{};
  Ruling from = arc.pieces.front().rulings.front();
  for (ArcPiece& piece : arc.pieces) {
    for (const Ruling& to : piece.rulings) {
      const Step step = step_between(from, to);
      const double length = std::sqrt(dot(step, step));
      if (length > tie) {
        const double back = -tie * (length + std::sqrt(dot(last, last)));
        const bool turns = dot(step, last) < back && !goes_on(from, to, tie);
        if (turns) piece.tolerant = std::max(piece.tolerant, tie);
        last = step;
      }
      from = to;
    }
  }
}

}  // namespace

void bound_joints(HullBoundary& boundary, double tie) {
  for (SeparatingArc& arc : boundary.arcs) {
    bound_pieces(arc, tie);
    bound_turns(arc, tie);
  }
  bound_ends(boundary, tie);
}

}  // namespace taut
