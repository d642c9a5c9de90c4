#pragma once

#include <functional>
#include <optional>

#include "taut/hull/contact/supporting_poles.h"
#include "taut/hull/trace/curve_point.h"

namespace taut {

/// A contact at the pole of its side, at the same parameter along the side.
Contact at_pole(Contact c, Side side);

/// The contact at the pole that its patch has at x, at the same parameter along the side; none if
/// it has none there.
std::optional<Contact> at_pole_of(const ContactGeometry& geometry, const Contact& c,
                                  const dvec3& x);

/// The point of a contact as one of the element of `other`; a pole's at the parameter of `other`
/// along its side.
std::optional<Contact> in_element(const ContactGeometry& geometry, const Contact& c,
                                  const Contact& other);

/// Takes a point of a separating curve where its tangent does not tell how it goes on, at poles and
/// where elements are flat: away from there, into it, and past it. Along chords.
class PolePassage {
 public:
  /// The point outlives it.
  explicit PolePassage(CurvePoint& point)
      : geometry_(point.geometry()), system_(point.system()), point_(point) {}

  /// Whether a contact may move without the direction, or its parameters fail: at a pole, and where
  /// its element is flat along some direction.
  bool is_singular(int contact) const;
  /// Takes the first step away from a common support of which contacts are singular. The support as
  /// a ruling of the elements that the point is in then, or none: the point stays. `largest`: the
  /// most by which n is turned.
  std::optional<Ruling> leave(double largest = longest_turn);
  /// The same where the two are the ends of a chord of a segment that touches faces: what supports
  /// beside it jumps from the one to the other.
  std::optional<Ruling> leave_chord();
  /// Goes to a pole, where the patch's parameters fail, if the curve does so to within
  /// geometry.tie(), in a step of this length.
  bool reach(int contact, Side side, double length);
  /// The ruling with which the curve arrives in a landmark that lies within a step of this length.
  std::optional<Ruling> arrival(const Landmark& landmark, double length) const;
  /// The support in which both contacts come to ends of edges that have no bend there or to sides
  /// across which their patches are level, if these lie within a step of this length; beside a
  /// face's contact the other one may rest at a vertex. The direction turns with the square of
  /// their ways, so that next to the ends rounding moves them by the root of itself. Also where
  /// contacts stop to be inside of such patches (swell_end).
  std::optional<CommonSupport> at_flat_ends(double length) const;
  /// Takes the first step beyond the ends that both contacts have reached so, the way that they
  /// came. The support as a ruling of the elements that the point is in then, or none: the point
  /// stays.
  std::optional<Ruling> go_on();

 private:
  static constexpr double longest_turn = 1e-3;

  std::optional<Contact> over_ends(int i) const;
  std::optional<Ruling> leave(double largest,
                              const std::function<std::optional<Ruling>(double)>& by_step);
  std::optional<Ruling> leave(double step, double tilt, bool climbs);
  std::optional<Ruling> leave_to(const std::optional<CommonSupport>& about, double step);
  dvec3 turn_ahead() const;
  std::optional<CommonSupport> stepped_aside(double step, double tilt, bool climbs) const;
  std::optional<CommonSupport> at_jump(double step) const;
  std::optional<CommonSupport> corrected_aside(CommonSupport next, double step) const;
  std::optional<Contact> aside(int i, double tilt, const dvec3& n, bool climbs) const;
  std::optional<Contact> end_ahead(int i, double length) const;
  std::optional<Contact> plane_corner_ahead(int i, double length) const;
  bool in_plane_corner(const CommonSupport& s) const;
  bool is_flat_corner(const Contact& c) const;
  std::optional<Side> level_side(const Contact& c) const;
  std::optional<CommonSupport> at_swell_end(const CommonSupport& end, double length) const;
  bool is_tangent(const CommonSupport& end) const;
  bool cross_side(int i, Contact& c, double length) const;
  bool is_flat_end(const Contact& c, const ContactJet& jet, const dvec3& n) const;
  dvec3 common_normal(const CommonSupport& end) const;
  std::optional<std::size_t> nearest_side(const FacetContacts& facet) const;

  const ContactGeometry& geometry_;
  const ContactSystem& system_;
  CurvePoint& point_;
};

}  // namespace taut
