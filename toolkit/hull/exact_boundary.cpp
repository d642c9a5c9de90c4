#include "taut/hull/exact_boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "taut/core/error.h"
#include "taut/core/stopwatch.h"
#include "taut/core/tolerances.h"
#include "taut/hull/solve/solved_graph.h"
#include "taut/hull/solve/tolerant_places.h"
#include "taut/hull/stitch/ruled_faces.h"
#include "taut/hull/stitch/stitch.h"

namespace taut {
namespace {

/// Pieces of a model that may be looked at for its map of directions, a second at most, and how
/// many more for each of its patches.
constexpr long map_candidates = 600'000;
constexpr long map_candidates_a_patch = 200;

long candidate_limit(const ContactGeometry& geometry) {
  return map_candidates + map_candidates_a_patch * geometry.scene().patch_count();
}

/// Pieces that may be looked at, some ten seconds' worth, where what was left undecided keeps the
/// boundary from being found: dents of flat cages about their ends. Not where it is more cells than
/// these, which ties all along curves leave.
constexpr long thorough_candidates = 12'000'000;
constexpr long few_undecided = 4096;

/// Finer maps that are asked, as shares of the resolution, and for how many times as many pieces,
/// together.
constexpr std::array finer_maps = {1. / 4, 1. / 16, 1. / 64};
constexpr long finer_map_times = 2;
/// How many times the resolution what is deep may be expected to be by one.
constexpr double finer_depths = 4;

/// Share of the step that it takes to close a boundary, about; the rest bounds its depths.
constexpr double closed_share = 0.5;

/// Spots that could not be resolved beyond which it does not help to know more.
constexpr std::size_t few_open_spots = 16;

long undecided(const DirectionMap& map) {
  return map.statistics.of_kind[std::size_t(MapCellKind::undecided)];
}

/// The map of the scene's directions at a resolution in its frame, for which so many pieces may be
/// looked at.
DirectionMap map_of(const ContactGeometry& geometry, double resolution, long candidates,
                    const HullOptions& options, HullStatistics& statistics) {
  const Stopwatch watch;
  options.progress.update("cull", 0);
  DirectionMapOptions own;
  own.resolution = resolution;
  own.candidate_limit = candidates;
  own.threads = options.threads;
  own.stop = options.progress.stop;
  own.report = [&](double share) { options.progress.update("cull", share); };
  DirectionMap map = direction_map(geometry, own);
  statistics.map_cells += map.statistics.cells;
  statistics.map_candidates += map.statistics.candidates;
  statistics.map_undecided += undecided(map);
  for (const MapCell& cell : map.cells) statistics.map_contacts += long(cell.contacts.size());
  statistics.support_queries += map.statistics.queries;
  statistics.seconds_map += watch.seconds();
  options.progress.update("cull", 1);
  return map;
}

/// Solved from the map, and stitched. What is not exact is known to `rho`: that of the model, from
/// which those of maps may differ. Places on edges that are as near to each other as so many units
/// of the map's resolution are one.
HullBoundary solved_with(double place_depths, const ContactGeometry& geometry,
                         const DirectionMap& directions, double rho, const HullOptions& options,
                         HullStatistics& statistics) {
  Stopwatch watch;
  options.progress.update("trace", 0);
  SupportQuery uncovered(geometry.scene(), options.progress.stop);
  uncovered.leave_out(directions.covered);
  uncovered.leave_out_lines(geometry.scene().frame().length_to_frame(geometry.bent()));
  SeparatingGraph graph =
      solved_graph(geometry, uncovered, directions, options.progress, place_depths);
  statistics.support_queries += uncovered.queries();
  statistics.newton_iterations += graph.newton_iterations + uncovered.newton_iterations();
  statistics.seconds_trace += watch.lap();
  options.progress.update("trace", 1);
  options.progress.update("stitch", 0);
  SupportQuery query(geometry.scene(), options.progress.stop);
  HullBoundary boundary =
      stitch(geometry, query, std::move(graph), options.progress.part(0, closed_share));
  boundary.gap = directions.resolution;
  // What is not closed is not known to anything.
  if (boundary.unresolved.empty()) {
    query.leave_out_lines(tie_share * rho);
    find_tolerant_places(ContactSystem(geometry), query, boundary, rho,
                         options.progress.part(closed_share, 1));
    label_ruled_faces(geometry, boundary);
  }
  statistics.seconds_stitch += watch.lap();
  options.progress.update("stitch", 1);
  statistics.support_queries += query.queries();
  statistics.newton_iterations += query.newton_iterations();
  return boundary;
}

/// Exact models have their places where they are; of others, and where faces do not close up so,
/// rounding may have moved them.
HullBoundary solved(const ContactGeometry& geometry, const DirectionMap& directions, double rho,
                    const HullOptions& options, HullStatistics& statistics) {
  if (!is_rounded(geometry.scene(), directions.resolution)) {
    HullBoundary exact = solved_with(1, geometry, directions, rho, options, statistics);
    if (exact.unresolved.empty()) return exact;
  }
  return solved_with(most_place_depths, geometry, directions, rho, options, statistics);
}

/// It is closed, and nothing is below the supporting planes by more than the resolution.
bool is_within(const HullBoundary& boundary, double resolution) {
  return boundary.unresolved.empty() && deepest_tolerant(boundary) <= resolution;
}

/// By maps that decide more, or finer; the first boundary that is within the resolution counts.
void improve(HullBoundary& boundary, const ContactGeometry& geometry,
             const DirectionMap& directions, const HullOptions& options, HullStatistics& statistics,
             MapEffort effort) {
  const double rho = directions.resolution;
  long left = finer_map_times * candidate_limit(geometry);
  if (const long open = undecided(directions); open > 0) {
    const bool helps = open <= few_undecided && left < thorough_candidates;
    if (effort == MapEffort::usual || !helps) return;
    const DirectionMap whole = map_of(geometry, rho, thorough_candidates, options, statistics);
    // What is left undecided then is not decided by finer maps either.
    if (undecided(whole) > 0) return;
    boundary = solved(geometry, whole, rho, options, statistics);
    if (is_within(boundary, rho)) return;
  }
  if (boundary.unresolved.size() > few_open_spots) return;
  // Depths fall with the resolution, mostly: what is deep is first sought with the finest.
  std::array shares = finer_maps;
  const double deepest = deepest_tolerant(boundary);
  std::stable_partition(shares.begin(), shares.end(), [&](double share) {
    return share == finer_maps.back() || share * deepest <= finer_depths * rho;
  });
  for (const double share : shares) {
    const DirectionMap finer = map_of(geometry, share * rho, left, options, statistics);
    left -= finer.statistics.candidates;
    HullBoundary other = solved(geometry, finer, rho, options, statistics);
    if (is_within(other, rho)) {
      boundary = std::move(other);
      return;
    }
    if (left <= 0) return;
  }
}

}  // namespace

double same_elements_of(const Scene& scene, const HullOptions& options) {
  const double rho = resolution_for(options, scene.model(), scene.diagonal()).rho;
  return tie_share * scene.frame().length_to_frame(rho);
}

DirectionMap directions_of(const ContactGeometry& geometry, const HullOptions& options,
                           HullStatistics& statistics) {
  const Scene& scene = geometry.scene();
  const Resolution resolution = resolution_for(options, scene.model(), scene.diagonal());
  return map_of(geometry, scene.frame().length_to_frame(resolution.rho), candidate_limit(geometry),
                options, statistics);
}

HullBoundary exact_boundary(const ContactGeometry& geometry, const DirectionMap& directions,
                            const HullOptions& options, HullStatistics& statistics,
                            MapEffort effort) {
  HullBoundary boundary = solved(geometry, directions, directions.resolution, options, statistics);
  if (is_within(boundary, directions.resolution)) return boundary;
  try {
    improve(boundary, geometry, directions, options, statistics, effort);
  } catch (const LimitMet&) {
    // What was found until then is an answer.
  }
  return boundary;
}

HullBoundary exact_boundary(const Scene& scene, const HullOptions& options,
                            HullStatistics& statistics) {
  const ContactGeometry geometry(scene, options.progress.stop, same_elements_of(scene, options));
  return exact_boundary(geometry, directions_of(geometry, options, statistics), options,
                        statistics);
}

}  // namespace taut
