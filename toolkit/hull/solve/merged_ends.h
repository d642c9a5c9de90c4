#pragma once

#include <optional>

#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/solve/ruling_search.h"

namespace taut {

/// Contacts so near to each other, in the scene's frame, that keep approaching merge. The smallest
/// singular value of the system of two contacts falls with the third power of their distance; here
/// rounding moves them by about 1e-8 yet. What the hull bridges over a shorter distance deviates
/// from the surface by less than the fourth power of it.
inline constexpr double merge_distance = 4e-3;
/// The same, or more where rounding is so large that heights tie over more: about a free end they
/// differ by the fourth power of distances.
double merging_distance(const ContactGeometry& geometry);

/// Shorter rulings before an end in which contacts of one surface or curve merge are not solved
/// for: rounding moves their contacts by its unit over the third power of the length, more than
/// they miss by approaching each other evenly, the length's square. The fifth root of the unit.
inline constexpr double shortest_solved = 6e-4;

/// The ruling of length zero that lies ahead of one whose contacts approach each other: in a free
/// end, at full precision where it is of a generic kind, else extrapolated; in a pole about which
/// planes touch twice; or where two surfaces or curves touch. None if they do not merge there, or
/// if it is farther below the supporting plane than the map's resolution.
std::optional<Ruling> merged_ruling(const RulingSearch& search, const Ruling& last);

}  // namespace taut
