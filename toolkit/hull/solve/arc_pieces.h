#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Pieces of arcs up to this long, in (n, x_0, x_1), may be none: where rounding may make as much
/// of nothing.
inline constexpr double longest_empty_piece = 1e-7;

/// Leaves out pieces without length, as they arise where a contact passes a corner between elements
/// or the arc ends in it, or where two ways along a curve are joined: their neighbours meet there.
/// `reach`: up to so long they may be none, and up to `extent` the first and the last, if that is
/// more than rounding tells; but what ends on an edge is on the next one only up to `place` away.
void drop_empty_pieces(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces,
                       double place = 0, double reach = 0, double extent = 0);

/// Leaves out rulings so near to the first or the last of a piece that they are the same place: of
/// rounded surfaces rounding tells the way from one to the other.
void drop_beside_ends(std::vector<Ruling>& rulings, double extent);

/// Leaves out rulings from which a piece turns back the way it came, to within `extent`: where all
/// is in one plane to within the resolution, rulings that are exact are so in any order.
void drop_turns(std::vector<Ruling>& rulings, double extent);

/// Contacts that leave a place of a patch, or one between the ends of an edge, and come back to it,
/// no farther than `extent` from it and no higher there than `depth`, stay there. Places on edges
/// up to `place` from each other are one.
void tell_corners(std::vector<ArcPiece>& pieces, double place, double extent, double depth);

/// A contact that runs along an edge and is told now as one of the edge and now as one of a patch
/// that ends there is one of the edge.
void tell_along_edges(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces);

/// A contact that has come to run along a smooth join, or no farther than `extent` from it where
/// heights tie, is told as one of the patch into which its region extends.
void tell_along_joins(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces,
                      double extent);

/// Contacts with which pieces begin and end in their normal form: turned to the next ones; at poles
/// told with the direction in which they come there.
void turn_ends(const ContactSystem& system, std::vector<ArcPiece>& pieces);

/// Contacts that leave an end of an edge along a piece and come back to it, to within `extent`,
/// while it is as high to within tie(), are told as ones of its vertex: however far rounding makes
/// them go, where the edge leaves it along the ruling. Pieces that go on into each other then are
/// one.
void tell_vertices(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces, double extent);

/// With the order of contacts reversed.
Ruling reversed(const Ruling& r);

/// Reverses the direction, and with it the order of contacts.
void reverse(std::vector<Ruling>& rulings);
void reverse(std::vector<ArcPiece>& pieces);

/// Both contacts are of the same elements.
bool same_elements(const Ruling& a, const Ruling& b);

/// Puts contacts where the other ruling has them, in their own elements, as far as these reach
/// there. The other's contacts are put on borders that are no farther than rounding makes them.
void set_places(const ContactGeometry& geometry, Ruling& ruling, Ruling& other);

/// Appends pieces that go on where these end.
void append(std::vector<ArcPiece>& pieces, std::vector<ArcPiece>&& more);

}  // namespace taut
