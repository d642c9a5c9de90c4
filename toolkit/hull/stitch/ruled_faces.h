#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Labels the scrolls and facets that lie on ruled faces of the model with those faces
/// (HullFace::source): a facet with the first plane face in its plane, a scroll if the middle
/// rulings of all its pieces are rulings of one face, from end to end. How far pieces are known has
/// to be known (find_tolerant_places).
void label_ruled_faces(const ContactGeometry& geometry, HullBoundary& boundary);

}  // namespace taut
