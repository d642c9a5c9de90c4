#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/hull/trace/curve_point.h"

namespace taut {

/// Contacts so near to each other, in the scene's frame, that keep approaching merge. The smallest
/// singular value of the system of two contacts falls with the third power of their distance; here
/// rounding moves them by about 1e-8 yet. What the hull bridges over a shorter distance deviates
/// from the surface by less than the fourth power of it.
inline constexpr double merge_distance = 4e-3;
/// The same, or more where rounding is so large that heights tie over more: about a free end they
/// differ by the fourth power of distances.
double merging_distance(const ContactGeometry& geometry);

/// Contacts nearer than this that do not merge are lost.
double least_distance_at(const CurvePoint& point);

/// How a separating curve ends whose two contacts run into each other.
struct MergedEnd {
  /// From the point on. Another one begins where a contact changes over into the element of the
  /// end.
  std::vector<ArcPiece> pieces;
  /// Where two surfaces or curves meet; else a free end or a pole.
  std::vector<Contact> contacts;
  dvec3 n = dvec3(0.0);
};

/// The end that lies ahead of two contacts that approach each other, if they merge and the rulings
/// on the way there are found: in a free end, at full precision where it is of a generic kind, else
/// extrapolated; in a pole about which planes touch twice; or where two surfaces or curves touch.
std::optional<MergedEnd> merged_end(const CurvePoint& point);

/// The direction in which two contacts merge at a common point: a face's normal; across the
/// tangents of two edges; of an edge and its end, across the edge's osculating plane. `near` tells
/// the sense, and the direction where these are none.
dvec3 limit_normal(const std::array<ContactJet, 2>& jet, const dvec3& near);

}  // namespace taut
