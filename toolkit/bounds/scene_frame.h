#pragma once

#include "taut/core/geometry.h"

namespace taut {

/// How the model's coordinates relate to the scene's frame: x_frame = (x - center) * scale.
/// The scale is a power of two, so scaling is exact.
struct SceneFrame {
  dvec3 center = dvec3(0.0);  ///< in model coordinates
  double scale = 1;           ///< a power of two

  /// The place in the frame of a point in model coordinates.
  dvec3 to_frame(const dvec3& x) const { return (x - center) * scale; }
  /// The place in model coordinates of a point in the frame.
  dvec3 to_model(const dvec3& x) const { return x / scale + center; }
  /// In model units, of a length in the frame.
  double length_to_model(double length) const { return length / scale; }
  /// In the frame, of a length in model units.
  double length_to_frame(double length) const { return length * scale; }
};

/// The frame of a scene whose model has this control box (Model::control_box).
SceneFrame scene_frame(const Box& control_box);

}  // namespace taut
