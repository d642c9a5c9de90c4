#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <vector>

#include "taut/surface/control_cage.h"

namespace taut_test {

using taut::ControlCage;
using taut::dvec3;

/// The cage as OpenSubdiv has it.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_of(const ControlCage& cage);

/// A limit point of a uniformly refined cage, by OpenSubdiv's limit masks.
struct LimitPoint {
  dvec3 x;
  dvec3 normal;  ///< unit; zero where there is none
};

/// A level of uniform refinement: all of it, or some faces and what touches them.
class RefinedCage {
 public:
  RefinedCage(const ControlCage& cage, int levels);

  /// The next level of some faces of the level, which need to be among faces(). Their children have
  /// the limit surface that they have in the whole cage.
  ///
  /// @pre levels >= 2 and has_simple_edges(): two edges between the same vertices, as faces with a
  /// vertex twice have in their first level, cannot be told apart
  RefinedCage refined(const std::vector<int>& faces) const;

  OpenSubdiv::Far::TopologyLevel level() const { return refiner_->GetLevel(level_); }
  /// Faces of the level with the limit surface of the cage; no holes.
  const std::vector<int>& faces() const { return faces_; }
  /// By vertex of the level. Those of vertices of faces() are right.
  const std::vector<dvec3>& points() const { return points_; }
  /// No two edges of the level have the same ends.
  bool has_simple_edges() const;
  /// The limit mask holds at a vertex: nothing about it is semi-sharp, nor does a sharp crease end
  /// there, at which OpenSubdiv has the mask of a smooth vertex, nor is it a smooth one between two
  /// faces of a Catmull-Clark surface, at which OpenSubdiv has that of a corner.
  bool has_limit(int vertex) const;
  /// By vertex of the level.
  std::vector<LimitPoint> limits() const;

 private:
  ControlCage cut(const std::vector<int>& faces) const;

  std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
  int level_ = 0;
  ControlCage rules_;  // its scheme and rules, no faces
  std::vector<dvec3> points_;
  std::vector<int> faces_;
};

/// Those of all vertices that are faces' corners, after so many levels of uniform refinement.
std::vector<LimitPoint> limit_points(const ControlCage& cage, int levels);

}  // namespace taut_test
