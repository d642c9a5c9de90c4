#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "taut/bounds/curvature_nets.h"
#include "taut/hull/decide/pieces.h"

namespace taut {

/// Where patches are curved one way, by the second fundamental form: told once, for all directions.
/// Trees of rectangles that grow as they are asked. One object a thread; the pieces must outlive
/// it.
class CurvedRegions {
 public:
  explicit CurvedRegions(const MapPieces& pieces);

  /// Certain: all over the rectangle the principal curvatures have one sign, the same everywhere,
  /// not zero; at poles of the patch too. @pre the element is a patch
  bool are_definite(int element, const Interval& u, const Interval& v);

 private:
  struct Node {
    Interval u, v;
    int level = 0;
    bool known = false;
    int sign = 0;
    int first_half = -1;
    std::unique_ptr<CurvatureNets> nets;
  };
  using Tree = std::vector<Node>;
  Tree& tree(int element);
  int sign(Tree& tree, int node, const Interval& u, const Interval& v);

  const MapPieces& pieces_;
  std::vector<Tree> trees_;  // by element
};

}  // namespace taut
