#include "taut/hull/precise_hull.h"

#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "taut/core/error.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/mesh/boundary_mesh.h"
#include "taut/hull/planar/flat_boundary.h"
#include "taut/hull/sample/polytope_mesh.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/hull/sample/sampled_start.h"
#include "taut/hull/stitch/ruled_faces.h"

namespace taut {
namespace {

/// Share of the limits of time and memory that goes to a hull to fall back on.
constexpr double fallback_share = 0.25;

/// What keeps a boundary from being what it promises, empty if nothing does.
std::string broken_promise(const HullBoundary& boundary, const Resolution& resolution) {
  std::array<char, 256> text{};
  if (!boundary.unresolved.empty()) {
    const auto& [n, reason] = boundary.unresolved.front();
    const bool is_of_all = n == dvec3(0.0);
    std::snprintf(text.data(), text.size(),
                  is_of_all ? "no exact boundary was found: %s"
                            : "no exact boundary was found: %s at the normal %g %g %g",
                  reason, n.x, n.y, n.z);
    return text.data();
  }
  const double depth = boundary.frame.length_to_model(deepest_tolerant(boundary));
  if (!(depth > resolution.rho)) return {};
  std::snprintf(text.data(), text.size(),
                "faces of the exact boundary are known to %.3g only, not to the resolution %.3g",
                depth, resolution.rho);
  return text.data();
}

/// Throws the mesh with its faces as the boundary, in place of one that does not keep its promise,
/// and what keeps the mesh from its tolerance, if anything does.
[[noreturn]] void throw_facetted(const Scene& scene, const HullOptions& options,
                                 const std::string& broken, const HullStatistics& statistics) {
  std::string text = broken + "; its faces are those of the mesh";
  Hull hull;
  try {
    hull = facetted_hull(scene, options);
  } catch (const HullNotConverged& failure) {
    text += std::string("; ") + failure.what();
    hull = *failure.best;
  }
  hull.statistics += statistics;
  throw HullNotConverged(text, std::move(hull));
}

/// The hull with its boundary; or with its mesh's faces as the boundary, where that
/// is not closed or would be farther off than these.
Hull with_boundary(const Scene& scene, const ContactGeometry& geometry, HullBoundary boundary,
                   const HullOptions& options) {
  auto own = std::make_shared<HullBoundary>(std::move(boundary));
  std::vector<Sample> uncovered;
  Hull hull;
  std::string failure;
  std::optional<std::string> limit;
  try {
    hull = boundary_mesh(scene, geometry, own, options, &uncovered);
  } catch (const HullNotConverged& stopped) {
    hull = *stopped.best;
    failure = stopped.what();
  } catch (const HullLimitExceeded& stopped) {
    hull = *stopped.best;
    limit = stopped.what();
  }
  for (const Sample& s : uncovered) {
    own->unresolved.push_back({s.n, "a support point lies on no face that was found"});
  }
  if (limit) throw HullLimitExceeded(*limit, std::move(hull));
  const std::string broken = broken_promise(*own, hull.resolution);
  if (broken.empty() && failure.empty()) return hull;
  if (broken.empty()) throw HullNotConverged(failure, std::move(hull));
  const double depth = own->frame.length_to_model(deepest_tolerant(*own));
  if (own->unresolved.empty() && depth <= hull.distance_bound) {
    throw HullNotConverged(broken, std::move(hull));
  }
  throw_facetted(scene, options, broken, hull.statistics);
}

/// A boundary, and what it was found with.
struct Found {
  ContactGeometry geometry;
  HullBoundary boundary;
  HullOptions options;
};

std::unique_ptr<Found> found_with(const Scene& scene, const HullOptions& options,
                                  HullStatistics& statistics, MapEffort effort) {
  auto found = std::make_unique<Found>(
      Found{ContactGeometry(scene, options.progress.stop, same_elements_of(scene, options)),
            {},
            options});
  const DirectionMap directions = directions_of(found->geometry, options, statistics);
  found->boundary = exact_boundary(found->geometry, directions, options, statistics, effort);
  return found;
}

/// The resolution with which a model's own is replaced where places of its hull are not told apart
/// by it, in turn.
constexpr std::array coarser_resolutions = {4.0, 16.0};

/// With the first coarser resolution at which the boundary is what it promises; none if one is
/// stated, there is none, or a limit is met.
std::unique_ptr<Found> found_coarser(const Scene& scene, const HullOptions& options,
                                     const Resolution& own, HullStatistics& statistics) try {
  if (options.resolution) return nullptr;
  Resolution coarser = own;
  for (const double times : coarser_resolutions) {
    coarser.rho = times * own.rho;
    if (coarser.rho > coarsest_resolution * scene.diagonal()) break;
    HullOptions with = options;
    with.resolution = coarser.rho / scene.diagonal();
    std::unique_ptr<Found> other = found_with(scene, with, statistics, MapEffort::usual);
    if (broken_promise(other->boundary, coarser).empty()) return other;
  }
  return nullptr;
} catch (const LimitMet&) {
  return nullptr;
}

void warn_of_coarser(const Resolution& own, const Resolution& coarser, const Progress& progress) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "places of the exact hull are not told apart at the model's resolution of %.3g: "
                "the hull's is %.3g",
                own.rho, coarser.rho);
  progress.warning("coarser-resolution", text.data());
}

/// The hull with its exact boundary. What it took until then is added to the statistics, also where
/// it throws.
Hull exact_hull(const Scene& scene, const HullOptions& options, HullStatistics& statistics) {
  const Resolution own = resolution_for(options, scene.model(), scene.diagonal());
  std::unique_ptr<Found> found = found_with(scene, options, statistics, MapEffort::thorough);
  std::unique_ptr<Found> coarser;
  if (!broken_promise(found->boundary, own).empty()) {
    coarser = found_coarser(scene, options, own, statistics);
  }
  if (coarser) {
    const auto raised = [&](Hull hull) {
      const double rho = hull.resolution.rho;
      hull.resolution = own;
      hull.resolution.rho = rho;
      hull.resolution.raised_from = own.rho;
      return hull;
    };
    try {
      Hull hull = raised(
          with_boundary(scene, coarser->geometry, std::move(coarser->boundary), coarser->options));
      warn_of_coarser(own, hull.resolution, options.progress);
      return hull;
    } catch (const HullLimitExceeded& met) {
      throw HullLimitExceeded(met.what(), raised(*met.best));
    } catch (const HullNotConverged&) {
      // The mesh has shown that it lacks faces: what is wrong at the model's own is told.
    }
  }
  return with_boundary(scene, found->geometry, std::move(found->boundary), options);
}

/// The mesh with its faces as the boundary, within the tolerance or as far as a share of what the
/// limits leave goes; none if that is too little for any.
std::optional<Hull> fallback_hull(const Scene& scene, const HullOptions& options) {
  HullOptions own = options;
  own.progress.stop = options.progress.stop.within_share(fallback_share);
  try {
    return facetted_hull(scene, own);
  } catch (const HullNotConverged& failure) {
    return *failure.best;
  } catch (const HullLimitExceeded& stopped) {
    return *stopped.best;
  } catch (const LimitMet&) {
    return std::nullopt;
  }
}

/// Whether the boundary is closed and as near to the exact one as the mesh is.
bool is_closed_answer(const Hull& hull) {
  if (!hull.boundary) return true;
  const HullBoundary& boundary = *hull.boundary;
  return boundary.unresolved.empty() &&
         boundary.frame.length_to_model(deepest_tolerant(boundary)) <= hull.distance_bound;
}

/// The nearer one of a hull that was found until a limit was met and the one to fall back on.
/// @throws LimitMet if there is none that is closed
Hull best_of(const HullLimitExceeded& met, const std::optional<Hull>& fallback) {
  const bool closed = is_closed_answer(*met.best);
  if (!closed && !fallback) throw LimitMet(met.what());
  return closed && (!fallback || met.best->distance_bound <= fallback->distance_bound) ? *met.best
                                                                                       : *fallback;
}

/// The hull of a scene that spans less than space, with the boundary of a planar one where that is
/// known.
Hull flat_hull(const Scene& scene, const HullOptions& options, const SampledStart& start,
               SupportQuery& query, const Resolution& resolution) {
  const auto with_boundary = [&](Hull hull) {
    if (hull.kind != HullKind::planar) return hull;
    std::optional<HullBoundary> boundary;
    try {
      const double rho = scene.frame().length_to_frame(resolution.rho);
      const ContactGeometry geometry(scene, options.progress.stop,
                                     same_elements_of(scene, options));
      boundary =
          flat_boundary(geometry, query, {start.span.normal, start.middle, start.half_width}, rho);
      if (boundary) label_ruled_faces(geometry, *boundary);
    } catch (const LimitMet& met) {
      throw HullLimitExceeded(met.what(), std::move(hull));
    }
    if (!boundary) return hull;
    for (const auto f : hull.mesh.faces()) {
      hull.mesh.data(f).kind = FaceKind::facet;
      hull.mesh.data(f).source = boundary->faces.front().source;
    }
    hull.boundary = std::make_shared<const HullBoundary>(*std::move(boundary));
    return hull;
  };
  try {
    return with_boundary(sampled_hull(scene, options));
  } catch (const HullNotConverged& failure) {
    throw HullNotConverged(failure.what(), with_boundary(*failure.best));
  }
}

}  // namespace

Hull precise_hull(const Scene& scene, const HullOptions& asked) {
  // What is wrong with the options is told at once.
  const HullOptions options = within_limits(asked);
  tolerance_for(options, scene.diagonal());
  const Resolution resolution = resolution_for(options, scene.model(), scene.diagonal());
  SupportQuery query(scene, options.progress.stop);
  const double rho = scene.frame().length_to_frame(resolution.rho);
  const SampledStart start = sampled_start(scene, query, rho);
  if (start.span.dimension < 3) return flat_hull(scene, options, start, query, resolution);
  warn_if_capped(resolution, options.progress);

  HullStatistics statistics;
  statistics.support_queries = query.queries();
  statistics.newton_iterations = query.newton_iterations();
  std::optional<Hull> fallback;
  if (options.progress.stop.has_limits()) fallback = fallback_hull(scene, options);
  if (fallback) statistics += std::exchange(fallback->statistics, {});
  const auto with_statistics = [&](Hull hull) {
    hull.statistics += statistics;
    return hull;
  };
  try {
    Hull hull = exact_hull(scene, options, statistics);
    hull.statistics += statistics;
    return hull;
  } catch (const HullNotConverged& failure) {
    throw HullNotConverged(failure.what(), with_statistics(*failure.best));
  } catch (const HullLimitExceeded& met) {
    throw HullLimitExceeded(met.what(), with_statistics(best_of(met, fallback)));
  } catch (const LimitMet& met) {
    if (!fallback) throw;
    throw HullLimitExceeded(met.what(), with_statistics(*std::move(fallback)));
  }
}

}  // namespace taut
