#include "taut/hull/mesh/even_division.h"

#include <algorithm>

#include "taut/core/geometry.h"

namespace taut {
namespace {

/// With so many parts sagittas are a billionth of the length, whatever is asked for.
constexpr double most_parts = 1e4;
/// Nearer than this share of a part to a place that is there, that one serves as well.
constexpr double snap_share = 0.1;

double sagitta(const Ruling& a, const Ruling& middle, const Ruling& b) {
  return std::max(distance_to_segment(middle.point[0], a.point[0], b.point[0]),
                  distance_to_segment(middle.point[1], a.point[1], b.point[1]));
}

double chord(const Ruling& a, const Ruling& b) {
  return glm::distance(a.n, b.n) + glm::distance(a.point[0], b.point[0]) +
         glm::distance(a.point[1], b.point[1]);
}

}  // namespace

void EvenDivision::add(const std::vector<Ruling>& rulings, const std::function<Ruling()>& middle) {
  const std::size_t count = rulings.size();
  if (count < 2) return;  // a piece that could not be solved
  if (count == 2) {
    add(std::sqrt(sagitta(rulings[0], middle(), rulings[1])));
    return;
  }
  std::vector<double> lengths;
  for (std::size_t k = 0; k + 1 < count; ++k) lengths.push_back(chord(rulings[k], rulings[k + 1]));
  std::vector<double> density(count, 0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double length = lengths[k - 1] + lengths[k];
    if (!(length > 0)) continue;
    density[k] = std::sqrt(sagitta(rulings[k - 1], rulings[k], rulings[k + 1])) / length;
  }
  density.front() = density[1];
  density.back() = density[count - 2];
  for (std::size_t k = 0; k + 1 < count; ++k) {
    add(0.5 * (density[k] + density[k + 1]) * lengths[k]);
  }
}

std::vector<EvenDivision::Place> EvenDivision::places(double sagitta, int least_parts) const {
  const double parts = std::clamp(std::ceil(this->parts(sagitta)), double(least_parts), most_parts);
  std::vector<Place> result = {{0, 0}};
  for (int k = 1; k < int(parts); ++k) {
    const double at = sums_.back() * (k / parts);
    const auto next = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, at);
    const double from = *(next - 1);
    const double snap = snap_share * sums_.back() / parts;
    double s = *next > from ? (at - from) / (*next - from) : 0;
    if (at - from < snap) s = 0;
    if (*next - at < snap) s = 1;
    result.push_back({std::size_t(next - sums_.begin()) - 1, s});
  }
  result.push_back({sums_.size() - 2, 1});
  return result;
}

}  // namespace taut
