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

  /// Certain: all over the rectangle, where a normal is one of the directions, the surface bends
  /// away from it, or towards it with a curvature of at most `hollow`. Only of patches without
  /// weights and poles. @pre the element is a patch
  bool are_nearly_concave(int element, const Interval& u, const Interval& v,
                          const std::array<dvec3, 4>& directions, double hollow);

 private:
  struct Node {
    Interval u, v;
    int level = 0;
    bool known = false;
    int sign = 0;
    /// Of its normals, and bounds of the curvatures against them and along them.
    CurvatureNets::NormalBounds normals;
    std::array<double, 2> hollow = {infinity, infinity};
    int first_half = -1;
    std::unique_ptr<CurvatureNets> nets;  ///< none where they are no longer needed
  };
  using Tree = std::vector<Node>;
  Tree& tree(int element);
  int sign(int element, int node, const Interval& u, const Interval& v);
  bool is_nearly_concave(int element, int node, const Interval& u, const Interval& v,
                         const std::array<dvec3, 4>& directions, double hollow);
  static bool is_small_part(const Node& node, const Interval& u, const Interval& v);
  bool has_pole(int element) const;
  std::unique_ptr<CurvatureNets> nets_of(int element) const;
  std::unique_ptr<CurvatureNets> nets_again(int element, const Node& node) const;
  static Direction direction_of_halves(const Interval& u, const Interval& v);
  void know(int element, Node& node) const;
  void know_hollows(int element, Node& node) const;
  double least_stretch(int element, const Interval& u, const Interval& v) const;
  bool split(int element, int node);

  const MapPieces& pieces_;
  std::vector<Tree> trees_;  // by element
};

}  // namespace taut
