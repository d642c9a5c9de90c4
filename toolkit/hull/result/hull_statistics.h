#pragma once

namespace taut {

/// What the computation of a hull took.
struct HullStatistics {
  long support_queries = 0;
  long newton_iterations = 0;
  /// Cells of the CBVHs at the finest level of culling, and those that were kept.
  long cells = 0;
  long cells_kept = 0;
  /// Finer cells for which neither a proof nor a known contact accounts (SeparatingGraph).
  long cells_searched = 0;
  /// Cells of the map of directions, pieces of the model that were looked at in them, and those
  /// that are not decided.
  long map_cells = 0;
  long map_candidates = 0;
  long map_undecided = 0;
  double seconds_gauss_map = 0;
  double seconds_sample = 0;
  double seconds_cull = 0;
  double seconds_map = 0;
  double seconds_trace = 0;
  double seconds_stitch = 0;
  double seconds_mesh = 0;

  /// Adds all counts and times; of cells the larger numbers stay.
  HullStatistics& operator+=(const HullStatistics& other);
};

}  // namespace taut
