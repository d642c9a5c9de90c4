#pragma once

#include <optional>
#include <span>

#include "taut/bounds/scene.h"

namespace taut {

/// A support point with the direction in which it supports and the derivative of the support point
/// with respect to the direction, which is the Hessian of the support function there. In the
/// scene's frame.
struct CurvedContact {
  dvec3 n = dvec3(0.0);
  dvec3 point = dvec3(0.0);
  dmat3 hessian = dmat3(0.0);
  double weight = 1;  ///< its share in the point nearest to the one that is asked for

  /// The support point in a direction nearby, to first order.
  dvec3 point_at(const dvec3& m) const { return point + hessian * (m - n); }
  /// The support value in a direction nearby, to second order.
  double value_at(const dvec3& m) const {
    return glm::dot(point, m) + 0.5 * glm::dot(m - n, hessian * (m - n));
  }
};

/// Derivative of the contact's point where the direction n in which it supports turns: with the
/// free parameters' tangents J and B = d^2 (x . n), it is -J B^-1 J^T (a vertex, and parameters
/// that press against an end, do not move). None where B is not negative definite, or hardly.
std::optional<dmat3> support_hessian(const Scene& scene, const Contact& contact, const dvec3& n);

/// Newton's step, from the direction n, for a direction in which x . n - h(n) is stationary and all
/// of the contacts support, with h the largest of the contacts' own second-order values. With
/// weights l_i it solves
///     x - sum l_i p_i(n) = (x . n - h) n,   p_i(n) . n equal,   sum l_i = 1,
/// which for one contact is the normal through x, for two the ruling and for three the plane of a
/// facet nearest to it. Contacts that predict the same point are one; those whose weight becomes
/// negative are left out. None where the step leads nowhere near.
///
/// `regular` is added to curvatures, as a share of them, for where all directions along a line are
/// as good (on the axis of a cylinder); of each step it leaves as much for the next one.
/// @pre one to four contacts
std::optional<dvec3> projection_step(std::span<const CurvedContact> contacts, const dvec3& x,
                                     const dvec3& n, double regular = 1e-6);

}  // namespace taut
