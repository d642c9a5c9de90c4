#include "taut/hull/solve/crossings.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/core/geometry.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/solve/merged_ends.h"

namespace taut {
namespace {

/// How often the point is looked for anew with contacts that have left their elements.
constexpr int most_restarts = 4;
/// How much farther away the point may be than the contacts beside it are from each other.
constexpr double farthest_crossing = 32;
/// Contacts are on a border where rounding moves them off it by no more.
constexpr double on_border = 1e-9;

double border_reach(const RulingSearch& search) {
  return std::max(on_border, search.place_extent());
}

/// Of a contact, those that no border holds.
std::vector<std::size_t> free_parameters(const ContactGeometry& geometry, const Contact& c) {
  std::vector<std::size_t> free;
  for (int k = 0; k < geometry.jet(c).dimension; ++k) {
    const double t = parameters(c)[k];
    if (0 < t && t < 1) free.push_back(std::size_t(k));
  }
  return free;
}

/// The contact nearest to a place next to it, along its free parameters.
Contact slid_to(const ContactGeometry& geometry, Contact c, const dvec3& place) {
  for (const std::size_t k : free_parameters(geometry, c)) {
    const ContactJet jet = geometry.jet(c);
    double& t = k == 0 ? c.u : c.v;
    const double square = glm::dot(jet.dx[k], jet.dx[k]);
    if (square > 0) t = std::clamp(t + glm::dot(place - jet.x, jet.dx[k]) / square, 0.0, 1.0);
  }
  return c;
}

/// Where the two surfaces of a ruling touch, next to it: no farther off each other than the
/// resolution.
std::optional<Ruling> touching_next_to(const RulingSearch& search, const Ruling& beside) {
  const ContactGeometry& geometry = search.geometry();
  const double length = glm::distance(beside.point[0], beside.point[1]);
  const bool on_face =
      beside.contact[0].kind == SourceKind::face || beside.contact[1].kind == SourceKind::face;
  if (!on_face || length > merging_distance(geometry) ||
      continues(geometry, beside.contact[0], beside.contact[1])) {
    return std::nullopt;
  }
  CommonSupport at(geometry, beside);
  for (int k = 0; k < most_restarts; ++k) {
    const auto found = search.system().crossing(at, search.map().resolution);
    if (!found) return std::nullopt;
    at = *found;
    bool moved = false;
    for (const std::size_t i : {0u, 1u}) {
      Contact& c = at.contact[i];
      const Contact inside = clamped(c);
      if (glm::distance(geometry.point(inside), geometry.point(c)) <= border_reach(search)) {
        c = inside;
        continue;
      }
      const std::optional<Contact> there = climbed(geometry, inside, at.n);
      if (!there || same_element(*there, c)) return std::nullopt;
      c = geometry.first(*there);
      moved = true;
    }
    at.evaluate(geometry);
    if (moved) continue;
    const Ruling found_there = at.ruling();
    const double way = std::max({glm::distance(found_there.n, beside.n),
                                 glm::distance(found_there.point[0], beside.point[0]),
                                 glm::distance(found_there.point[1], beside.point[1])});
    if (way > farthest_crossing * length) return std::nullopt;
    if (search.depth(found_there) > search.map().resolution) return std::nullopt;
    return found_there;
  }
  return std::nullopt;
}

bool are_one(const Ruling& a, const Ruling& b, double extent) {
  return glm::distance(a.n, b.n) <= extent && glm::distance(a.point[0], b.point[0]) <= extent;
}

std::vector<Ruling> touching_in(const RulingSearch& search, const KnownArcs& known,
                                const MapGraph::Node& node) {
  if (node.is_facet) return {};
  std::vector<Ruling> beside;
  for (const MapGraph::End& end : node.ends) beside.push_back(known.ruling_at(end));
  return touching_beside(search, beside);
}

/// Counter-clockwise from outside, as arcs leave.
void sort_about(const dvec3& n, const KnownArcs& known, std::vector<MapGraph::End>& ends) {
  const std::array<dvec3, 2> frame = tangent_frame(n);
  const auto angle = [&](const MapGraph::End& end) {
    const dvec3 out = known.ruling_at(end).n - n;
    return std::atan2(glm::dot(out, frame[1]), glm::dot(out, frame[0]));
  };
  std::stable_sort(ends.begin(), ends.end(),
                   [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
}

}  // namespace

std::vector<Ruling> touching_beside(const RulingSearch& search, const std::vector<Ruling>& beside) {
  std::vector<Ruling> found;
  for (const Ruling& r : beside) {
    const std::optional<Ruling> own = touching_next_to(search, r);
    if (!own || (!found.empty() && !are_one(found[0], *own, search.map().contact_extent()))) {
      return {};
    }
    found.push_back(*own);
  }
  return found;
}

void join_crossings(const RulingSearch& search, KnownArcs& known) {
  const double extent = search.map().contact_extent();
  struct Place {
    Ruling at;
    std::size_t node;
  };
  std::vector<Place> places;
  std::vector<MapGraph::Node> nodes;
  for (MapGraph::Node& node : known.graph.nodes) {
    const std::vector<Ruling> found = touching_in(search, known, node);
    const auto same = std::find_if(places.begin(), places.end(), [&](const Place& p) {
      return !found.empty() && are_one(p.at, found[0], extent);
    });
    if (same == places.end()) {
      if (!found.empty()) places.push_back({found[0], nodes.size()});
      nodes.push_back(std::move(node));
      continue;
    }
    MapGraph::Node& to = nodes[same->node];
    to.ends.insert(to.ends.end(), node.ends.begin(), node.ends.end());
    to.cells.insert(to.cells.end(), node.cells.begin(), node.cells.end());
  }
  if (nodes.size() == known.graph.nodes.size()) {
    known.graph.nodes = std::move(nodes);
    return;
  }
  for (const Place& p : places) sort_about(p.at.n, known, nodes[p.node].ends);
  known.graph.nodes = std::move(nodes);
  for (std::size_t k = 0; k < known.graph.nodes.size(); ++k) {
    for (const MapGraph::End& end : known.graph.nodes[k].ends) {
      known.graph.arcs[std::size_t(end.arc)].node[std::size_t(end.end)] = int(k);
    }
  }
}

std::optional<FacetNode> crossing_of(const RulingSearch& search, const KnownArcs& known,
                                     const MapGraph::Node& node) {
  if (node.ends.size() < 2) return std::nullopt;
  const ContactGeometry& geometry = search.geometry();
  const std::vector<Ruling> found = touching_in(search, known, node);
  if (found.empty()) return std::nullopt;
  FacetNode crossing;
  crossing.is_crossing = true;
  crossing.n = found[0].n;
  for (std::size_t k = 0; k < found.size(); ++k) {
    Contact own = moved_to_border(geometry, found[k].contact[node.ends[k].end == 0 ? 0 : 1],
                                  border_reach(search));
    // One place for all that are of one surface.
    for (const Contact& before : crossing.contacts) {
      if (const auto there = expressed_in(geometry, before, own)) own = *there;
    }
    crossing.contacts.push_back(own);
  }
  // In the place that is held by borders, and others as near to it as theirs let them be.
  const auto held = std::min_element(
      crossing.contacts.begin(), crossing.contacts.end(), [&](const Contact& a, const Contact& b) {
        return free_parameters(geometry, a).size() < free_parameters(geometry, b).size();
      });
  const dvec3 place = geometry.point(*held);
  for (Contact& c : crossing.contacts) c = slid_to(geometry, c, place);
  crossing.points.assign(crossing.contacts.size(), place);
  crossing.slots.assign(crossing.contacts.size(), {});
  return crossing;
}

}  // namespace taut
