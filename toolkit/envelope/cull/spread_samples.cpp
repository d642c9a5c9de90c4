#include "taut/envelope/cull/spread_samples.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/direction_cells.h"
#include "taut/bounds/support_query.h"
#include "taut/core/parallel.h"

namespace taut {
namespace {

/// The sphere is sampled at one direction for some patches, between 96 and 6144 in all: the more
/// patches there are, the more of them lie under the samples and need no queries of their own.
constexpr std::size_t patches_per_direction = 8;
constexpr int coarsest_directions = 2;
constexpr int finest_directions = 5;
/// Edges have no cells: where they are curved, this many levels of directions at least.
constexpr int directions_for_edges = 3;

/// A pyramid that is this many cells of the spread samples wide needs no query of its own.
constexpr double dense_samples = 4;

constexpr std::size_t directions_per_task = 64;

bool has_curved_edges(const Model& model) {
  return std::any_of(model.parts().begin(), model.parts().end(), [](const Part& part) {
    return std::any_of(part.pieces().begin(), part.pieces().end(), [](const EdgePiece& piece) {
      return piece.edge >= 0 && piece.bezier.degree() > 1;
    });
  });
}

}  // namespace

SpreadSamples::SpreadSamples(const Scene& scene, std::size_t patches, const CullingOptions& options)
    : level_(has_curved_edges(scene.model()) ? directions_for_edges : coarsest_directions) {
  while (level_ < finest_directions &&
         (std::size_t(6) << (2 * (level_ + 1))) * patches_per_direction <= patches) {
    ++level_;
  }
  const std::uint32_t side = std::uint32_t{1} << level_;
  samples_.resize(6 * std::size_t(side) * side);
  points_.resize(samples_.size());
  std::vector<DirectionCell> cells;
  for (int face = 0; face < 6; ++face) {
    for (std::uint32_t i = 0; i < side; ++i) {
      for (std::uint32_t j = 0; j < side; ++j) cells.push_back({face, level_, i, j});
    }
  }
  parallel_for(cells.size(), directions_per_task, options.threads,
               [&](std::size_t begin, std::size_t end) {
                 options.progress.check();
                 SupportQuery query(scene, options.progress.stop);
                 for (std::size_t k = begin; k < end; ++k) {
                   const auto c = cells[k].corners();
                   const dvec3 n = unit(c[0] + c[1] + c[2] + c[3]);
                   const Support s = query(n);
                   samples_[cells[k].index()] = {n, s.contact};
                   points_[cells[k].index()] = s.point;
                 }
               });
}

std::size_t SpreadSamples::nearest(const dvec3& n) const {
  return DirectionCell::of(n, level_).index();
}

bool SpreadSamples::is_dense_in(const NormalPyramid& pyramid) const {
  const double width = std::min(glm::distance(pyramid.corners[0], pyramid.corners[2]),
                                glm::distance(pyramid.corners[1], pyramid.corners[3]));
  return width > dense_samples * std::ldexp(2.0, -level_);
}

}  // namespace taut
