#pragma once

namespace taut {

/// What the computation of a hull took.
struct HullStatistics {
  long support_queries = 0;    ///< asked
  long newton_iterations = 0;  ///< steps of Newton's method
  /// Cells of the map of directions, and those that are not decided; pieces of the model that were
  /// looked at in cells, and those that are left in them.
  long map_cells = 0;
  long map_undecided = 0;     ///< see map_cells
  long map_candidates = 0;    ///< see map_cells
  long map_contacts = 0;      ///< see map_cells
  double seconds_sample = 0;  ///< sampling
  double seconds_map = 0;     ///< deciding the map of directions
  double seconds_trace = 0;   ///< solving arcs and nodes
  double seconds_stitch = 0;  ///< stitching faces
  double seconds_mesh = 0;    ///< meshing

  /// Adds all counts and times; of cells the larger numbers stay.
  HullStatistics& operator+=(const HullStatistics& other);
};

}  // namespace taut
