#pragma once

#include <vector>

#include "taut/surface/model.h"

namespace taut {

/// The patches' corners: points of their surfaces.
std::vector<dvec3> corner_points(const std::vector<Patch>& patches);

/// Splits patches along the crests inside of them whose planes may support the patches' surfaces,
/// exactly, so that these crests lie on borders alone.
///
/// A face is split along a whole row of its grid of patches, and so are those of other faces
/// that a row ends at, as far as the row goes on: every side still meets whole ones. A crest from
/// which the rows would wind without end, or that would leave strips as thin as what counts as one
/// point, stays where it is.
/// Faces of cages with more than one patch are not split.
/// `bent`: see join_tolerance. `grid`: what the numbers were rounded by before.
/// @pre the patches of all other faces are grids, v within u; rulings are found. The box contains
/// them. @throws Cancelled, as the next one does
void split_crests(std::vector<Face>& faces, std::vector<Patch>& patches, const Box& box,
                  double bent, double grid, const Progress& progress);

/// Splits patches, rows as above, where sides of others end inside of theirs and run along them, so
/// that whole sides meet; but for sides that are straight, along which no point is extreme. Sides
/// that run along each other at different parameters are left as they are. Cuts that always meet
/// further sides, as around a closed face, are not made at all.
/// @pre as above
void split_junctions(std::vector<Face>& faces, std::vector<Patch>& patches, const Box& box,
                     double bent, const Progress& progress);

}  // namespace taut
