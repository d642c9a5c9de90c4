#pragma once

#include <array>
#include <vector>

#include "taut/bounds/normal_net.h"
#include "taut/bounds/patch_cell.h"
#include "taut/bounds/scene_content.h"

namespace taut {

/// Control points (homogeneous, of a SceneElement) and normal vectors of a cell of a patch.
struct CellNets {
  std::vector<dvec4> points;
  std::vector<dvec3> normals;
};

/// A patch's nets, from which those of its cells and their normal bounds are computed.
class PatchNets {
 public:
  /// @pre the element is a face's patch, and outlives it
  explicit PatchNets(const SceneElement& element);

  NetShape shape() const { return element_->shape; }
  bool rational() const { return element_->rational; }
  const CellNets& root() const { return root_; }
  /// The patch is made of straight segments that end on its border (Patch), or is a curve or a
  /// point. No point inside is extreme: it touches a supporting plane only together with the ends
  /// of a ruling.
  bool ruled() const { return ruled_; }

  /// The patch's control points over a rectangle of its unit square.
  std::vector<dvec4> points(const Interval& u, const Interval& v) const;
  /// The patch's normal vectors over the rectangle, by subdivision of its net.
  std::vector<dvec3> normals(const Interval& u, const Interval& v) const;
  void quarter_points(const std::vector<dvec4>& points, std::array<CellNets, 4>& quarters) const;
  void quarter_normals(const std::vector<dvec3>& normals, std::array<CellNets, 4>& quarters) const;

  NormalBounds bounds(const CellNets& cell, int level) const;
  /// Of a control point of a cell, in the scene's units times the weight; up to 40 levels.
  double point_rounding() const { return point_rounding_; }

 private:
  const SceneElement* element_;
  NetShape normal_shape_;
  CellNets root_;
  double normal_rounding_ = 0;
  double normal_size_ = 0;
  double point_rounding_ = 0;
  bool ruled_ = false;
};

}  // namespace taut
