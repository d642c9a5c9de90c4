#include "taut/envelope/envelope_hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "taut/core/parallel.h"
#include "taut/core/stopwatch.h"
#include "taut/envelope/envelope_content.h"
#include "taut/hull/polytope/affine_span.h"
#include "taut/hull/sample/polytope_mesh.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/hull/sample/sampled_polytope.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

constexpr const char* images_too_coarse =
    "the images do not show enough for the tolerance: larger ones may";

/// Pixels across an image at which contacts are taken first.
constexpr int first_pixels = 16;

/// Contacts are added where they rise above a facet by this share of the tolerance, and if they are
/// no nearer to another one: points nearer together make slivers, and change the hull by less.
constexpr double worthwhile_rise = 0.01;
/// And no less than this, in the scene's frame, where coordinates are rounded.
constexpr double least_rise = 1e-14;

/// Grows a polytope of contacts that the images show.
class ImagePolytope {
 public:
  ImagePolytope(const EnvelopeImages& images, const EnvelopeMap& map, const HullOptions& options,
                double tolerance)
      : images_(images),
        content_(images.content()),
        options_(options),
        tolerance_(tolerance),
        rise_(std::max(least_rise,
                       worthwhile_rise * images.scene().frame().length_to_frame(tolerance))) {
    for (const EnvelopeTriplePoint& p : map.triple_points) {
      for (const Contact& c : p.contacts) add({p.n, c});
    }
    const int step = std::max(1, images.size() / first_pixels);
    for (const Hemisphere hemisphere : hemispheres) {
      for (int row = step / 2; row < images.size(); row += step) {
        for (int column = step / 2; column < images.size(); column += step) {
          const EnvelopePixel p{hemisphere, column, row};
          if (images.source(p) >= 0) add({images.direction(p), images.contact(p)});
        }
      }
    }
    if (options.vertex_budget) keep_spanning();
  }

  SampledPolytope run();

 private:
  void keep_spanning();
  /// How many samples a round may leave.
  std::size_t most_samples() const;
  void refine(std::optional<SampledPolytope>& last);
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const dvec3& x) const;
  bool add(const Sample& sample);
  std::vector<int> wanted_facets(const SampledPolytope& polytope) const;
  ClimbedContact highest_seen(const dvec3& n) const;
  std::vector<Sample> seen_above(const SampledPolytope& polytope,
                                 const std::vector<int>& facets) const;

  const EnvelopeImages& images_;
  const EnvelopeContent& content_;
  const HullOptions& options_;
  double tolerance_;  ///< in model units
  double rise_;       ///< in the scene's frame
  std::vector<Sample> samples_;
  std::vector<dvec3> points_;               ///< per sample, in model coordinates
  std::vector<dvec3> frame_points_;         ///< per sample, in the scene's frame
  std::map<Cell, std::vector<int>> cells_;  ///< samples by cells as wide as rise_
};

/// Keeps four samples that span space, if there are such.
void ImagePolytope::keep_spanning() {
  const AffineSpan span = affine_span(frame_points_, meaningful_width(content_.scene));
  if (span.dimension < 3) return;
  const std::vector<Sample> all = std::exchange(samples_, {});
  points_.clear();
  frame_points_.clear();
  cells_.clear();
  for (const int k : span.witnesses) add(all[std::size_t(k)]);
}

/// Of a budget so few more that the farthest come first.
std::size_t ImagePolytope::most_samples() const {
  if (!options_.vertex_budget) return std::size_t(options_.max_vertices);
  constexpr std::size_t batch_share = 16;
  const std::size_t count = samples_.size();
  return std::min(count + std::max<std::size_t>(count / batch_share, 1),
                  std::size_t(*options_.vertex_budget));
}

ImagePolytope::Cell ImagePolytope::cell_of(const dvec3& x) const {
  const auto index = [&](double t) { return std::int64_t(std::floor(t / rise_)); };
  return {index(x.x), index(x.y), index(x.z)};
}

/// False if there is a sample as good as this one already.
bool ImagePolytope::add(const Sample& sample) {
  const dvec3 x = content_.geometry.point(sample.contact);
  const Cell own = cell_of(x);
  for (std::int64_t i = own[0] - 1; i <= own[0] + 1; ++i) {
    for (std::int64_t j = own[1] - 1; j <= own[1] + 1; ++j) {
      for (std::int64_t k = own[2] - 1; k <= own[2] + 1; ++k) {
        const auto found = cells_.find({i, j, k});
        if (found == cells_.end()) continue;
        for (const int other : found->second) {
          if (glm::distance(frame_points_[std::size_t(other)], x) < rise_) return false;
        }
      }
    }
  }
  cells_[own].push_back(int(samples_.size()));
  samples_.push_back(sample);
  points_.push_back(content_.scene.frame().to_model(x));
  frame_points_.push_back(x);
  return true;
}

/// The facets that keep a vertex from its tolerance.
std::vector<int> ImagePolytope::wanted_facets(const SampledPolytope& polytope) const {
  std::vector<int> wanted;
  for (std::size_t f = 0; f < polytope.gaps.size(); ++f) {
    const PointHull::Facet& facet = polytope.hull.facets()[f];
    if (!facet.alive || polytope.gaps[f] <= rise_) continue;
    const bool bounds = std::any_of(facet.vertex.begin(), facet.vertex.end(), [&](int v) {
      return polytope.vertex_bounds[std::size_t(v)] > tolerance_;
    });
    if (bounds) wanted.push_back(int(f));
  }
  // The farthest first; where all are taken, the order does not matter.
  const auto higher = [&](int a, int b) {
    return polytope.gaps[std::size_t(a)] > polytope.gaps[std::size_t(b)];
  };
  if (options_.vertex_budget) std::stable_sort(wanted.begin(), wanted.end(), higher);
  return wanted;
}

/// The highest contact for a direction that its pixel or one next to that leads to: separating
/// curves may run between them.
ClimbedContact ImagePolytope::highest_seen(const dvec3& n) const {
  const EnvelopePixel pixel = images_.pixel(n);
  std::vector<std::uint32_t> tried;
  ClimbedContact best;
  for (int row = pixel.row - 1; row <= pixel.row + 1; ++row) {
    for (int column = pixel.column - 1; column <= pixel.column + 1; ++column) {
      const OffscreenCanvas::Pixel& seen = content_.at({pixel.hemisphere, column, row});
      if (seen.element == OffscreenCanvas::nothing ||
          std::find(tried.begin(), tried.end(), seen.triangle) != tried.end()) {
        continue;
      }
      tried.push_back(seen.triangle);
      const ClimbedContact c = climb(content_.geometry, content_.start(seen.triangle, n), n);
      if (tried.size() == 1 || c.h > best.h) best = c;
    }
  }
  return best;
}

/// What the images show in the facets' directions, as far as it lies above them.
std::vector<Sample> ImagePolytope::seen_above(const SampledPolytope& polytope,
                                              const std::vector<int>& facets) const {
  std::vector<Sample> seen(facets.size());
  parallel_for(facets.size(), 64, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    for (std::size_t k = begin; k < end; ++k) {
      const PointHull::Facet& facet = polytope.hull.facet(facets[k]);
      const dvec3 n = unit(facet.side.normal());
      const ClimbedContact c = highest_seen(n);
      double height = std::numeric_limits<double>::infinity();
      for (const int v : facet.vertex) {
        height = std::min(height, c.h - glm::dot(frame_points_[std::size_t(v)], n));
      }
      if (height > rise_) seen[k] = {n, c.contact};
    }
  });
  std::erase_if(seen, [](const Sample& s) { return s.contact.instance < 0; });
  return seen;
}

/// Where a limit is met, the last polytope before.
SampledPolytope ImagePolytope::run() {
  std::optional<SampledPolytope> last;
  try {
    refine(last);
  } catch (const LimitMet& met) {
    if (!last) throw;
    last->failure.reset();
    last->limit = met.what();
  }
  if (last->limit) options_.progress.stop.lift_limits();
  return std::move(*last);
}

/// Until the last one is within the tolerance, or tells why it is not.
void ImagePolytope::refine(std::optional<SampledPolytope>& last) {
  HullStatistics statistics;
  double least = infinity;
  for (;;) {
    // Any distance ends the refinement by queries before it begins.
    last.emplace(sampled_polytope(content_.scene, options_, 2 * content_.scene.diagonal(), samples_,
                                  points_));
    last->statistics += statistics;
    statistics = last->statistics;
    // It only grows.
    least = last->distance_bound = std::min(last->distance_bound, least);
    if (last->limit || last->distance_bound <= tolerance_) return;
    last->failure = images_too_coarse;
    const auto full = std::size_t(options_.vertex_budget.value_or(options_.max_vertices));
    if (samples_.size() >= full) last->failure = vertex_limit_met(full);
    bool added = false;
    const std::size_t most = most_samples();
    for (const Sample& sample : seen_above(*last, wanted_facets(*last))) {
      if (samples_.size() < most) added = add(sample) || added;
    }
    if (added) continue;
    if (tolerance_ == 0) last->failure.reset();
    return;
  }
}

}  // namespace

Hull envelope_hull(const EnvelopeImages& images, const EnvelopeMap& map, const HullOptions& asked) {
  const HullOptions options = within_limits(asked);
  const Scene& scene = images.scene();
  const double tolerance = tolerance_for(options, scene.diagonal());
  const Resolution resolution = resolution_for(options, scene.model(), scene.diagonal());
  SupportQuery query(scene, options.progress.stop);
  if (sampled_start(scene, query).span.dimension < 3) return sampled_hull(scene, options);
  warn_if_capped(resolution, options.progress);
  return polytope_hull(scene, options, ImagePolytope(images, map, options, tolerance).run());
}

}  // namespace taut
