#pragma once

#include <optional>

#include "taut/bounds/contact_climb.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Corners of a facet, and ends of its curved sides, that are no farther than `distance` from an
/// end of an edge are there, if that goes on as straight to within `depth`: where rounding leaves
/// curved sides level but for their ends.
void move_to_ends(const ContactGeometry& geometry, double depth, double distance,
                  FacetContacts& facet);

/// Corners of a facet with curved sides no farther apart than `distance`, with a straight side
/// between them, become one if that moves the outline by no more than `depth`.
void unite_corners(const ContactGeometry& geometry, double depth, double distance,
                   FacetContacts& facet);

/// Straight sides across dents of an edge, along which the facet's outline runs beside them, run
/// along it, too, where it is nowhere farther from them than so much.
void fill_dents(const ContactGeometry& geometry, double depth, FacetContacts& facet);

/// Of the places on the border of a contact's element straight across from it, those that are no
/// lower than `least` along n, the nearest: where a plane touches what is level, of all that it
/// touches there. None if there are none.
std::optional<ClimbedContact> level_border(const ContactGeometry& geometry, const Contact& c,
                                           const dvec3& n, double least);

/// The pieces of edges, and of what is between two places on them, that lead straight from one
/// place to another, one behind the other; none where they do not lead all the way.
std::vector<EdgeStretch> pieces_between(const ContactGeometry& geometry, const Contact& from,
                                        const Contact& to, double distance);

/// Straight sides across which no arc leaves run along the straight edges that make them, of
/// patches that leave the plane there without turning: pieces no farther from them than so much.
void run_along_edges(const ContactGeometry& geometry, double distance, FacetNode& facet);

}  // namespace taut
