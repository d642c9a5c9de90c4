#include "taut/envelope/climbed_contact.h"

#include "taut/bounds/contact_climb.h"

namespace taut {

ClimbedContact climb(const ContactGeometry& geometry, const Contact& start, const dvec3& n) {
  const dvec3 from = geometry.point(start);
  ClimbedContact result{geometry.canonical(start), start, from, glm::dot(from, n)};
  const std::optional<Contact> top = climbed(geometry, start, n);
  if (!top) return result;
  const dvec3 x = geometry.point(*top);
  const double h = glm::dot(x, n);
  if (h > result.h) result = {geometry.canonical(*top), *top, x, h};
  return result;
}

}  // namespace taut
