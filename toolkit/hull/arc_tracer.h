#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/contact_system.h"
#include "taut/hull/facet_contacts.h"

namespace taut {

/// Contacts so near to each other, in the scene's frame, that keep approaching merge. The smallest
/// singular value of the system of two contacts falls with the third power of their distance; here
/// rounding moves them by about 1e-8 yet. What the hull bridges over a shorter distance deviates
/// from the surface by less than the fourth power of it.
inline constexpr double merge_distance = 4e-3;
/// The same, or more where rounding is so large that heights tie over more: about a free end they
/// differ by the fourth power of distances.
double merging_distance(const ContactGeometry& geometry);

/// A direction that is known to have three contacts or more, some of them at poles.
struct Landmark {
  dvec3 n = dvec3(0.0);
  FacetContacts facet;
};

/// One way along a separating curve.
struct TracedArc {
  enum class End {
    plane,    ///< other contacts support too: see `n` and `contacts`
    merged,   ///< the two contacts merge in a free end, or in a pole about which the curvatures
              ///< along the ways out of it are such that planes touch twice
    crossed,  ///< they meet, being of two surfaces or curves that touch: see `n` and `contacts`
    closed,   ///< the curve closes; the pieces are one way round
    lost,     ///< see `reason`
  };
  std::vector<ArcPiece> pieces;
  End end = End::lost;
  dvec3 n = dvec3(0.0);
  std::vector<Contact> contacts;
  const char* reason = "";
};

/// Follows the separating curve of two contacts in the direction n x (x_0 - x_1), over the borders
/// of their elements, until a third contact supports, the two merge, or the curve closes in its
/// start. Steps are predicted along the tangent and corrected across it (pseudo-arclength
/// continuation; Allgower, Georg 1990); every ruling is checked by a support query.
///
/// Poles, where a patch's parameters fail, are gone through, left and arrived at along chords: the
/// directions of poles with three and more contacts are told by `landmarks`.
///
/// `aside`: the start's points are contacts of elements that it may not name (where several meet):
/// these are found beside it.
///
/// @pre the start's two contacts support at its n
/// @throws Cancelled
TracedArc trace_arc(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
                    std::span<const Landmark> landmarks, const Progress& progress,
                    bool aside = false);

/// Leaves out pieces without length, as they arise where a contact passes a corner between elements
/// or the arc ends in it, or where two ways along a curve are joined: their neighbours meet there.
void drop_empty_pieces(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces);

}  // namespace taut
