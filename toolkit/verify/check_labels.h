#pragma once

#include "taut/verify/document_geometry.h"
#include "taut/verify/hull_faults.h"

namespace taut {

/// Checks the sources that a hull document tells of scrolls and facets: a facet's is a face with a
/// part in the facet's plane, a scroll's is a face on which all of its rulings lie. Where none is
/// told there is none, as far as the ruled faces of the scene's model go. Others are faults
/// ("labels"). Polygons, which have no patches in a document, are not looked at. `resolution`: a
/// face is known to it only.
void check_labels(const DocumentGeometry& geometry, const Scene& scene, double resolution,
                  HullFaults& faults);

}  // namespace taut
