#include "taut/hull/mesh/reached_heights.h"

#include <algorithm>
#include <array>
#include <map>

#include "taut/bounds/contact_climb.h"

namespace taut {
namespace {

/// Places of a patch from which climbs may begin, along each parameter: their distance is that of
/// maxima of degrees that models have.
constexpr int places_a_side = 5;

/// Elements from which climbs begin, those with the nearest places.
constexpr std::size_t elements_tried = 8;

}  // namespace

ReachedHeights::ReachedHeights(const ContactGeometry& geometry, const HullBoundary& boundary,
                               const ContactFaces& faces)
    : geometry_(geometry), faces_(faces) {
  std::map<std::array<int, 3>, std::vector<Place>> found;
  const auto add = [&](const Contact& c) {
    if (c.instance < 0) return;
    found[{c.instance, int(c.kind), c.element}].push_back({c, geometry_.point(c)});
  };
  for (const HullFace& face : boundary.faces) {
    for (const Contact& c : face.contacts) add(c);
    for (const PatchRegion& region : face.regions) {
      for (int i = 0; i < places_a_side; ++i) {
        for (int k = 0; k < places_a_side; ++k) {
          const auto at = [](int place) { return (place + 0.5) / places_a_side; };
          add({region.instance, SourceKind::face, region.patch, at(i), at(k)});
        }
      }
    }
  }
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      const Ruling& middle = piece.rulings[piece.rulings.size() / 2];
      for (const Contact& c : middle.contact) add(c);
    }
  }
  places_.reserve(found.size());
  for (auto& [element, places] : found) places_.push_back(std::move(places));
}

bool ReachedHeights::reaches(const dvec3& n, double height, const dvec3& near) const {
  std::vector<std::pair<double, const Place*>> nearest;
  for (const std::vector<Place>& places : places_) {
    std::pair<double, const Place*> best = {infinity, nullptr};
    for (const Place& place : places) {
      const double distance = glm::distance(place.x, near);
      if (distance < best.first) best = {distance, &place};
    }
    if (best.second != nullptr) nearest.push_back(best);
  }
  const std::size_t tried = std::min(nearest.size(), elements_tried);
  std::stable_sort(nearest.begin(), nearest.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  nearest.resize(tried);
  return std::any_of(nearest.begin(), nearest.end(), [&](const auto& from) {
    const ClimbedContact top = climb(geometry_, from.second->contact, n);
    return top.h >= height && !faces_.surely_uncovered(top.contact);
  });
}

}  // namespace taut
