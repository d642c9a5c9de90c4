#pragma once

#include <string>
#include <vector>

#include "families.h"
#include "support_reference.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut_test {

/// What the judge found of one model's hull.
struct Verdict {
  bool closed = false;    ///< there is a boundary, and nothing of it is unresolved
  bool verified = false;  ///< verify() finds nothing wrong at 1e-9 of the diagonal
  /// Why what the hull says is wrong, by the reference or a closed form; empty if it is not.
  std::string wrong;
  int unresolved = 0;
  int patches = 0, scrolls = 0, facets = 0, curves = 0;
  double bound = 0;  ///< of the mesh, in diagonals
  double seconds = 0;
};

/// What is wrong with the boundary's rulings and facets by the reference, in their directions and
/// in some next to them, where what supports is to be reached from their points. Empty if nothing.
std::string wrong_places(const taut::HullBoundary& boundary, const SupportReference& reference,
                         Random& random);

/// Judges the hull of a natural model in this variant. Models from cages are judged by verify()
/// alone. @throws what hulls throw, but for a tolerance that is not reached
Verdict judged(const Natural& natural, Variant variant, Random& random);

}  // namespace taut_test
