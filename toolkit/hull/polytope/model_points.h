#pragma once

#include <span>
#include <vector>

#include "taut/surface/model.h"

namespace taut {

/// All points of a polyhedral model, placed by its instances and numbered through, multiplied so
/// that no arithmetic leaves the range of doubles where that is exact. The model must outlive it.
class ModelPoints {
 public:
  explicit ModelPoints(const Model& model);

  std::span<const dvec3> points() const { return points_; }
  /// A power of two that the points were multiplied by: one for all usual sizes, and where some are
  /// so much smaller than others that they would be rounded.
  double scale() const { return scale_; }
  /// By what the points must be multiplied yet, rounding some, before products are taken; else one.
  double product_scale() const { return product_scale_; }
  /// Of the points' box, and the sum of their largest coordinates' sizes; scaled as they are.
  double diagonal() const { return diagonal_; }
  double reach() const { return reach_; }
  /// How far the points may lie from the instances' true ones; scaled.
  double placement_bound() const { return placement_bound_; }

  /// The source of the point of this number.
  int source(int point) const { return model_.source_id(place_of(point)); }
  /// The point as it stands in the model, not multiplied.
  dvec3 model_point(int point) const;

  /// Calls visit with the source and the corners, by number of points, of every polygon.
  template <class Visit>
  void for_each_polygon(Visit visit) const {
    std::vector<int> corners;
    for (int i = 0; i < int(model_.instances().size()); ++i) {
      const Part& part = part_of(model_.instances()[std::size_t(i)]);
      for (int k = 0; k < int(part.polygons().size()); ++k) {
        corners = part.polygons()[std::size_t(k)];
        for (int& c : corners) c += first_[std::size_t(i)];
        visit(model_.source_id({SourceKind::face, i, k}), corners);
      }
    }
  }

 private:
  const Part& part_of(const Instance& instance) const {
    return model_.parts()[std::size_t(instance.part)];
  }
  /// False if scaling has rounded a point.
  bool place();
  Source place_of(int point) const;

  const Model& model_;
  std::vector<int> first_;  ///< per instance: the number of its first point
  std::vector<dvec3> moved_;
  std::span<const dvec3> points_;
  double scale_ = 1;
  double product_scale_ = 1;
  double diagonal_ = 0;
  double reach_ = 0;
  double placement_bound_ = 0;
};

}  // namespace taut
