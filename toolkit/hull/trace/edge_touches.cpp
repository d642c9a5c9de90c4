#include "taut/hull/trace/edge_touches.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/parabolic_sides.h"
#include "taut/hull/contact/sign_changes.h"

namespace taut {
namespace {

class TouchSearch {
 public:
  TouchSearch(const ContactGeometry& geometry, SupportQuery& query)
      : geometry_(geometry), query_(query) {}

  void search_patch(const Contact& patch);
  std::vector<Landmark> landmarks();

 private:
  /// Contacts of one direction: the ends of an edge and those between them.
  struct Touch {
    dvec3 n;
    std::vector<Contact> contacts;
  };
  std::vector<double> places(const Contact& patch, Side side) const;
  void offer(const Contact& c, const Contact& edge);
  void add(const dvec3& n, const std::array<Contact, 2>& ends, const Contact& c);

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  std::vector<Touch> touches_;
};

/// Where the twist changes sign; over the side's ends, where other patches go on, it may do so too.
std::vector<double> TouchSearch::places(const Contact& patch, Side side) const {
  const auto twist = [&](double t) {
    const Contact c = on_side_of(patch, side, t);
    return glm::dot(geometry_.jet(c).dxy, unit_normal(geometry_, c));
  };
  if (vanishes(twist)) return {};
  std::vector<double> result = {0, 1};
  for (const double root : sign_changes(twist)) {
    if (placed(root) != 0 && placed(root) != 1) result.push_back(root);
  }
  return result;
}

void TouchSearch::add(const dvec3& n, const std::array<Contact, 2>& ends, const Contact& c) {
  const auto known = std::find_if(touches_.begin(), touches_.end(), [&](const Touch& touch) {
    return glm::distance(touch.n, n) < same_plane && same_element(touch.contacts[0], ends[0]) &&
           same_element(touch.contacts[1], ends[1]);
  });
  if (known == touches_.end()) {
    touches_.push_back({n, {ends[0], ends[1], c}});
    return;
  }
  const dvec3 x = geometry_.point(c);
  const bool again =
      std::any_of(known->contacts.begin(), known->contacts.end(), [&](const Contact& other) {
        return glm::distance(geometry_.point(other), x) < same_contact;
      });
  if (!again) known->contacts.push_back(c);
}

/// Takes the face's contact on the edge if it supports the model.
void TouchSearch::offer(const Contact& c, const Contact& edge) {
  const std::array<Contact, 2> ends = segment_ends(geometry_, edge);
  const dvec3 x = geometry_.point(c);
  for (const Contact& end : ends) {
    if (glm::distance(geometry_.point(end), x) <= same_contact) return;
  }
  const dvec3 normal = unit_normal(geometry_, c);
  if (normal == dvec3(0.0)) return;
  for (const dvec3& n : {normal, -normal}) {
    if (query_(n, c).h <= glm::dot(x, n) + geometry_.tie()) add(n, ends, c);
  }
}

void TouchSearch::search_patch(const Contact& patch) {
  if (geometry_.is_repeated(patch) || geometry_.is_ruled(patch)) return;
  for (const Side side : all_sides) {
    const std::optional<Contact> edge = straight_piece(geometry_, patch, side);
    if (!edge) continue;
    for (const double t : places(patch, side)) offer(on_side_of(patch, side, t), *edge);
  }
}

std::vector<Landmark> TouchSearch::landmarks() {
  std::vector<Landmark> result;
  for (const Touch& touch : touches_) {
    std::optional<FacetContacts> f = facet_contacts(geometry_, query_, touch.n, touch.contacts);
    if (f && f->is_facet()) result.push_back({touch.n, std::move(*f)});
  }
  return result;
}

}  // namespace

std::vector<Landmark> edge_touches(const ContactGeometry& geometry, SupportQuery& query,
                                   const std::vector<CulledCell>& cells) {
  TouchSearch search(geometry, query);
  for (const auto& [instance, patch] : mixed_patches(cells)) {
    search.search_patch({instance, SourceKind::face, patch, 0, 0});
  }
  return search.landmarks();
}

}  // namespace taut
