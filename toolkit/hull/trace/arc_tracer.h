#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/trace/pole_passage.h"

namespace taut {

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
/// start. Steps are those of CurvePoint; every ruling is checked by a support query.
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

}  // namespace taut
