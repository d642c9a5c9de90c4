#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "taut/bounds/patch_cell.h"
#include "taut/bounds/reach_test.h"
#include "taut/bounds/scene.h"

namespace taut {

/// Proves that cells of patches touch the hull, with what surrounds them on other patches too: over
/// smooth joins and around poles.
///
/// Rectangles of patches about the cell, joined side to side, are curved one way, with all normals
/// within a right angle of the cell's axis m. Each lies over the plane normal to m without a fold,
/// and so, in an abstract copy, do all of them joined, but for their outline. Over a convex region
/// of that plane that does not meet the outline, what is joined to the cell is therefore the graph
/// of one function, of class C1 and piecewise of negative second derivatives: a concave one. There
/// every tangent plane is above all of the graph. If the rectangles next to the cell lie over the
/// region, and a point of them is above all of the model beyond them, in the directions of the
/// cell's normals, each point of the cell supports its normal, alone.
///
/// Joins that are declared smooth (FacePatch) are taken to be so: what they miss is within the
/// model's deviation bound. In corners that are no vertices, and at poles, the angles of the
/// patches are taken to sum to a full turn.
///
/// Holds what it learns of patches; use one object a thread. The scene must outlive it.
class ConcaveSurroundings {
 public:
  explicit ConcaveSurroundings(const Scene& scene);
  ~ConcaveSurroundings();

  /// True is certain. `pyramid`: of the cell's normals Su x Sv, `sign` times which are outward.
  bool surely_on(int instance, int patch, const PatchCell& cell, const NormalPyramid& pyramid,
                 double sign);

 private:
  class Surface;
  class Neighborhood;
  struct Rectangle;

  const Scene& scene_;
  ReachTest reach_;
  std::map<std::pair<int, int>, std::unique_ptr<Surface>> surfaces_;  // by part and patch
};

}  // namespace taut
