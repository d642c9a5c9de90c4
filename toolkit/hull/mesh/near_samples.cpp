#include "taut/hull/mesh/near_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace taut {

BoundarySamples without_near_ones(const BoundarySamples& all, const std::vector<double>& clear,
                                  double width, const dvec3& center) {
  // In the order of a direction in which few points of a model lie side by side.
  const dvec3 across = unit(dvec3(0.7548776662466927, 0.5698402909980532, 0.4301597090019468));
  const std::size_t count = all.points.size();
  std::vector<double> height;
  for (const dvec3& p : all.points) height.push_back(glm::dot(across, p - center));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return height[a] != height[b] ? height[a] < height[b] : a < b;
  });
  std::vector<std::size_t> place(count);
  for (std::size_t k = 0; k < count; ++k) place[order[k]] = k;
  BoundarySamples result;
  std::vector<int> number(count, -1);  // in the result
  std::vector<int> kept_as(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    int near = -1;
    const auto look = [&](std::size_t other) {
      if (std::abs(height[other] - height[i]) > clear[i]) return false;
      if (number[other] >= 0 && other < i &&
          glm::distance(all.points[other], all.points[i]) <= clear[i]) {
        near = number[other];
      }
      return near < 0;
    };
    for (std::size_t k = place[i]; k > 0 && look(order[k - 1]); --k) continue;
    for (std::size_t k = place[i] + 1; near < 0 && k < count && look(order[k]); ++k) continue;
    if (near >= 0 && clear[i] > width) continue;
    if (near >= 0) {
      for (const TouchedFace& f : all.faces[i]) touch(result.faces[std::size_t(near)], f);
      kept_as[i] = near;
      continue;
    }
    number[i] = int(result.samples.size());
    kept_as[i] = number[i];
    result.samples.push_back(all.samples[i]);
    result.points.push_back(all.points[i]);
    result.faces.push_back(all.faces[i]);
  }
  for (CurveChord chord : all.chords) {
    chord.a = kept_as[std::size_t(chord.a)];
    chord.b = kept_as[std::size_t(chord.b)];
    if (chord.a != chord.b) result.chords.push_back(chord);
  }
  return result;
}

}  // namespace taut
