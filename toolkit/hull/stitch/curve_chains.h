#pragma once

#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Ends of curves of the hull nearer than this, in the scene's frame, are one point, and those that
/// are nearer than the resolution; of rounded models, of which finer maps than that may be solved,
/// those that rounding makes miss each other.
inline constexpr double same_curve_end = 1e-8;
inline constexpr double rounded_curve_end = 1e-7;

/// A contact of a piece of an arc and, where several curves lie along it, their order.
struct ScrollContact {
  int arc, piece, contact;
  double order = 0;
};

/// A part of a curve of the hull, with what lies along it.
struct CurveElement {
  /// Numbers of the faces to its sides, seen from outside.
  int left = -1;
  int right = -1;
  int source = -1;
  std::vector<dvec3> points;   ///< two or more
  std::vector<int> stretches;  ///< numbers of the stretches (TrimStretches) along it
  /// The scrolls' contacts along it.
  std::vector<ScrollContact> contacts;
};

/// Elements that follow each other, head to tail.
struct CurveChain {
  std::vector<std::size_t> elements;  ///< their numbers
  bool closed = false;
};

/// Chains of the elements that have the same faces and source: every element in one of them, each
/// as long as it can be, but none over one of the corners. In the order of faces and source. Points
/// nearer than `distance` are one.
std::vector<CurveChain> chains(const std::vector<CurveElement>& elements,
                               const std::vector<dvec3>& corners = {},
                               double distance = same_curve_end);

/// The points along the whole chain; the first one again at the end of a closed one.
std::vector<dvec3> points_along(const CurveChain& chain, const std::vector<CurveElement>& elements);

}  // namespace taut
