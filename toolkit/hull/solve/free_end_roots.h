#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/contact/parabolic_sides.h"

namespace taut {

/// @name Newton's methods for free ends
/// By central difference quotients of third derivatives.
/// @{

/// Steps of a contact's parameters that may be rounding.
double noise_step(const ContactGeometry& geometry, const Contact& c);

/// The root of a function that is no farther than `reach` from the start; none if the method leads
/// to none. Steps below `noise` may be rounding.
std::optional<double> root_near(const SideFunction& f, double start, double reach, double noise);

/// The cusp of Gauss near a contact of a patch; its parameters may lie out of the patch. None if
/// the method goes farther than `reach` or if the root is not a simple one, as where a whole curve
/// of contacts shares one direction (the circle on which a torus lies).
std::optional<Contact> cusp_near(const ContactGeometry& geometry, Contact c, double reach);

/// The twist (CurveCurvature) of an edge's piece at the parameter t; zero where it stands still.
double twist_at(const ContactGeometry& geometry, Contact c, double t);
/// @}

}  // namespace taut
