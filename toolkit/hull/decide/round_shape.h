#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "taut/bounds/contact.h"
#include "taut/bounds/scalar_net.h"

namespace taut {

/// An ellipse or an ellipsoid that elements cover together, whatever their parameters and seams.
///
/// It is center + root x for all x of length one, the root symmetric; the ellipse's is flat.
struct RoundShape {
  SourceKind kind = SourceKind::face;  ///< face: an ellipsoid; edge: an ellipse
  std::vector<int> elements;
  dvec3 center = dvec3(0.0);
  dmat3 root = dmat3(0.0);
  /// Axes of the shape, unit, and half their lengths; 0 the third of an ellipse.
  dmat3 axes = dmat3(1.0);
  dvec3 radii = dvec3(0.0);
  /// The shape lies in the convex hull of the elements but for this distance.
  double inside = 0;
  /// The elements lie in what the shape encloses but for this distance.
  double outside = 0;

  bool is_flat() const { return kind == SourceKind::edge; }
  double greatest_radius() const { return std::max({radii.x, radii.y, radii.z}); }
  double least_radius() const {
    return is_flat() ? std::min(radii.x, radii.y) : std::min({radii.x, radii.y, radii.z});
  }
  /// Homogeneous points where the shape is the unit sphere, or the unit circle across the third
  /// axis, along which lengths stay.
  std::vector<dvec4> in_frame(std::span<const dvec4> net) const;
  /// Upper bounds of the distance of what has these control points from the shape: inwards, and
  /// outwards from what it encloses. Rounding in the model's own coordinates apart.
  struct Distances {
    double inwards = 0, outwards = 0;
  };
  Distances distances(NetShape net, std::span<const dvec4> points) const;
  /// Certain: the point is farther than that from what the shape encloses.
  bool surely_misses(const dvec3& point, double distance) const;
  /// Certain: planes across all directions between these touch it in one point each.
  bool is_touched_once(const std::array<dvec3, 4>& directions) const;
};

/// The mean of some shapes, with centers and roots that are means of theirs: it lies in the convex
/// hull of the elements of all of them, as |sum root n| is at most the sum of |root n|.
/// @pre as many weights, with a sum of one
RoundShape mean_of(std::span<const RoundShape* const> shapes, std::span<const double> weights);

}  // namespace taut
