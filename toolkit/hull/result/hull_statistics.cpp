#include "taut/hull/result/hull_statistics.h"

#include <algorithm>

namespace taut {

HullStatistics& HullStatistics::operator+=(const HullStatistics& other) {
  support_queries += other.support_queries;
  newton_iterations += other.newton_iterations;
  cells = std::max(cells, other.cells);
  cells_kept = std::max(cells_kept, other.cells_kept);
  cells_searched = std::max(cells_searched, other.cells_searched);
  map_cells += other.map_cells;
  map_candidates += other.map_candidates;
  map_undecided = std::max(map_undecided, other.map_undecided);
  seconds_gauss_map += other.seconds_gauss_map;
  seconds_sample += other.seconds_sample;
  seconds_cull += other.seconds_cull;
  seconds_map += other.seconds_map;
  seconds_trace += other.seconds_trace;
  seconds_stitch += other.seconds_stitch;
  seconds_mesh += other.seconds_mesh;
  return *this;
}

}  // namespace taut
