#include "taut/hull/trace/edge_stretches.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "taut/hull/contact/facet_contacts.h"

namespace taut {
namespace {

bool has_area(const FacetContacts& f, const dvec3& n) {
  dvec3 area(0.0);
  for (std::size_t k = 1; k + 1 < f.points.size(); ++k) {
    area += glm::cross(f.points[k] - f.points[0], f.points[k + 1] - f.points[0]);
  }
  return glm::dot(area, n) > same_contact;
}

/// A facet's outline, corner by corner.
class Outline {
 public:
  explicit Outline(const ContactGeometry& geometry) : geometry_(geometry) {}

  /// A corner and the side that begins there; instead of the last one if that is in its place.
  void add(const Contact& c, const EdgeStretch& side) {
    const dvec3 x = geometry_.point(c);
    if (!facet_.points.empty() && glm::distance(facet_.points.back(), x) < same_contact) {
      facet_.sides.back() = side;
      return;
    }
    facet_.contacts.push_back(c);
    facet_.points.push_back(x);
    facet_.sides.push_back(side);
  }
  FacetContacts facet() && { return std::move(facet_); }

 private:
  const ContactGeometry& geometry_;
  FacetContacts facet_;
};

/// The facet of no area between the edge and what leads along it; to the left of that.
FacetContacts around(const ContactGeometry& geometry, const SideParts& parts) {
  Outline result(geometry);
  for (const SidePart& part : parts.parts) result.add(part.begin, part.stretch);
  result.add(parts.end, {});
  return std::move(result).facet();
}

/// What leads along the segment, in this order.
std::map<double, const SideParts*> parts_along(const ContactGeometry& geometry, const dvec3& from,
                                               const dvec3& to,
                                               const std::vector<const SideParts*>& all) {
  std::map<double, const SideParts*> result;
  const dvec3 along = unit(to - from);
  for (const SideParts* own : all) {
    const dvec3 a = geometry.point(own->parts.front().begin) - from;
    const dvec3 b = geometry.point(own->end) - from;
    if (glm::length(glm::cross(along, a)) > same_contact ||
        glm::length(glm::cross(along, b)) > same_contact) {
      continue;
    }
    const double begin = glm::dot(along, a);
    const double end = glm::dot(along, b);
    const bool within =
        begin > -same_contact && end > begin && end < glm::distance(from, to) + same_contact;
    if (within) result[begin] = own;
  }
  return result;
}

std::vector<const SideParts*> in_plane(const dvec3& n, const std::vector<TouchedStretch>& all) {
  std::vector<const SideParts*> result;
  for (const TouchedStretch& own : all) {
    if (glm::distance(own.n, n) <= same_plane) result.push_back(&own.side);
  }
  return result;
}

}  // namespace

FacetContacts with_stretches(const ContactGeometry& geometry, const dvec3& n,
                             const FacetContacts& f, const std::vector<TouchedStretch>& stretches) {
  const std::vector<const SideParts*> all = in_plane(n, stretches);
  if (all.empty()) return f;
  Outline result(geometry);
  for (std::size_t k = 0; k < f.points.size(); ++k) {
    result.add(f.contacts[k], f.sides.empty() ? EdgeStretch() : f.sides[k]);
    if (f.is_curved(k)) continue;
    const dvec3& to = f.points[(k + 1) % f.points.size()];
    for (const auto& [at, own] : parts_along(geometry, f.points[k], to, all)) {
      for (const SidePart& part : own->parts) result.add(part.begin, part.stretch);
      if (glm::distance(geometry.point(own->end), to) > same_contact) result.add(own->end, {});
    }
  }
  return std::move(result).facet();
}

std::vector<Landmark> edge_stretches(const ContactGeometry& geometry, SupportQuery& query,
                                     const std::vector<TouchedStretch>& stretches) {
  std::vector<Landmark> result;
  std::vector<dvec3> done;
  for (const TouchedStretch& own : stretches) {
    const auto is_known = [&](const dvec3& n) { return glm::distance(n, own.n) <= same_plane; };
    if (std::any_of(done.begin(), done.end(), is_known)) continue;
    const SideParts& side = own.side;
    const std::optional<FacetContacts> facet =
        facet_contacts(geometry, query, own.n, {side.parts.front().begin, side.end});
    if (facet && has_area(*facet, own.n)) {
      done.push_back(own.n);
      Landmark landmark{own.n, with_stretches(geometry, own.n, *facet, stretches)};
      if (landmark.facet.is_curved() || side.has_chords()) result.push_back(std::move(landmark));
    } else if (own.is_whole && side.has_chords() && side.parts.size() > 1) {
      result.push_back({own.n, around(geometry, side)});
    }
  }
  return result;
}

}  // namespace taut
