#pragma once

#include <algorithm>
#include <vector>

#include "taut/core/integers.h"
#include "taut/hull/result/hull_document.h"

namespace taut {

/// What a document states of a curve's places, which lie on both of its faces: the larger bound.
inline double bound_of(const HullDocument& hull, const HullDocument::Curve& curve) {
  double bound = 0;
  for (const int face : curve.faces) {
    if (face >= 0) bound = std::max(bound, hull.faces[to_size(face)].tolerant);
  }
  return bound;
}

/// Per face the largest bound of it and of those that it shares curves with.
inline std::vector<double> bounds_beside(const HullDocument& hull) {
  std::vector<double> bounds;
  bounds.reserve(hull.faces.size());
  for (const HullDocument::Face& face : hull.faces) bounds.push_back(face.tolerant);
  for (const HullDocument::Curve& curve : hull.curves) {
    for (const int face : curve.faces) {
      if (face < 0) continue;
      bounds[to_size(face)] = std::max(bounds[to_size(face)], bound_of(hull, curve));
    }
  }
  return bounds;
}

}  // namespace taut
