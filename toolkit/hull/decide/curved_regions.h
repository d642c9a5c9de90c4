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

  /// Directions no farther from an axis, of length one, than an angle in radians.
  struct Cone {
    dvec3 axis = dvec3(0.0);
    double angle = 0;
  };
  /// That holds a cell with such corners.
  static Cone cone_of(const std::array<dvec3, 4>& directions);

  /// Certain: all over the rectangle, but for places at which no normal is one of the directions or
  /// opposite to one, the principal curvatures have one sign, the same everywhere, not zero; at
  /// poles of the patch too. @pre the element is a patch
  bool are_definite(int element, const Interval& u, const Interval& v, const Cone& directions);

  /// Certain: all over the rectangle, where a normal is one of the directions, the surface bends
  /// away from it, or towards it with a curvature of at most `most`. Only of patches without
  /// weights and poles. @pre the element is a patch
  bool are_nearly_concave(int element, const Interval& u, const Interval& v, const Cone& directions,
                          double most);

 private:
  struct Node {
    Interval u, v;
    int level = 0;
    /// What is told when it is first asked: of its normals, the sign of its curvatures, and bounds
    /// of them against the normals and along them.
    std::optional<CurvatureNets::NormalBounds> normals;
    std::optional<int> sign;
    std::array<std::optional<double>, 2> hollow;
    int first_half = -1;
    std::unique_ptr<CurvatureNets> nets;  ///< none where they are no longer needed
  };
  using Tree = std::vector<Node>;
  Tree& tree(int element);
  bool are_definite(int element, int node, const Interval& u, const Interval& v,
                    const Cone& directions, int& of_all);
  bool is_apart(int element, Node& node, const Cone& directions) const;
  bool is_nearly_concave(int element, int node, const Interval& u, const Interval& v,
                         const Cone& directions, double most);
  static bool is_small_part(const Node& node, const Interval& u, const Interval& v);
  bool has_pole(int element) const;
  std::unique_ptr<CurvatureNets> nets_of(int element) const;
  std::unique_ptr<CurvatureNets> nets_again(int element, const Node& node) const;
  static Direction direction_of_halves(const Interval& u, const Interval& v);
  const CurvatureNets& nets(int element, Node& node) const;
  const CurvatureNets::NormalBounds& normals(int element, Node& node) const;
  int sign(int element, Node& node) const;
  double hollow(int element, Node& node, int towards) const;
  double least_stretch(int element, const Interval& u, const Interval& v) const;
  bool split(int element, int node);

  const MapPieces& pieces_;
  std::vector<Tree> trees_;  // by element
};

}  // namespace taut
