#pragma once

#include "taut/surface/model.h"

namespace taut {

/// A place on the model: an instance's patch with (u, v) in [0, 1]^2, a piece of a free curve with
/// t in [0, 1] as u, or a free point. What support queries return and start from.
struct Contact {
  int instance = -1;                   ///< -1: no contact
  SourceKind kind = SourceKind::face;  ///< of the element
  int element = -1;  ///< index of the patch, piece or vertex in the instance's part
  double u = 0;      ///< first parameter, in [0, 1]; 0 of a vertex
  double v = 0;      ///< second one, of a patch; else 0
};

/// Both lie on the same patch, piece or vertex.
inline bool same_element(const Contact& a, const Contact& b) {
  return a.instance == b.instance && a.kind == b.kind && a.element == b.element;
}

inline dvec2 parameters(const Contact& c) { return {c.u, c.v}; }

/// A contact in the terms of the model: its source and the source's own parameters.
struct SourceContact {
  int source = -1;                     ///< Model::source; -1: none
  SourceKind kind = SourceKind::face;  ///< of the source
  double u = 0;                        ///< first of the source's own parameters; 0 of a vertex
  double v = 0;                        ///< second one, of a face; else 0
};

}  // namespace taut
