#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/supporting_poles.h"
#include "taut/hull/trace/touched_stretches.h"

namespace taut {

/// The facet of the plane, with corners where stretches that lie on its straight sides begin, and
/// where chords of these end; along the rest of the edges it has them for sides.
FacetContacts with_stretches(const ContactGeometry& geometry, const dvec3& n,
                             const FacetContacts& f, const std::vector<TouchedStretch>& stretches);

/// The facets, with stretches, in the planes of these. Where there is none those of no area: their
/// corners, in line, are the edge's ends and the ends of chords; none for edges without chords,
/// which the ends of edges tell, nor where a chord leads from the one end to the other.
std::vector<Landmark> edge_stretches(const ContactGeometry& geometry, SupportQuery& query,
                                     const std::vector<TouchedStretch>& stretches);

}  // namespace taut
