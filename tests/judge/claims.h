#pragma once

#include <functional>
#include <string>

#include "models.h"
#include "reference.h"
#include "support_reference.h"
#include "taut/hull/result/hull.h"

namespace taut_test {

/// Bounds of a model's support function.
using Support = std::function<SupportRange(const dvec3& n)>;

/// @name What is wrong with a hull by a support function of its own; empty if nothing
///
/// `size` is the model's diagonal, `slack` a length that the model may stray from the one that the
/// support function is of.
/// @{
/// The mesh, in directions at random: what supports lies farther out than its bound, or the mesh
/// lies outside.
std::string wrong_mesh(const taut::Hull& hull, const Support& support, double size, double slack,
                       Random& random);

/// Some of the boundary's rulings and facets, in their directions: they are surpassed, or lie
/// outside.
std::string wrong_contacts(const taut::HullBoundary& boundary, const Support& support, double size,
                           double slack, Random& random);

/// Some of the boundary's rulings and facets, in their directions and in some next to them, where
/// what supports is to be reached from their points.
std::string wrong_places(const taut::HullBoundary& boundary, const SupportReference& reference,
                         Random& random);
/// @}

}  // namespace taut_test
