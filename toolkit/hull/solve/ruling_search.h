#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/decide/map_graph.h"

namespace taut {

/// A point of the model that supports in a direction.
struct SupportingContact {
  dvec3 n = dvec3(0.0);
  Contact contact;  ///< at rest: inside of no straight segment
  dvec3 x = dvec3(0.0);
};

/// Finds rulings between directions in which different contacts support. There is always one: the
/// support function itself brackets it.
class RulingSearch {
 public:
  /// All must outlive it.
  RulingSearch(const ContactSystem& system, SupportQuery& query, const DirectionMap& map);

  const ContactSystem& system() const { return system_; }
  const ContactGeometry& geometry() const { return geometry_; }
  const DirectionMap& map() const { return map_; }
  SupportQuery& query() const { return query_; }
  /// The resolution to which places are known: no coarser than surfaces are.
  double place_resolution() const { return place_resolution_; }
  /// How far from each other places may be that rounding of the model makes one: as far as a
  /// contact extends. 0 where it is not rounded.
  double place_extent() const { return place_extent_; }
  /// What way from one ruling to another is none: the two are next to each other.
  double least_way() const;

  SupportingContact supporting(const dvec3& n, const Contact& hint) const;

  /// Where an arc passes between two cells. By Newton's method with what supports on either side,
  /// or where that fails by bisection down to rounding.
  Ruling at(const MapCrossing& crossing) const;

  /// Between two rulings of an arc, near the middle of their directions, across the way from the
  /// one to the other. None if the same contact supports to both sides of it.
  std::optional<Ruling> between(const Ruling& from, const Ruling& to) const;

  /// How far the contacts are below the supporting plane.
  double depth(const Ruling& ruling) const;
  /// The contact of a patch supports in one of the two directions of the patch's own normal there,
  /// to within a few times the resolution.
  bool touches(const Contact& c) const;

 private:
  /// By how much others may be above contacts that support.
  double touching() const {
    return std::max({geometry_.tie(), map_.bent, map_.covered_edges.empty() ? 0 : map_.resolution});
  }
  /// The other end of the line of a ruled patch that ends in a covered edge, where that is not
  /// covered; else the contact itself.
  Contact uncovered(const Contact& c, const dvec3& n) const;
  /// A climb that ends so.
  ClimbedContact uncovered_climb(const Contact& c, const dvec3& n) const;

  /// The ruling with contacts near these, n in the plane across `across`. None if Newton's method
  /// does not converge, the contacts are one, or something is higher by more than so much.
  std::optional<Ruling> polished(const dvec3& n, const std::array<Contact, 2>& contacts,
                                 const dvec3& across, double depth_limit) const;

  bool rises_little(const dvec3& n, const Contact& from, const Contact& to) const;
  std::optional<Contact> on_bent(const Contact& c) const;
  std::optional<Contact> beyond_end(const Contact& c) const;
  bool keep_on_bent(CommonSupport& s, LinearEquation equation) const;
  void keep_on_sides(CommonSupport& s, LinearEquation equation) const;

  /// The ruling with contacts that lie on a border, or where others end, told as ones of the
  /// element into which their own regions extend.
  Ruling settled(Ruling ruling) const;

  /// Which of two contacts supports, 0 or 1, and whether it is that one indeed: where it is
  /// neither, it is the one to whose side it is, to within the resolution, if that is known.
  struct Likeness {
    static constexpr int unknown = -1;
    int side = 0;
    bool is_like = true;
  };
  using Which = std::function<Likeness(const SupportingContact&)>;
  SupportingContact climbed_from(const SupportingContact& s, const dvec3& n) const;
  std::array<SupportingContact, 2> narrowed(const SupportingContact& right,
                                            const SupportingContact& left,
                                            const Which& which) const;
  /// `apart`: the way from the left contact to the right one where these are on translates of each
  /// other, or hardly farther from each other than such: directions do not tell which one it is.
  /// Zero where these tell.
  Ruling bracketed(SupportingContact right, SupportingContact left, const Which& which,
                   const dvec3& apart) const;
  static bool is_right(const Ruling& found, const Which& which, const dvec3& apart);

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DirectionMap& map_;
  const double place_resolution_;
  const double place_extent_;
};

}  // namespace taut
