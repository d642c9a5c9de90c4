#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The contact on a side of a patch, where the side's free parameter is t.
Contact on_side(int instance, int patch, Side side, double t);

/// The edge's contact as one on a side of a patch that lies on it.
Contact on_side(const Contact& edge, const ContactGeometry::PieceSide& side);

/// The vertex as the end of a piece, and as the ends of all pieces that have it.
Contact piece_end(const Contact& vertex, const ContactGeometry::PieceEnd& end);
std::vector<Contact> piece_ends(const ContactGeometry& geometry, const Contact& vertex);

/// The patch's derivative across the side, into the patch.
dvec3 inward_derivative(const ContactJet& j, Side side);

/// The edge's tangent at the end of the piece, away from the end.
dvec3 tangent_from(const ContactGeometry& geometry, const Contact& vertex,
                   const ContactGeometry::PieceEnd& end);

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

/// Follows an edge from the end of a piece on. `visit` gets each piece at its beginning and at its
/// end, and tells whether what was looked for is there, or ends the search. False where the edge
/// ends before.
enum class EdgeVisit { found, lost, on };
bool found_on_edge(const ContactGeometry& geometry, const Contact& from,
                   const std::function<EdgeVisit(const Contact& begin, const Contact& end)>& visit);

}  // namespace taut
