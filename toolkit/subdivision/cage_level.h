#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/core/progress.h"
#include "taut/subdivision/edge_middles.h"
#include "taut/surface/bezier.h"
#include "taut/surface/control_cage.h"

namespace taut {

/// A face of a level of refinement that is to have a surface.
struct CageCell {
  int face = 0;       ///< of the level
  int cage_face = 0;  ///< the face of the control cage that it is part of
  int region = -1;    ///< free for the caller; refined cells have that of their parent
};

/// The surface of a cell.
struct CellPatch {
  enum class Kind {
    /// A face of the control cage that is no quad (of a Loop cage: no triangle), or one at a dart
    /// or at an inner vertex of two faces; of a Loop cage, of three, too.
    none,
    regular,  ///< exactly the limit surface
    /// Stands for it, polynomial too: its corners are the limit's, and so are its borders to
    /// regular cells, with the tangent planes there, and on creases (crease()).
    cap,
  };
  Kind kind = Kind::none;
  /// The cell is semi-sharp, or meets what is in a vertex.
  bool semi_sharp = false;
  /// Catmull-Clark: a bicubic net, 16 points along v within along u. Loop: 15 points of a quartic
  /// triangle, (i, j) counts towards the second and third corner: (0,0) .. (4,0), (0,1) .. (3,1),
  /// .. (0,4).
  std::vector<dvec3> points;
  int degree = 3;
  /// Of the sides from each corner to the next: the surface goes on smoothly there. Not told of
  /// more than four.
  std::array<bool, 4> smooth = {};
};

/// One level of a control cage's refinement, or the part of it that matters: cells and all faces
/// that touch them, so that the cells' limit surface is that of the whole cage.
///
/// Refinement, tags and patches are OpenSubdiv's (Far, in double precision). Cells of a cage with
/// infinitely sharp edges, boundaries and corners are regular where OpenSubdiv has exact patches;
/// those near semi-sharp ones are not until these have become smooth.
class CageLevel {
 public:
  /// The control cage itself: its faces but the holes, and those without surface at its boundary.
  /// @throws BackendError if OpenSubdiv does not take the cage; InvalidInput where it has no limit
  /// surface: at an inner vertex of two faces with one infinitely sharp edge
  explicit CageLevel(const ControlCage& cage);
  ~CageLevel();
  CageLevel(CageLevel&&) noexcept;
  CageLevel& operator=(CageLevel&&) noexcept;

  std::vector<CageCell>& cells() { return cells_; }
  const std::vector<CageCell>& cells() const { return cells_; }

  /// The patches of all cells. @throws Cancelled
  std::vector<CellPatch> patches(const Progress& progress) const;

  /// The control points of cells, each once: the convex hull of them contains their limit surface.
  std::vector<dvec3> enclosure(std::span<const std::size_t> cells) const;
  /// The vertices of a cell in their order, numbers of this level.
  std::span<const int> vertices(std::size_t cell) const;
  /// The cell beyond the side from a corner to the next. None where there is no cell, or more than
  /// one.
  std::optional<std::size_t> across(std::size_t cell, std::size_t side) const;
  /// The limit of a sharp side of a cell, from a corner to the next, as a cubic Bezier curve. None
  /// of a smooth one, and of one that at one of its ends is a dart or near semi-sharp ones.
  std::optional<std::array<dvec3, 4>> crease(std::size_t cell, std::size_t side) const;
  /// An inner vertex that is infinitely sharp, at which one edge at most is: its limit is its
  /// control point, in which the surface around comes to a point, with no tangent plane.
  bool is_apex(int vertex) const;
  /// A vertex's control point.
  const dvec3& point(int vertex) const;
  /// The number of a vertex of a cell over all levels; the control cage's have their own.
  int number(int vertex) const;

  /// The next level of some cells, in their order, each's children in theirs. Their edges' middles
  /// are added.
  CageLevel refined(std::span<const std::size_t> cells, EdgeMiddles& middles) const;

  /// Of the control cage, what OpenSubdiv treats by rules of its own, as infinitely sharp: edges
  /// with more than two faces, or two that run alike, or both ends in one vertex; and vertices
  /// about which faces are no fan. The sheets of faces that meet there are parted.
  long non_manifold_edges() const { return non_manifold_edges_; }
  long non_manifold_vertices() const { return non_manifold_vertices_; }

 private:
  struct Topology;
  CageLevel();
  void count_non_manifold();

  long non_manifold_edges_ = 0;
  long non_manifold_vertices_ = 0;
  std::unique_ptr<Topology> topology_;
  std::vector<CageCell> cells_;
};

}  // namespace taut
