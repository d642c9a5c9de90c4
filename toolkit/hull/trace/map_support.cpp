#include "taut/hull/trace/map_support.h"

#include <cmath>

namespace taut {
namespace {

/// Directions are told apart in steps of this: cells' corners are the same points, to rounding, for
/// all cells that meet there.
constexpr double corner_step = 1e-12;

}  // namespace

const SupportSample& MapSupport::at(const dvec3& d) {
  const dvec3 n = unit(d);
  const auto rounded = [](double x) { return std::llround(x / corner_step); };
  const auto [known, is_new] =
      samples_.try_emplace({rounded(n.x), rounded(n.y), rounded(n.z)}, SupportSample{});
  if (is_new) {
    known->second = seen(geometry_, query_, n, hint_);
    hint_ = known->second.contact;
  }
  return known->second;
}

std::vector<std::pair<SupportSample, SupportSample>> MapSupport::partings(const MapCell& cell) {
  const std::array<dvec3, 4> d = DirectionMap::corners(cell);
  const std::array<std::pair<std::size_t, std::size_t>, 4> sides = {
      {{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
  std::array<std::size_t, 4> winner = {};
  for (std::size_t k = 0; k < 4; ++k) winner[k] = cell.contact_of(d[k], at(d[k]).x);
  std::vector<std::pair<SupportSample, SupportSample>> found;
  for (const auto& [a, b] : sides) {
    if (winner[a] == winner[b] || glm::distance(at(d[a]).x, at(d[b]).x) <= extent_) continue;
    found.emplace_back(at(d[a]), at(d[b]));
  }
  return found;
}

}  // namespace taut
