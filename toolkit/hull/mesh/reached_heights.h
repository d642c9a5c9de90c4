#pragma once

#include <vector>

#include "taut/hull/mesh/contact_faces.h"

namespace taut {

/// How high a hull's boundary reaches. Where surfaces lie on each other, or edges beside them, it
/// has one of them, and points of another that support lie on no face of it.
class ReachedHeights {
 public:
  /// All must outlive it.
  ReachedHeights(const ContactGeometry& geometry, const HullBoundary& boundary,
                 const ContactFaces& faces);

  /// A point of a face near this one is as high as that along n, as climbs tell from places of the
  /// boundary. In the scene's frame.
  bool reaches(const dvec3& n, double height, const dvec3& near) const;

 private:
  struct Place {
    Contact contact;
    dvec3 x = dvec3(0.0);
  };

  const ContactGeometry& geometry_;
  const ContactFaces& faces_;
  std::vector<std::vector<Place>> places_;  ///< by element of the model that faces touch
};

}  // namespace taut
