#pragma once

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Rounding of a model's numbers has made its resolution what it is, or a good share of it:
/// surfaces are known to it only, also between rulings. Those of cages are computed, whatever the
/// cages' points were rounded to. `resolution`: in the scene's frame.
bool is_rounded(const Scene& scene, double resolution);

/// Finds out how far arcs and faces of a boundary are below the supporting planes with their
/// normals (ArcPiece::tolerant, HullFace::tolerant), by support queries: at the rulings that are
/// stored and midway between them and, where these are farther than rounding makes them, closer; at
/// the corners and curved sides of facets; at a grid of places in patches, of which stand-ins are
/// within their deviation. Points that are off their contacts, and by which pieces miss each other,
/// count as well. Where no rulings are found between two, they are known to the resolution, in the
/// scene's frame; where contacts are farther than that from where the planes touch, or rulings turn
/// back, to what heights tie. These are bounds as far as such places tell. Reports the step
/// "stitch". @throws Cancelled
void find_tolerant_places(const ContactSystem& system, SupportQuery& query, HullBoundary& boundary,
                          double resolution, const Progress& progress = {});

}  // namespace taut
