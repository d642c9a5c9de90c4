#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/verify.h"
#include "taut/io/hull_document.h"

namespace taut {

/// What verify() found of a hull document. Lengths are fractions of the model's diagonal, and as
/// large as they were found: lower bounds of what may be wrong.
struct HullVerification {
  /// Every curve has two faces, and every face is there that the outlines ask for.
  bool complete = false;
  /// The curves about every face close, those that it names are those that name it, and the
  /// outlines of patches and facets run from each curve to the next.
  bool closed = false;
  /// V - E + F, where a face counts as its own Euler characteristic; 2 for a convex body. A curve
  /// without ends, and what is no longer than rounding, counts as nothing.
  int euler = 0;
  /// Largest slope of a contact's surface or edge against its supporting plane: derivative along
  /// n over a whole Bezier patch or curve.
  double tangency = 0;
  /// Largest |(a - b) . n| of a ruling, and distance of a facet's points from its plane.
  double flatness = 0;
  /// Largest distance of a contact's point from its source at its parameters.
  double off_source = 0;
  /// max of h_model - h_document and of h_document - h_model over the directions of all rulings and
  /// facets, by support queries.
  double model_outside = 0;
  double hull_outside = 0;
  /// Random directions whose contact lies on a face of the model, in no region of a patch of the
  /// hull nor near its outline, or on another source that the document does not name.
  int uncovered = 0;
  int directions = 0;

  bool topological_sphere() const { return euler == 2; }
  bool is_hull(double relative) const {
    return complete && closed && topological_sphere() && uncovered == 0 && tangency <= relative &&
           flatness <= relative && off_source <= relative && model_outside <= relative &&
           hull_outside <= relative;
  }
};

/// Checks a hull document of dimension 2 or 3 against a model: whether its faces make up one closed
/// surface, and whether its rulings and facets support the model. A hull of lower dimension is
/// checked for its sources and points alone, and counts as closed.
///
/// Patches are checked at their outlines and, by random directions, for being there.
HullVerification verify(const HullDocument& hull, const Scene& scene,
                        const VerifyOptions& options = {});

}  // namespace taut
