#include "taut/hull/contact/in_line_contacts.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {
namespace {

/// The turn to a side of the line: contacts that move gain half of its square times their radius of
/// curvature, or more.
constexpr double aside_turn = 1e-4;
/// Gains that are no larger, in units of what heights tie over, are rounding.
constexpr double least_gain = 8;

/// A contact of a line, seen from beside.
struct Gain {
  std::size_t contact;
  double place;   ///< along the line
  double height;  ///< in a direction to the side
};

}  // namespace

bool is_in_line(const dvec3& a, const dvec3& b, const dvec3& x) {
  return glm::length(glm::cross(x - a, unit(b - a))) <= same_contact;
}

std::vector<Contact> around_line(const ContactGeometry& geometry,
                                 const std::vector<Contact>& contacts, const dvec3& n) {
  const dvec3 x = geometry.point(contacts.front());
  dvec3 along(0.0);
  for (const Contact& c : contacts) {
    const dvec3 off = geometry.point(c) - x;
    if (glm::length(off) > glm::length(along)) along = off;
  }
  along = unit(along);
  std::vector<Contact> result;
  for (const double sense : {1.0, -1.0}) {
    const dvec3 aside = glm::normalize(n + aside_turn * glm::cross(sense * along, n));
    std::vector<Gain> line;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const double place = sense * glm::dot(geometry.point(contacts[k]) - x, along);
      const bool known = std::any_of(line.begin(), line.end(), [&](const Gain& g) {
        return std::abs(g.place - place) <= same_contact;
      });
      if (known) continue;
      const Contact moved = climbed(geometry, contacts[k], aside).value_or(contacts[k]);
      line.push_back({k, place, glm::dot(geometry.point(moved), aside)});
    }
    std::stable_sort(line.begin(), line.end(),
                     [](const Gain& a, const Gain& b) { return a.place < b.place; });
    // The upper outline.
    std::vector<Gain> chain;
    for (const Gain& g : line) {
      const auto hides = [&](const Gain& a, const Gain& b) {
        const double share = (b.place - a.place) / (g.place - a.place);
        return b.height <= (1 - share) * a.height + share * g.height + least_gain * geometry.tie();
      };
      while (chain.size() > 1 && hides(chain[chain.size() - 2], chain.back())) chain.pop_back();
      chain.push_back(g);
    }
    // The last one begins the way back.
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      result.push_back(contacts[chain[k].contact]);
    }
  }
  return result;
}

}  // namespace taut
