#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "taut/bounds/curvature_nets.h"
#include "taut/bounds/scene_content.h"

namespace taut {

/// A rectangle of a patch's parameters.
struct ParameterRectangle {
  Interval u = {0, 1};
  Interval v = {0, 1};

  bool overlaps(const ParameterRectangle& other) const;
  bool contains(const ParameterRectangle& other) const;
  dvec2 middle() const { return {u.at(0.5), v.at(0.5)}; }
};

/// A patch with a tree of rectangles, each halved across its longer side, and of where it is curved
/// one way, which grows as it is asked.
class ConcavePatch {
 public:
  ConcavePatch(const SceneElement& element, const Patch& patch);

  const BezierPatch& bezier() const { return bezier_; }
  bool stand_in() const { return stand_in_; }
  const CurvatureNets& curvature_nets() const { return curvature_; }
  NetShape shape() const { return {bezier_.degree_u, bezier_.degree_v}; }

  /// Gaussian curvature at a point, zero where it is negligible; infinity at a pole and where it
  /// tells nothing.
  double curvature(const dvec2& p) const;

  /// @name Nodes of the tree, 0 its root
  /// @{
  const ParameterRectangle& cell(int node) const { return nodes_[std::size_t(node)].cell; }
  std::size_t node_count() const { return nodes_.size(); }
  int level(int node) const { return nodes_[std::size_t(node)].level; }
  /// One of the two halves.
  int child(int node, int k);
  /// Control points over the rectangle, without their weights.
  const std::vector<dvec3>& points(int node);
  /// Certain: there the surface is curved one way, downwards where m is up, with normals within a
  /// right angle of m. A stand-in is taken to be curved so.
  bool is_concave(int node, const dvec3& m);
  /// What a walk over the surface, by its number, has found there.
  struct Mark {
    long walk = 0;
    int found = 0;
  };
  Mark& mark(int node) { return nodes_[std::size_t(node)].mark; }
  /// @}

 private:
  struct Node {
    ParameterRectangle cell;
    int level = 0;
    int parent = -1;
    int first_child = -1;
    std::vector<dvec3> points;  ///< none until they are asked for
    bool known = false;
    double sign = 0;  ///< of the normals for which it is concave; 0: not known to be
    int depth = 0;    ///< of the tree below it that did not show it concave
    std::optional<NormalPyramid> pyramid;  ///< where the sign is known
    std::unique_ptr<CurvatureNets> nets;   ///< where it may be asked for
    Mark mark;
  };
  Node& at(int node) { return nodes_[std::size_t(node)]; }
  bool faces(int node, const dvec3& m);
  void look(int node);
  double sign(int node, int depth);
  Direction longer_side(int node);
  void halve(int node);

  BezierPatch bezier_;
  bool stand_in_;
  std::array<bool, 4> poles_;
  CurvatureNets curvature_;
  std::vector<Node> nodes_;
};

}  // namespace taut
