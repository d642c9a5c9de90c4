#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/containment/location.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/progress.h"

namespace taut {

/// A point in the scene's frame. @throws InvalidInput if it is not finite, before or in the frame
inline dvec3 point_in_frame(const SceneFrame& frame, const dvec3& x) {
  const dvec3 in_frame = frame.to_frame(x);
  const double sum = std::abs(in_frame.x) + std::abs(in_frame.y) + std::abs(in_frame.z);
  if (!std::isfinite(sum)) {
    throw InvalidInput("a point is not finite, or too far from the model for doubles");
  }
  return in_frame;
}

/// Points that one thread answers in a row.
struct BatchOptions {
  std::size_t grain = 256;
  int threads = 0;
  const Progress& progress;
};

/// answer(worker, point) of all points, in their order. Every range of points has a worker of its
/// own, made by make(); its counts() are added to `counts` in the order of the ranges, if given.
template <class Answer, class Make, class Ask>
std::vector<Answer> answer_points(std::span<const dvec3> points, const BatchOptions& options,
                                  ContainmentCounts* counts, Make make, Ask ask) {
  std::vector<Answer> answers(points.size());
  const std::size_t grain = options.grain;
  std::vector<ContainmentCounts> of_range((points.size() + grain - 1) / grain);
  parallel_for(points.size(), grain, options.threads, [&](std::size_t begin, std::size_t end) {
    options.progress.check();
    auto worker = make();
    for (std::size_t i = begin; i < end; ++i) answers[i] = ask(worker, points[i]);
    of_range[begin / grain] = worker.counts();
    of_range[begin / grain].points = long(end - begin);
  });
  if (counts != nullptr) {
    for (const ContainmentCounts& own : of_range) *counts += own;
  }
  return answers;
}

}  // namespace taut
