#pragma once

#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Corners of a facet, and ends of its curved sides, that are no farther from an end of an edge are
/// there: where rounding leaves curved sides level but for their ends.
void move_to_ends(const ContactGeometry& geometry, double distance, FacetContacts& facet);

/// Corners of a facet with curved sides no farther apart than so much, with a straight side between
/// them, become one.
void unite_corners(double distance, FacetContacts& facet);

/// Straight sides across dents of an edge, along which the facet's outline runs beside them, run
/// along it, too, where it is nowhere farther from them than so much.
void fill_dents(const ContactGeometry& geometry, double depth, FacetContacts& facet);

/// Straight sides across which no arc leaves run along the straight edges that make them, of
/// patches that leave the plane there without turning: pieces no farther from them than so much.
void run_along_edges(const ContactGeometry& geometry, double distance, FacetNode& facet);

}  // namespace taut
