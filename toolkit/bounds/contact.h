#pragma once

#include "taut/surface/model.h"

namespace taut {

/// A place on the model: an instance's patch with (u, v) in [0, 1]^2, a piece of a free curve with
/// t in [0, 1] as u, or a free point. What support queries return and start from.
struct Contact {
  int instance = -1;  ///< -1: no contact
  SourceKind kind = SourceKind::face;
  int element = -1;  ///< index of the patch, piece or vertex in the instance's part
  double u = 0;
  double v = 0;
};

/// Both lie on the same patch, piece or vertex.
inline bool same_element(const Contact& a, const Contact& b) {
  return a.instance == b.instance && a.kind == b.kind && a.element == b.element;
}

inline dvec2 parameters(const Contact& c) { return {c.u, c.v}; }

/// A contact in the terms of the model: its source and the source's own parameters.
struct SourceContact {
  int source = -1;
  SourceKind kind = SourceKind::face;
  double u = 0;
  double v = 0;
};

}  // namespace taut
