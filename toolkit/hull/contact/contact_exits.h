#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "taut/hull/contact/contact_system.h"

namespace taut {

/// A way in which a contact that moves with its direction leaves its element: where a margin that
/// is positive inside falls to zero.
struct ContactExit {
  enum class Kind {
    side,  ///< a face's contact reaches the side `index` of its patch
    end,   ///< an edge's contact reaches the end `index` of its piece
    face,  ///< an edge's contact slides into the face at ContactGeometry::sides()[index]
    edge,  ///< a vertex's contact slides onto the edge at ContactGeometry::ends()[index]
  };
  Kind kind = Kind::side;
  int index = 0;
};

/// The exits that contacts of this element have; none onto straight edges.
std::vector<ContactExit> exits(const ContactGeometry& geometry, const Contact& c);

/// The exit's margin of contact i, linearised: a parameter's distance from its end, or the sine of
/// the angle by which the direction misses the face's normal or the plane across the edge.
LinearEquation exit_margin(const ContactGeometry& geometry, const CommonSupport& s, int i,
                           const ContactExit& exit);

/// The length of the derivative by which the exit's margin is measured at a contact: what rounding
/// moves the margin by is a length over it.
double exit_length(const ContactGeometry& geometry, const Contact& c, const ContactExit& exit);

/// Of two contacts that part, i the one of them: where the direction turns into its own region, it
/// moves over the exit at which it stands. False where its element is flat.
bool extends_over(const ContactGeometry& geometry, const CommonSupport& s, int i,
                  const ContactExit& exit);

/// To the same point in another element, not into what an edge or a vertex bounds.
bool leads_over_border(const ContactExit& exit);

/// The contact is on the side or at the end at which the exit lies.
bool stands_at(const Contact& c, const ContactExit& exit);

/// The contact moved to the side or end at which the exit lies.
Contact at_exit(Contact c, const ContactExit& exit);

/// The contact beyond the exit at which it stands: the same point in the next element. None where
/// there is no next one that is known (the pole of a collapsed side).
std::optional<Contact> beyond(const ContactGeometry& geometry, const Contact& c,
                              const ContactExit& exit);

/// The vertex as the ends of all pieces that have it.
std::vector<Contact> piece_ends(const ContactGeometry& geometry, const Contact& vertex);

/// Follows an edge from the end of a piece on. `visit` gets each piece at its beginning and at its
/// end, and tells whether what was looked for is there, or ends the search. False where the edge
/// ends before.
enum class EdgeVisit { found, lost, on };
bool found_on_edge(const ContactGeometry& geometry, const Contact& from,
                   const std::function<EdgeVisit(const Contact& begin, const Contact& end)>& visit);

/// A side collapsed to a point at which the surface is smooth.
bool is_pole(const ContactGeometry& geometry, const Contact& c, Side side);

/// The collapsed side, be it a pole, a tip or a corner, on which a contact lies, up to rounding.
std::optional<Side> collapsed_side(const ContactGeometry& geometry, const Contact& c);

/// The side at whose pole the contact lies, if it does; parameters fail there.
std::optional<Side> pole_side(const ContactGeometry& geometry, const Contact& c);

/// The outward normal in the direction of Su x Sv at the contact, in the scene's frame; at a pole
/// the limit. Zero where there is none.
dvec3 unit_normal(const ContactGeometry& geometry, const Contact& c);

/// How far the rounding of coordinates may have turned the normal at a pole, in radians.
/// @pre the contact lies at a pole
double pole_turn(const ContactGeometry& geometry, const Contact& pole);

/// The contact about the pole, in whichever patch, that supports locally in a direction near the
/// pole's normal. @pre the contact lies at a pole
std::optional<Contact> beside_pole(const ContactGeometry& geometry, const Contact& pole,
                                   const dvec3& n);

/// The contact in its canonical form where it supports in the direction n; inside of a straight
/// edge or of a ruled patch, which support only together with the ends of the segments in them, the
/// higher of these ends.
Contact at_rest(const ContactGeometry& geometry, const Contact& c, const dvec3& n);

/// The contact on those borders and ends of its element from which it is no farther than this.
Contact moved_to_border(const ContactGeometry& geometry, Contact c, double distance);

/// The contact in its canonical form where it lies within rounding of a border, an end or a pole:
/// no farther than `distance`.
Contact snapped(const ContactGeometry& geometry, const Contact& c, double distance);

/// The normal form of a contact on a collapsed side, where the parameter along the side is any: at
/// that of a contact of the same element beside it, from which a curve comes. Others are as they
/// are.
Contact turned_to(const ContactGeometry& geometry, Contact c, const Contact& beside);

/// The point of `c` as a contact of the element of `other`, in whose border it lies, turned to
/// `other`. None if it does not.
std::optional<Contact> expressed_in(const ContactGeometry& geometry, const Contact& c,
                                    const Contact& other);

/// The local maximum of x . n that a climb from the contact leads to, over smooth joins, onto and
/// off edges and vertices. None where the climb gets lost.
std::optional<Contact> climbed(const ContactGeometry& geometry, Contact c, const dvec3& n);

}  // namespace taut
