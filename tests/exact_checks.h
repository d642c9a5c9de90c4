#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>

#include "boundary_checks.h"
#include "models.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/measure/boundary_measures.h"

namespace taut_test {

/// How many faces of each kind an exact boundary has.
struct FaceCounts {
  int patches = 0;
  int scrolls = 0;
  int facets = 0;
  bool operator==(const FaceCounts&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const FaceCounts& c) {
  return out << "patches " << c.patches << ", scrolls " << c.scrolls << ", facets " << c.facets;
}

inline FaceCounts face_counts(const taut::HullBoundary& boundary) {
  using taut::FaceKind;
  return {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
          boundary.count(FaceKind::facet)};
}

/// Where separating curves end on the sphere of directions.
struct CurveEnds {
  int triple_points = 0;  ///< facets with three contacts and straight sides
  int free_ends = 0;
  /// Over all nodes, facets and free ends, the sum of the curves that end there less two.
  int surplus = 0;
};

inline CurveEnds curve_ends(const taut::HullBoundary& boundary) {
  CurveEnds ends;
  for (const taut::HullFace& face : boundary.faces) {
    if (face.kind != taut::FaceKind::facet) continue;
    ends.triple_points += face.contacts.size() == 3 && face.sides.empty() ? 1 : 0;
    ends.surplus -= 2;
  }
  for (const taut::SeparatingArc& arc : boundary.arcs) {
    if (arc.closed) continue;
    for (const int facet : arc.facet) {
      ends.free_ends += facet < 0 ? 1 : 0;
      ends.surplus += facet < 0 ? -1 : 1;
    }
  }
  return ends;
}

/// Of the regions in which the model itself is the hull, as open sets: the sum of their Euler
/// characteristics. Of a closed smooth surface the sphere of directions is divided into these, so
/// that it is half the nodes' surplus plus two.
inline int region_characteristic(const taut::HullBoundary& boundary) {
  int sum = 0;
  for (const taut::HullFace& face : boundary.faces) {
    if (face.kind == taut::FaceKind::patch) sum += 2 - int(face.loops.size());
  }
  return sum;
}

/// The boundary alone, without a mesh.
inline taut::Hull boundary_of(const taut::Scene& scene) {
  taut::HullOptions options;
  options.threads = 1;
  taut::Hull hull;
  hull.kind = taut::HullKind::solid;
  hull.boundary =
      std::make_shared<const taut::HullBoundary>(exact_boundary(scene, options, hull.statistics));
  return hull;
}

inline taut::BoundaryMeasures measures_of(const taut::Scene& scene, const taut::Hull& hull) {
  return measure(scene, taut::ContactGeometry(scene), *hull.boundary);
}

inline void expect_complete(const taut::HullBoundary& boundary) {
  for (const taut::Unresolved& spot : boundary.unresolved) {
    ADD_FAILURE() << spot.reason << " at (" << spot.n.x << ", " << spot.n.y << ", " << spot.n.z
                  << ")";
  }
}

}  // namespace taut_test
