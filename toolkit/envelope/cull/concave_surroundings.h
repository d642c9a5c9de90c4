#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "taut/bounds/patch_cell.h"
#include "taut/bounds/reach_test.h"
#include "taut/bounds/scene.h"
#include "taut/core/stop.h"
#include "taut/envelope/cull/convex_cap.h"

namespace taut {

/// Proves that cells of patches touch the hull, with what surrounds them, on other patches too:
/// over smooth joins and around poles.
///
/// A cell lies on a ConvexCap, all of which is below the cell's tangent planes. If a point of the
/// cap is above all else of the model, in the directions of the cell's normals, each point of the
/// cell supports its normal, alone. Caps are sought about a cell, as large as they can be proven,
/// and serve the cells after it that lie well inside of them.
///
/// Holds what it learns of patches; use one object a thread. The scene must outlive it.
class ConcaveSurroundings {
 public:
  /// `stop`: makes what follows throw Cancelled.
  explicit ConcaveSurroundings(const Scene& scene, Stop stop = {});

  /// True is certain. `pyramid`: of the cell's normals Su x Sv, `sign` times which are outward.
  /// Whether the proof is found depends on the cells before.
  bool surely_on(int instance, int patch, const PatchCell& cell, const NormalPyramid& pyramid,
                 double sign);

  /// What follows does not depend on what was before.
  void begin_anew();

 private:
  struct Subject;
  enum class Answer { on, none, hopeless };

  void forget_some();
  Answer ask_known(const Subject& cell);
  bool look_about(const Subject& cell);
  void keep(int part, ConvexCap cap);
  bool is_above_others(const Subject& cell, const ConvexCap& cap);

  const Scene& scene_;
  ReachTest reach_;
  ConcaveSurfaces surfaces_;
  long cells_ = 0;
  std::vector<ConvexCap> caps_;
  std::size_t pieces_ = 0;                                     // of the caps
  std::map<std::pair<int, int>, std::vector<int>> caps_over_;  // by part and patch
};

}  // namespace taut
