#pragma once

#include <vector>

#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// Points nearer than this are one: join_distance of the box's diagonal, or what rounding may have
/// bent borders by if that is more.
double join_tolerance(const Box& box, double bent = 0);

/// One side of a patch; sides are numbered 4 * patch + side.
struct SideCurve {
  BezierCurve curve;
  bool collapsed = false;  ///< all control points coincide within the tolerance
};

/// A side that takes part in a join.
struct Use {
  int side = 0;
  bool reversed = false;  ///< relative to the first use
  double gap = 0;         ///< from the first use's curve, at worst
};

/// A curve in which sides meet, or a single one ends; uses are in ascending order of the sides.
using Join = std::vector<Use>;

/// The sides of all patches, by number.
std::vector<SideCurve> side_curves(const std::vector<Patch>& patches, double tolerance);

/// The joins of all sides that do not collapse, in ascending order of their first sides; sides of
/// patches that repeat another one take no part.
///
/// Two sides meet if their curves agree, parameter by parameter in either direction, within the
/// tolerance. Takes time linear in the number of sides, unless very many crowd in one place.
/// @pre the box contains the patches @throws Cancelled
std::vector<Join> match_sides(const std::vector<Patch>& patches,
                              const std::vector<SideCurve>& sides, const Box& box, double tolerance,
                              const Progress& progress);

/// How far joined sides are apart at worst, and how large sides are that collapse.
double largest_gap(const std::vector<SideCurve>& sides, const std::vector<Join>& joins);

/// Chebyshev parameter k of 0 .. m on [0, 1]: a polynomial of degree m is at most O(log m) times as
/// large between them as at them.
double sample_parameter(int k, int m);

}  // namespace taut
