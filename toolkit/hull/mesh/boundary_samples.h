#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/mesh/contact_faces.h"
#include "taut/hull/sample/sampled_polytope.h"

namespace taut {

/// A place on an arc.
struct ArcPlace {
  int arc = -1;
  int piece = -1;
  Ruling ruling;
};

/// Two samples with nothing between them on the curve along which a contact of an arc runs.
struct CurveChord {
  int a = -1;
  int b = -1;
  int contact = 0;
  ArcPlace from, to;  ///< of a and b
};

/// Samples on a hull's boundary, with the faces that each touches.
struct BoundarySamples {
  std::vector<Sample> samples;
  std::vector<dvec3> points;  ///< per sample, in model coordinates
  std::vector<TouchedFaces> faces;
  std::vector<CurveChord> chords;
};

/// How close samples come.
struct SampleSpacing {
  /// Gap that faces of the mesh may have, in model units; sagittas of curves stay below a share.
  double gap = 0;
  /// Samples closer than this to one before are left out, and their faces become that one's; in
  /// model units.
  double width = 0;
};

/// Samples the facets' contacts, the curves of a hull's boundary and a row along these inside the
/// patches.
///
/// On curves the samples are exact to rounding: both ends of rulings, so that these are edges of
/// the samples' hull, and places on edges and joins between patches, so dense that chords stay
/// within the sagitta as far as the boundary's own points tell their curvature. The rows keep a
/// distance at which triangles with the chords are equilateral in the metric of the second
/// fundamental form, in which a triangle's gap is a sixth of its side's square; with them the
/// chords are edges of the hull of the samples and of points farther inside.
BoundarySamples boundary_samples(const ContactGeometry& geometry, const HullBoundary& boundary,
                                 const ContactFaces& faces, const SampleSpacing& spacing,
                                 SupportQuery& query);

}  // namespace taut
