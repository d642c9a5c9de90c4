#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/core/tolerances.h"
#include "taut/hull/polytope/affine_span.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// Support points from which the sampling of a scene starts, none twice.
struct SampledStart {
  std::vector<Sample> samples;      ///< directions and contacts
  std::vector<dvec3> points;        ///< per sample, in model coordinates
  std::vector<dvec3> frame_points;  ///< per sample, in the scene's frame
  /// What the scene spans, by the samples; what is thinner than tolerances.h tells, or than asked,
  /// is flat.
  AffineSpan span;
  /// Of a span of a plane: the middle between the heights x . span.normal that the scene reaches in
  /// the scene's frame, and half of how far these are apart if that is more than rounding.
  double middle = 0;
  double half_width = 0;  ///< see middle
};

/// Below which distances in the scene's frame mean nothing (tolerances.h).
double meaningful_width(const Scene& scene);

/// The support points of 26 directions: axes, and diagonals of faces and of space; and while they
/// lie in a plane or on a line, those of the directions across it. What reaches no farther across a
/// plane or a line than `width`, in the scene's frame, is flat too: samples of a plane are then the
/// model's points' feet on its middle.
SampledStart sampled_start(const Scene& scene, SupportQuery& query, double width = 0);

/// The place in model coordinates of a point of the scene, in its frame, as the samples have it.
dvec3 flat_point(const Scene& scene, const SampledStart& start, const dvec3& x);

/// Four of its samples that span space by more than the width, each the farthest above those before
/// in its own direction. @pre start.span.dimension == 3
SampledStart spanning(const SampledStart& start, double width);

/// How far rounding may move a support point out of the hull, in model units: half a unit in the
/// last place of each stored coordinate, and the evaluation in the frame.
double vertex_rounding(const Scene& scene);

/// Rounding of a gap in the scene's frame, where coordinates are at most about two.
inline constexpr double gap_rounding = 16 * rounding_unit;

/// Why a tolerance is not reached.
std::string vertex_limit_met(std::size_t vertices);
inline constexpr const char* tolerance_too_fine =
    "the tolerance is below what double precision can certify here";
inline constexpr const char* flat_within_more =
    "the model is flat within its resolution, which is more than the tolerance: a finer one tells";

/// The hull of a scene that spans less than space. `tolerance` in model units.
/// @pre start.span.dimension < 3 @throws HullNotConverged, Cancelled as sampled_hull()
Hull flat_sampled_hull(const Scene& scene, const HullOptions& options, double tolerance,
                       SampledStart start, SupportQuery& query);

}  // namespace taut
