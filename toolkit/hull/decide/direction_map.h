#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/core/progress.h"
#include "taut/hull/decide/map_cell.h"

namespace taut {

/// What a map of directions took.
struct DirectionMapStatistics {
  long cells = 0;                                 ///< decided or split
  long candidates = 0;                            ///< pieces of the model that were looked at
  long queries = 0;                               ///< support queries
  std::array<long, map_cell_kinds> of_kind = {};  ///< cells that are not split, by MapCellKind
  int deepest = 0;                                ///< level of a cell
};

/// The upper envelope of support functions over the sphere of directions, cell by cell: which parts
/// of a model touch the supporting planes with normals there.
struct DirectionMap {
  /// The cells that are not split, which cover the sphere; by face, and along a Z-shaped curve.
  std::vector<MapCell> cells;
  DirectionMapStatistics statistics;  ///< what it took
  double resolution = 0;              ///< at which it is decided, in the scene's frame
  /// Patches, with their borders, that are in the convex hull of the rest to within the resolution.
  std::vector<Contact> covered;
  /// Edges' pieces that are, though lines of a ruled patch go on from there to others that are not.
  std::vector<Contact> covered_edges;
  /// By how much ruled patches that are bent may be above the ends of their lines.
  double bent = 0;

  /// Two contacts no farther from each other than this may be one, though a cell tells them apart:
  /// on a surface that curves as much as the scene, of size one, is large, heights of one contact
  /// differ over so much by no more than the resolution.
  double contact_extent() const { return std::sqrt(resolution); }

  /// Directions of the corners of a cell in the order (0, 0), (0, 1), (1, 0), (1, 1) of its axes,
  /// on a cube that is turned so that what models are symmetric in is nothing to it.
  static std::array<dvec3, 4> corners(const MapCell& cell);
  /// A point of a face of the cube, with coordinates in [-1, 1].
  static dvec3 direction(int face, double s, double t);
  /// Where a direction meets the cube.
  struct Place {
    int face = 0;  ///< of the cube, 0 .. 5
    double s = 0;  ///< in [-1, 1]
    double t = 0;  ///< in [-1, 1]
  };
  /// @pre d is not zero
  static Place place(const dvec3& d);
};

/// When a map of directions is good enough.
struct DirectionMapOptions {
  /// In the scene's frame: what is nearer than this may be taken for one. > 0
  double resolution = 0;
  /// Levels of cells, cells, and pieces of the model looked at in them, after which what is left
  /// stays undecided.
  int level_limit = 30;                  ///< at most 30
  long cell_limit = 1'000'000;           ///< see level_limit
  long candidate_limit = 1'000'000'000;  ///< see level_limit
  int threads = 0;                       ///< 0: as many as the machine has
  Stop stop;                             ///< makes it throw Cancelled
  /// Called now and then with the share that is done, which never falls; by the thread that calls
  /// the operation.
  std::function<void(double share)> report = {};
};

/// Splits cells, level by level, until each is decided or a limit is reached.
///
/// A cell keeps the pieces of the model that may touch a plane with a normal in it: of patches
/// those where the heights x . d grow in no one direction for all d of the cell, of edges those
/// from which no surface rises, and none that are below the convex hull of sampled points
/// (BeaconEnvelope). Pieces that hang together are a branch; a branch has one contact for each
/// direction by the index of the gradient of the heights, or where they are concave but for the
/// resolution (ContactIndex, NearConcavity). Branches for which others stand to within the
/// resolution are left out (BranchDomination). All bounds are of Bernstein coefficients, for all
/// directions of the cell at once, rounding included.
///
/// Ruled patches and straight edges have no contacts but at their ends. The same bits for any
/// number of threads.
/// @throws Cancelled
DirectionMap direction_map(const ContactGeometry& geometry, const DirectionMapOptions& options);

}  // namespace taut
