#pragma once

#include <memory>
#include <vector>

#include "taut/bounds/gauss_map.h"
#include "taut/core/stop.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// How finely a scene is culled.
struct CullingOptions {
  /// Finest level of the patches' quadtrees. Levels that the Gauss map does not hold are computed
  /// on the way. 0 .. 20
  int levels = 3;
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
};

/// The finest level at which so many patches have no more than 16384 cells in all; at most 3.
int culling_levels(long patches);

/// What is known of a cell of a patch as the place where supporting planes touch the model.
enum class CellState {
  off,    ///< proven: none touches it
  on,     ///< proven: at every point of it one does, and nowhere else
  ruled,  ///< its patch is ruled (PatchNets): no point inside is extreme
  mixed,  ///< neither is proven
};

/// A cell of the final subdivision.
struct CulledCell {
  int instance = -1;                   ///< of the scene
  int patch = -1;                      ///< of the instance's part
  PatchCell cell;                      ///< of the patch
  CellState state = CellState::mixed;  ///< what is known of it
  /// mixed: with which of its normals it may touch; on: with which it does.
  ContactSigns signs;
  /// Certain: both principal curvatures have one sign all over it, its border included, not zero.
  bool definite = false;
};

/// What happened to the cells of one level.
struct CullingLevel {
  long visited = 0;           ///< cells looked at
  long off_by_samples = 0;    ///< some sampled point is above all their possible tangent planes
  long off_by_curvature = 0;  ///< saddles, or curved the wrong way where samples left one sign
  long on = 0;                ///< cells that are on
  long ruled = 0;             ///< cells of ruled patches
  long kept = 0;              ///< mixed: refined, or at the finest level
  double removed_share = 0;   ///< of all patches' parameter area, off at this level or above
  double decided_share = 0;   ///< of the same area, off, on or ruled
};

/// What of a scene can touch supporting planes, and what is proven not to.
struct Culling {
  /// Points of the model on its hull, with their directions: those of some uniformly spread
  /// directions first (curves and points are among them), then those of the cells' axes and the
  /// middles of cells that are on.
  std::vector<Sample> samples;
  std::vector<dvec3> frame_points;   ///< per sample, in the scene's frame
  std::vector<CulledCell> cells;     ///< cover every patch of every distinct instance once
  std::vector<CullingLevel> levels;  ///< coarse to fine
  long support_queries = 0;          ///< that it took

  /// Cells visited on all levels, and cells left mixed at the end.
  long visited() const;
  /// Cells left mixed at the end.
  long mixed() const;
  /// At the finest level (CullingLevel).
  double removed_share() const { return levels.empty() ? 0 : levels.back().removed_share; }
};

/// Decides, coarse to fine, which cells of a scene's patches touch its convex hull; samples the
/// hull on the way.
///
/// A cell is off for one of its two normals n if the highest of its control points is lower than
/// one sampled point of the model in all directions of its normal pyramid: then no tangent plane of
/// it supports the model. The samples are the support points of the pyramid's axis, of its
/// parent's, and of the nearest of the spread directions. A cell is off, too, where curvature alone
/// forbids it.
///
/// A cell X is on if, for the normals n in its pyramid, the second derivatives of S . n are
/// negative definite over a rectangle R around X (the whole patch where possible), and a point p
/// of R is above all of the model outside R in these directions. For then at x in X with its normal
/// n, S . n is concave over R with its only maximum at x, so that x . n >= p . n > y . n for every
/// y outside R: x alone supports n, and the Gauss map is injective on X. Cells next to a border
/// between patches, or to a pole, and those that no such rectangle shows to be on, are proven with
/// what surrounds them (ConcaveSurroundings), but for those of the finest level.
///
/// Both are proofs: deviations and rounding included, up to the rounding of the stored model (the
/// normals at a collapsed side within rounding of it are those of its limit). They speak of
/// contacts of surfaces, that is, planes tangent to the patch; those at borders that are edges, and
/// at vertices, belong to the edges and vertices, and a cell that is off may have such a border.
///
/// Same result for any number of threads.
/// @pre the map is the scene's @throws InvalidInput for levels out of range, Cancelled
Culling cull(const Scene& scene, const GaussMap& map, const CullingOptions& options = {});

}  // namespace taut
