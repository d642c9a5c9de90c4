#include "taut/hull/decide/map_cell.h"

#include <algorithm>

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

}  // namespace

bool MapCell::shares_plane(const MapCell& other, double resolution) const {
  const double slack = facet_slack * resolution / std::min(width, other.width);
  return glm::dot(normal, other.normal) > 0 &&
         glm::length(glm::cross(normal, other.normal)) <= slack;
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
