#include "taut/hull/solve/facet_corners.h"

#include "taut/bounds/contact_forms.h"

namespace taut {
namespace {

void erase(std::size_t k, FacetContacts& facet) {
  const auto at = std::ptrdiff_t(k);
  facet.contacts.erase(facet.contacts.begin() + at);
  facet.points.erase(facet.points.begin() + at);
  facet.sides.erase(facet.sides.begin() + at);
}

}  // namespace

void unite_corners(const ContactGeometry& geometry, double distance, FacetContacts& facet) {
  if (facet.sides.empty()) return;
  for (EdgeStretch& s : facet.sides) {
    if (s.piece < 0) continue;
    s.from = moved_to_border(geometry, s.at(s.from), distance).u;
    s.to = moved_to_border(geometry, s.at(s.to), distance).u;
  }
  for (std::size_t k = 0; k < facet.contacts.size(); ++k) {
    Contact& c = facet.contacts[k];
    c = facet.is_curved(k) ? facet.sides[k].at(facet.sides[k].from)
                           : moved_to_border(geometry, c, distance);
    facet.points[k] = geometry.point(c);
  }
  // A corner with a curved side behind it stays, as that begins there.
  for (std::size_t k = 0; k < facet.contacts.size() && facet.contacts.size() > 2;) {
    const std::size_t next = (k + 1) % facet.contacts.size();
    const bool is_one =
        !facet.is_curved(k) && glm::distance(facet.points[k], facet.points[next]) <= distance;
    if (is_one) {
      erase(k, facet);
    } else {
      ++k;
    }
  }
}

}  // namespace taut
