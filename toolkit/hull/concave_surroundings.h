#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "taut/bounds/patch_cell.h"
#include "taut/bounds/reach_test.h"
#include "taut/bounds/scene.h"

namespace taut {

class ConcavePatch;
struct ParameterRectangle;

/// Proves that cells of patches touch the hull, with what surrounds them, on other patches too:
/// over smooth joins and around poles.
///
/// Let m be the cell's axis, D a disc in the plane normal to it about the cell, as seen along m, in
/// coordinates in which the surface falls off evenly in all directions. Walk from the cell as far
/// as the surface lies over D. Where the surface is curved one way all along, with all normals
/// within a right angle of m, and has no edge over D, it lies over D without a fold or an end: D
/// being simply connected, what is joined to the cell is the graph of one function over D, of class
/// C1 and piecewise of negative second derivatives, a concave one. Every tangent plane is above all
/// of the graph. If a point of the graph is above all else of the model, in the directions of the
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
  class Walk;

  ConcavePatch& surface(int part, int patch);
  void forget_some();
  bool is_above_others(int instance, int patch, const ParameterRectangle& cell,
                       const std::array<dvec3, 4>& corners,
                       const std::vector<std::pair<int, ParameterRectangle>>& pieces);

  const Scene& scene_;
  ReachTest reach_;
  long walks_ = 0;
  long cells_ = 0;
  std::map<std::pair<int, int>, std::unique_ptr<ConcavePatch>> surfaces_;  // by part and patch
};

}  // namespace taut
