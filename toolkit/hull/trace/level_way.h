#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// The point in which a way leaves one element for the next, as a contact of both.
struct WayCrossing {
  Contact from, to;
};

/// The way between two contacts of one smooth surface or curve that support in the direction n, if
/// support values do not tell them apart: straight on, over the borders in between, x . n is
/// nowhere lower than at both by more than a tie. None where there is no such way over a few
/// elements.
std::optional<std::vector<WayCrossing>> level_way(const ContactGeometry& geometry, const Contact& a,
                                                  const Contact& b, const dvec3& n);

/// A contact to which a level way leads.
struct LevelStep {
  Contact to;
  std::vector<WayCrossing> way;
};

/// The contact that a climb leads to from beyond where the contact stands, ahead at these rates of
/// its parameters: another local maximum of x . n near by, if the way there is level. None
/// elsewhere.
std::optional<LevelStep> tied_ahead(const ContactGeometry& geometry, const Contact& c,
                                    const dvec2& rate, const dvec3& n);

}  // namespace taut
