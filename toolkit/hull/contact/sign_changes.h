#pragma once

#include <functional>
#include <vector>

namespace taut {

/// @name Roots along a border
/// Of functions of a parameter in [0, 1], such as a curvature along the side of a patch.
/// @{
using SideFunction = std::function<double(double)>;

/// The function is zero over all of [0, 1], up to rounding.
bool vanishes(const SideFunction& f);

/// Zeros at which the function changes sign: between two of 65 samples, or twice in a dip between
/// them.
std::vector<double> sign_changes(const SideFunction& f);

/// Halves [a, b] so often; by default until rounding is left. @pre f changes sign between them
double bisected(const SideFunction& f, double a, double b, int steps = 60);

/// A root may be in [0, 1], up to rounding.
bool is_within(double root);
/// A root where it is surely inside, and at the end where it may be there.
double placed(double root);
/// @}

}  // namespace taut
