#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/scalar_net.h"

namespace taut {

/// What of a model all but touches a plane: parts of patches that are not ruled, and of curves
/// that are not straight, which may hold contacts of their own. In the scene's frame.
class TopParts {
 public:
  explicit TopParts(const ContactGeometry& geometry);

  /// Two points are in one piece of what lies within `depth` of the supporting plane across d on
  /// which both are, or is told to be so for depths up to a fourth larger. False where that is
  /// too much to look at.
  bool hang_together(const dvec3& d, const dvec3& x, const dvec3& y, double depth) const;

 private:
  struct Part {
    NetShape shape;
    std::vector<dvec4> net;
    Box box;
  };
  bool find(const dvec3& d, double height, double depth, std::vector<Box>& found) const;

  std::vector<Part> parts_;
};

}  // namespace taut
