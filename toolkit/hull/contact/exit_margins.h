#pragma once

#include "taut/bounds/contact_exits.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// The exit's margin of contact i, linearised: a parameter's distance from its end, or the sine of
/// the angle by which the direction misses the face's normal or the plane across the edge.
LinearEquation exit_margin(const ContactGeometry& geometry, const CommonSupport& s, int i,
                           const ContactExit& exit);

}  // namespace taut
