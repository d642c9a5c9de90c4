#pragma once

#include <optional>
#include <string>

#include "expected.h"
#include "families.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_document.h"
#include "taut/hull/result/hull_options.h"
#include "taut/surface/model.h"

namespace taut_test {

/// What the judge found of one model's hull.
struct Verdict {
  bool closed = false;    ///< there is a boundary, and nothing of it is unresolved
  bool within = false;    ///< and it is exact to within the resolution
  bool verified = false;  ///< verify() finds nothing wrong beyond what the hull states
  /// Why what the hull says is wrong, by a support function of the judge's own or by measures that
  /// are expected; empty if it is not.
  std::string wrong;
  /// "found, not expected" if the boundary is closed, yet not made of what is expected; else empty.
  std::string miscounted;
  /// What is said of a boundary that is not within the resolution; else empty.
  std::string missed;
  int unresolved = 0;
  Counts found;
  /// Measures that were compared: V, A and W for volume, area and mean width.
  std::string measured;
  double bound = 0;  ///< of the mesh, in diagonals
  double seconds = 0;
};

/// A model with what the judge knows of it.
struct Subject {
  taut::Model model;
  Expected expected;
  /// The model's geometry, or the cage of which it is the limit surface.
  Shape shape;
  std::optional<taut::ControlCage> cage;
};

/// The document of a hull with a boundary, and with the report that a user would find in it.
taut::HullDocument document_of(const taut::Scene& scene, const taut::Hull& hull);

/// Judges the hull of the subject's model. @throws what hulls throw, but for a tolerance that is
/// not reached
Verdict judged(const Subject& subject, Random& random, const taut::HullOptions& options = {});
/// Judges the hull of a natural model in this variant.
Verdict judged(const Natural& natural, Variant variant, Random& random,
               const taut::HullOptions& options = {});

}  // namespace taut_test
