#pragma once

#include <vector>

#include "taut/bounds/scene.h"
#include "taut/verify/nearest_point.h"
#include "taut/verify/region_outlines.h"

namespace taut {

/// Whether a document's boundary reaches as far as the model does, but for a length.
class Coverage {
 public:
  /// All must outlive it. `limit`: the length, in model units. @pre the document's sources are the
  /// model's
  Coverage(const DocumentGeometry& geometry, const DocumentOutlines& outlines, const Scene& scene,
           double limit);

  /// For a support point of the model in direction n: whether it is on an edge or vertex that the
  /// document names, or in a region of a patch, be it at its border; or one of its copies in one
  /// place is, of which the document may name any; or some point of the boundary is no lower but
  /// for the limit: one that is listed, or one as near as that.
  bool covers(const dvec3& n, const Contact& contact) const;
  /// Whether an edge or vertex that the document names, or a region of a patch, is no farther from
  /// p, in model coordinates, than the limit.
  bool is_near(const dvec3& p) const;

 private:
  bool names(const Contact& contact) const;
  bool lists_as_high(const dvec3& n, const dvec3& p) const;

  const DocumentGeometry& geometry_;
  const DocumentOutlines& outlines_;
  const Scene& scene_;
  double limit_;
  std::vector<int> place_of_source_;  ///< by Model::source; -1: not named
  std::vector<dvec3> points_;         ///< of curves
  NearestPoint curves_;
  std::vector<std::vector<Box>> boxes_;  ///< of sources' patches, relative to the origin
};

}  // namespace taut
