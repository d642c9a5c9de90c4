#pragma once

#include <vector>

#include "taut/hull/contact_faces.h"
#include "taut/hull/sampled_polytope.h"

namespace taut {

/// Samples on the curves of a hull's boundary, with the faces that each touches.
struct CurveSamples {
  std::vector<Sample> samples;
  std::vector<dvec3> points;  ///< per sample, in model coordinates
  std::vector<TouchedFaces> faces;
};

/// Samples the facets' contacts and the curves of a hull's boundary, exact to rounding, so that
/// the chords between consecutive ones stay within the sagitta (in model units) of the curves as
/// far as the boundary's own points tell their curvature: both ends of rulings, so that these are
/// edges of the samples' hull, and places on edges and joins between patches. Samples closer than
/// `width` to one before are left out, and their faces become that one's.
CurveSamples curve_samples(const ContactGeometry& geometry, const HullBoundary& boundary,
                           const ContactFaces& faces, double sagitta, double width);

}  // namespace taut
