#pragma once

#include "taut/surface/model.h"

namespace taut {

/// A face's patches, or an edge's pieces, as one B-spline over their intervals; decompose() gives
/// them back to the last bit (but for the signs of zeros). Knots between them have the multiplicity
/// degree where the control points on both sides agree, and degree + 1 where they do not.
/// @pre the pieces form a grid over intervals that adjoin, as those of add_surface() and
/// add_curve()
NurbsSurface joined_patches(const Part& part, const Face& face);
NurbsCurve joined_pieces(const Part& part, const Edge& edge);

}  // namespace taut
