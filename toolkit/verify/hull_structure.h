#pragma once

#include "taut/hull/result/hull_document.h"

namespace taut {

/// How the faces and curves of a hull document fit together.
struct HullStructure {
  /// There are faces, and every curve has two; of a planar hull one, to the left of all.
  bool complete = false;
  /// The curves about every face close, those that it names are those that name it, and the
  /// outlines of patches and facets run from each curve to the next.
  bool closed = false;
  /// V - E + F, where a face counts as its own Euler characteristic. A curve without ends, and what
  /// is no longer than the tolerance, counts as nothing; the other side of a planar hull as a face.
  int euler = 0;
};

/// Ends of curves with a face in common that are closer than the tolerance, in model units, and the
/// bounds that the curves' faces state, are one; both ends of one curve, than the tolerance.
HullStructure hull_structure(const HullDocument& hull, double tolerance);

}  // namespace taut
