#pragma once

#include <optional>
#include <vector>

#include "taut/hull/solve/free_ends.h"

namespace taut {

/// @name Free ends at known places
/// Where a root of the derivatives was found, whether the contacts of a separating curve merge
/// there, as far as the elements about it tell. Roots may lie beyond the ends of elements by
/// rounding. Whether an end supports the model is not asked.
/// @{

/// In a patch, where it has a cusp of Gauss.
std::optional<FreeEnd> cusp_end(const ContactGeometry& geometry, const Contact& root);

/// On a side of a patch, where the parabolic curve meets it: B3, or on a smooth join an end that
/// the jump of derivatives makes. A level departure is that of a cusp just there, or of a whole
/// circle of flat points, which is none.
std::optional<FreeEnd> border_end(const ContactGeometry& geometry, const Contact& patch, Side side,
                                  double t);

/// On an edge's piece, where its torsion vanishes; n is the binormal times the sign.
std::optional<FreeEnd> edge_end(const ContactGeometry& geometry, Contact c, double t, double sign);

/// At the end of a piece, in its osculating plane: B3 at a vertex, or where pieces join an end that
/// the jump of derivatives makes.
std::optional<FreeEnd> piece_end(const ContactGeometry& geometry, Contact c, int end, double sign);

/// At a vertex, between any two of its edges.
std::vector<FreeEnd> corner_ends(const ContactGeometry& geometry, const Contact& vertex);
/// @}

/// How far the contact is from the side of its patch, in parameters.
double distance_from(const Contact& c, Side side);

}  // namespace taut
