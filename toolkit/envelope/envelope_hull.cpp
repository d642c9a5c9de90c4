#include "taut/envelope/envelope_hull.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "taut/core/parallel.h"
#include "taut/envelope/envelope_content.h"
#include "taut/hull/polytope_mesh.h"
#include "taut/hull/sampled_start.h"

namespace taut {
namespace {

constexpr const char* images_too_coarse =
    "the images are too coarse for the tolerance: larger ones may reach it";

/// Between two pixels, directions are halved at most so often.
constexpr int halving_limit = 10;

/// The grid's steps are such that surfaces rise between contacts by this share of the tolerance.
constexpr double rise_share = 0.25;

/// Takes contacts from images, each once.
class ImageSampler {
 public:
  ImageSampler(const EnvelopeImages& images, const EnvelopeMap& map, double tolerance)
      : content_(images.content()),
        map_(map),
        rise_(rise_share * content_.scene.frame().length_to_frame(tolerance)) {}

  /// Of every step-th pixel.
  void sample(int step, const HullOptions& options);

  std::vector<Sample> samples;
  std::vector<dvec3> points;  ///< per sample, in model coordinates

 private:
  struct Found {
    dvec3 n;
    ClimbedContact contact;
  };

  void sample_row(int row, int step, Hemisphere hemisphere, std::vector<Found>& result) const;
  void add_between(const Found& a, const Found& b, int halvings, std::vector<Found>& result) const;
  void add(const dvec3& n, const Contact& contact);

  const EnvelopeImages::Content& content_;
  const EnvelopeMap& map_;
  double rise_;  ///< in the scene's frame
  std::set<int> vertices_;
};

void ImageSampler::add(const dvec3& n, const Contact& contact) {
  if (contact.kind == SourceKind::vertex &&
      !vertices_.insert(content_.elements.number(contact)).second) {
    return;
  }
  samples.push_back({n, contact});
  points.push_back(content_.scene.point(contact));
}

/// What a surface may rise over the chord between two contacts is an eighth of what the chord gains
/// from the one direction to the other.
void ImageSampler::add_between(const Found& a, const Found& b, int halvings,
                               std::vector<Found>& result) const {
  const double gain = glm::dot(a.contact.x - b.contact.x, a.n - b.n);
  if (halvings == halving_limit || gain / 8 <= rise_) return;
  Found middle{unit(a.n + b.n), {}};
  const ClimbedContact from_a = climb(content_.geometry, a.contact.place, middle.n);
  const ClimbedContact from_b = climb(content_.geometry, b.contact.place, middle.n);
  middle.contact = from_a.h >= from_b.h ? from_a : from_b;
  const double moved = std::min(glm::distance(middle.contact.x, a.contact.x),
                                glm::distance(middle.contact.x, b.contact.x));
  if (moved <= rise_) return;  // it jumps from the one to the other
  add_between(a, middle, halvings + 1, result);
  result.push_back(middle);
  add_between(middle, b, halvings + 1, result);
}

/// The pixels of a row, and what lies between them and those to the right and below.
void ImageSampler::sample_row(int row, int step, Hemisphere hemisphere,
                              std::vector<Found>& result) const {
  const auto drawn = [&](int column, int line) {
    const double reach = 0.5 * content_.size + step;
    const dvec2 p(column + 0.5 - 0.5 * content_.size, line + 0.5 - 0.5 * content_.size);
    return column < content_.size && line < content_.size && glm::length(p) <= reach &&
           content_.at({hemisphere, column, line}).element != OffscreenCanvas::nothing;
  };
  const auto found_at = [&](int column, int line) {
    const EnvelopePixel p{hemisphere, column, line};
    return Found{content_.direction(p), content_.climbed(p)};
  };
  for (int column = 0; column < content_.size; column += step) {
    if (!drawn(column, row)) continue;
    const Found own = found_at(column, row);
    result.push_back(own);
    if (drawn(column + step, row)) add_between(own, found_at(column + step, row), 0, result);
    if (drawn(column, row + step)) add_between(own, found_at(column, row + step), 0, result);
  }
}

void ImageSampler::sample(int step, const HullOptions& options) {
  samples.clear();
  points.clear();
  vertices_.clear();
  for (const EnvelopeTriplePoint& p : map_.triple_points) {
    for (const Contact& c : p.contacts) add(p.n, c);
  }
  for (const EnvelopeCurve& curve : map_.curves) {
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const bool end = k == 0 || k + 1 == curve.points.size();
      if (!end && k % std::size_t(step) != 0) continue;
      for (const Contact& c : curve.points[k].contact) add(curve.points[k].n, c);
    }
  }
  const auto rows = std::size_t((content_.size + step - 1) / step);
  std::vector<std::vector<Found>> found(2 * rows);
  parallel_for(found.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
    options.progress.check();
    for (std::size_t k = begin; k < end; ++k) {
      sample_row(int(k % rows) * step, step, hemispheres[k / rows], found[k]);
    }
  });
  for (const auto& row : found) {
    for (const Found& f : row) add(f.n, f.contact.contact);
  }
}

/// The coarsest steps worth trying: between directions so far apart, spheres of the scene's size
/// rise by the tolerance.
int first_step(double relative_tolerance, int size) {
  const double angle = std::sqrt(8 * rise_share * relative_tolerance);
  return std::clamp(int(angle * size / 4), 1, std::max(1, size / 16));
}

}  // namespace

Hull envelope_hull(const EnvelopeImages& images, const EnvelopeMap& map,
                   const HullOptions& options) {
  const Scene& scene = images.scene();
  const double tolerance = tolerance_for(options, scene.diagonal());
  SupportQuery query(scene);
  if (sampled_start(scene, query).span.dimension < 3) return sampled_hull(scene, options);

  ImageSampler sampler(images, map, tolerance);
  HullStatistics statistics;
  statistics.support_queries = query.queries();
  statistics.newton_iterations = query.newton_iterations();
  for (int step = first_step(tolerance / scene.diagonal(), images.size());; step = step / 2) {
    sampler.sample(step, options);
    // Any distance ends the refinement before it begins: it is the image's own that is measured.
    SampledPolytope polytope =
        sampled_polytope(scene, options, 2 * scene.diagonal(), sampler.samples, sampler.points);
    polytope.statistics += statistics;
    statistics = polytope.statistics;
    const bool reached = polytope.distance_bound <= tolerance;
    if (!reached && step > 1) continue;
    if (!reached) polytope.failure = images_too_coarse;
    return polytope_hull(scene, options, polytope);
  }
}

}  // namespace taut
