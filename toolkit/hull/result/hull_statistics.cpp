#include "taut/hull/result/hull_statistics.h"

#include <algorithm>

namespace taut {

HullStatistics& HullStatistics::operator+=(const HullStatistics& other) {
  support_queries += other.support_queries;
  newton_iterations += other.newton_iterations;
  map_cells += other.map_cells;
  map_undecided = std::max(map_undecided, other.map_undecided);
  map_candidates += other.map_candidates;
  map_contacts += other.map_contacts;
  seconds_sample += other.seconds_sample;
  seconds_map += other.seconds_map;
  seconds_trace += other.seconds_trace;
  seconds_stitch += other.seconds_stitch;
  seconds_mesh += other.seconds_mesh;
  return *this;
}

}  // namespace taut
