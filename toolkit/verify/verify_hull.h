#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_document.h"
#include "taut/verify/hull_faults.h"
#include "taut/verify/verify.h"

namespace taut {

/// What verify() found of a hull document. Lengths are fractions of the model's diagonal, and as
/// large as they were found: lower bounds of what may be wrong.
///
/// They are lengths beyond what the document states: a face's bound (HullDocument::Face::tolerant)
/// is taken off what places of it, and of its curves, are below supporting planes and off planes
/// by. Nothing is taken off what is above the model, off sources or off outlines.
struct HullVerification {
  /// What the rounding of coordinates, large against the diagonal far from the origin, may do to
  /// lengths.
  double rounding = 0;
  /// Every curve has two faces, and every face is there that the outlines ask for; of a planar hull
  /// there is one face.
  bool complete = false;
  /// The curves about every face close, those that it names are those that name it, and the
  /// outlines of patches and facets run from each curve to the next.
  bool closed = false;
  /// V - E + F, where a face counts as its own Euler characteristic; 2 for a convex body. A curve
  /// without ends, and what is no longer than rounding, counts as nothing; the other side of a
  /// planar hull as a face.
  int euler = 0;
  /// Largest distance of a source's control point from the model's, and difference of diagonals.
  double off_model = 0;
  /// Largest slope by which a contact's surface or edge rises over its supporting plane: derivative
  /// along n over a whole Bezier patch or curve, where that ends but for where it falls off; less
  /// what a place that is off by the resolution that the document states may have of it. At the
  /// ends of parameters, and of models whose numbers are rounded, the height that it rises to
  /// instead. Of faces that state a bound nothing.
  double tangency = 0;
  /// Largest |(a - b) . n| of a ruling, and distance of a facet's points from its plane.
  double flatness = 0;
  /// Largest distance of a contact's point from its source at its parameters, beyond the bound that
  /// its face states.
  double off_source = 0;
  /// Largest distance of a curve from one of its faces, or of a face's outline from its curves,
  /// beyond the bounds that these faces state.
  double off_outline = 0;
  /// max of h_model - h_document and of h_document - h_model over the directions of all rulings,
  /// some between them, and facets, by support queries.
  double model_outside = 0;
  double hull_outside = 0;  ///< see model_outside
  /// Largest h_model(n) - x . n of points x of patches with normal n.
  double patch_outside = 0;
  /// Directions, spread evenly, in which the boundary does not reach as far as the model: the
  /// model's contact is not on an edge or vertex that the document names, nor in a region of a
  /// patch or near its outline, nor is any place of these as near, or a listed point as high, as
  /// the resolution and the largest bound that the document states.
  int uncovered = 0;
  int directions = 0;  ///< that were tried, by all checks
  /// |integral of n dA| over the area, beyond what outlines of facets off their planes, by the
  /// bounds of the faces along them, make of it; and the relative difference of the mean width that
  /// is stated, and of that by integrals over the faces beyond what these may err by, from that by
  /// support queries; of hulls of dimension 3.
  double vector_area = 0;
  double mean_width_error = 0;  ///< see vector_area
  /// How well the integrals over the faces are known, as far as one can tell: volume, area and mean
  /// width, and the vector area.
  double measures_error = 0;
  double vector_area_error = 0;  ///< see measures_error
  /// How well that many queries tell it.
  double mean_width_accuracy = 0;
  /// The document's numbers are finite and its sources are the model's, else nothing was looked at
  /// that needs it: off_outline, patch_outside, uncovered, vector_area and mean_width_error.
  bool comparable = false;
  /// All else that is wrong, each with its place.
  std::vector<HullFault> faults;

  /// The boundary is one closed surface without holes.
  bool topological_sphere() const { return euler == 2; }
  /// The integral of n dA vanishes within the relative accuracy.
  bool closes_up(double relative) const;
  /// All mean widths agree within the relative accuracy.
  bool has_width(double relative) const;
  /// The largest of all lengths.
  double worst_length() const;
  /// Sound but for lengths within the tolerance.
  bool is_hull(double relative) const;
};

/// Checks a hull document against a model, from nothing but the document, support queries and plain
/// mathematics.
///
/// Of dimension 2 and 3: whether its faces make up one closed surface, its curves are what their
/// kinds say and lie on their faces, and its rulings and facets support the model, also in between.
/// Of dimension 3 moreover, if the sources are the model's: whether points of patches support, and
/// others of their sources do not; that the integrals of n and of mean curvature are those of a
/// closed surface about the model, and volume and area those of the report. Of a
/// planar hull it is how far its outline reaches, its area and its mean width; one of lower
/// dimension is checked for its sources and points alone, and counts as closed.
HullVerification verify(const HullDocument& hull, const Scene& scene,
                        const VerifyOptions& options = {});

}  // namespace taut
