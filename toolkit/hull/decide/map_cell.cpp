#include "taut/hull/decide/map_cell.h"

#include <algorithm>

#include "taut/hull/decide/direction_map.h"

namespace taut {
namespace {

/// In units of the resolution over the width of facets: how far their normals may part.
constexpr double facet_slack = 4;

/// Of a contact and its translates, of which boxes may be nearly the same.
std::size_t farthest_translate(const std::vector<MapCell::Translate>& all, std::size_t contact,
                               const dvec3& d) {
  if (contact >= all.size()) return contact;
  std::size_t best = contact;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].of == all[contact].of && glm::dot(all[k].by - all[best].by, d) > 0) best = k;
  }
  return best;
}

/// What is known of the normal of a cell's plane.
struct NormalBall {
  dvec3 center;
  double radius;
};

/// From the points that touch it or, where they are nearly in line, from where the cell is: the
/// normal is in it or beside it, by no more than its width.
NormalBall normal_of(const MapCell& cell, double resolution) {
  const auto d = DirectionMap::corners(cell);
  const dvec3 middle = unit(d[0] + d[3]);
  double reach = 0;
  for (const dvec3& corner : d) reach = std::max(reach, glm::distance(unit(corner), middle));
  const double off = facet_slack * resolution / cell.width;
  return off <= 2 * reach ? NormalBall{cell.normal, off} : NormalBall{middle, 2 * reach};
}

}  // namespace

bool MapCell::shares_plane(const MapCell& other, double resolution) const {
  const NormalBall a = normal_of(*this, resolution);
  const NormalBall b = normal_of(other, resolution);
  return glm::distance(a.center, b.center) <= a.radius + b.radius;
}

std::size_t MapCell::contact_of(const dvec3& d, const dvec3& x) const {
  if (!rounds.empty()) {
    const auto height = [&](const Round& round) {
      return glm::dot(round.center, d) + glm::length(round.root * d);
    };
    const auto highest =
        std::max_element(rounds.begin(), rounds.end(),
                         [&](const Round& a, const Round& b) { return height(a) < height(b); });
    return std::size_t(highest - rounds.begin());
  }
  const auto best =
      std::min_element(contacts.begin(), contacts.end(),
                       [&](const Box& a, const Box& b) { return distance(a, x) < distance(b, x); });
  return farthest_translate(translates, std::size_t(best - contacts.begin()), d);
}

std::size_t MapCell::told_contact_of(const dvec3& d, const dvec3& x) const {
  const std::size_t nearest = contact_of(d, x);
  if (int(nearest) < apart) return nearest;
  const auto height = [&](const Box& box) {
    return glm::dot(glm::max(d * box.lower, d * box.upper), dvec3(1.0));
  };
  const auto highest =
      std::max_element(contacts.begin(), contacts.begin() + apart,
                       [&](const Box& a, const Box& b) { return height(a) < height(b); });
  return std::size_t(highest - contacts.begin());
}

}  // namespace taut
