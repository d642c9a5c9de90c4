#pragma once

namespace taut {

/// What the computation of a hull took.
struct HullStatistics {
  long support_queries = 0;
  long newton_iterations = 0;
  /// Cells of the map of directions, and those that are not decided; pieces of the model that were
  /// looked at in cells, and those that are left in them.
  long map_cells = 0;
  long map_undecided = 0;
  long map_candidates = 0;
  long map_contacts = 0;
  double seconds_sample = 0;
  double seconds_map = 0;
  double seconds_trace = 0;
  double seconds_stitch = 0;
  double seconds_mesh = 0;

  /// Adds all counts and times; of cells the larger numbers stay.
  HullStatistics& operator+=(const HullStatistics& other);
};

}  // namespace taut
