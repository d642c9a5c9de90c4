#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/contact_system.h"

namespace taut {

/// One way along a separating curve.
struct TracedArc {
  enum class End {
    plane,   ///< a third contact supports: see `plane`
    merged,  ///< the two contacts merge in a free end
    closed,  ///< back where it began
    lost,    ///< see `reason`
  };
  std::vector<ArcPiece> pieces;
  End end = End::lost;
  CommonSupport plane;
  const char* reason = "";
};

/// Follows the separating curve of two contacts in the direction n x (x_0 - x_1), over the borders
/// of their elements, until a third contact supports, the two merge, or the curve closes in its
/// start. Steps are predicted along the tangent and corrected across it (pseudo-arclength
/// continuation; Allgower, Georg 1990); every ruling is checked by a support query.
///
/// @pre the start's two contacts support at its n
/// @throws Cancelled
TracedArc trace_arc(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
                    const Progress& progress);

}  // namespace taut
