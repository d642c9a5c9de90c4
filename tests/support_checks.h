#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "models.h"
#include "reference.h"
#include "taut/bounds/support_query.h"

namespace taut_test {

/// A slow support function: of (x - center of the scene's frame) . n, in model units.
using SupportTruth = std::function<SupportRange(const dvec3& n)>;

/// The truth of closed forms about the origin: h(n) for n of any length near one.
inline SupportTruth closed_form(const taut::Scene& scene,
                                const std::function<real(const rvec3& n)>& h) {
  return [&scene, h](const dvec3& n) {
    const real value = h(rvec3(n)) - glm::dot(rvec3(scene.frame().center), rvec3(n));
    return SupportRange{value, value};
  };
}

inline SupportTruth reference(const taut::Scene& scene) {
  return ReferenceSupport(scene.model(), scene.frame().center);
}

/// Largest errors over some directions, as shares of the scene's diagonal.
struct SupportErrors {
  real value = 0;       ///< |h - truth|
  real below = 0;       ///< truth - h_bound, where positive
  real above = 0;       ///< h_bound - truth
  real contact = 0;     ///< |point - S(u, v)|
  real reproduced = 0;  ///< |h - S(u, v) . n|
  int directions = 0;
  int undecided = 0;  ///< directions whose truth is known to less than 1e-13 only
  dvec3 worst_below = dvec3(0.0);
  dvec3 worst_above = dvec3(0.0);
};

/// The contact's point relative to the frame's centre, in model units, by de Casteljau.
inline rvec3 contact_point(const taut::Scene& scene, const taut::Contact& contact) {
  const taut::Instance& instance = scene.model().instances()[std::size_t(contact.instance)];
  const taut::Part& part = scene.model().parts()[std::size_t(instance.part)];
  const auto element = std::size_t(contact.element);
  rvec3 x{};
  switch (contact.kind) {
    case taut::SourceKind::face:
      x = reference_point(part.patches().at(element).bezier, contact.u, contact.v);
      break;
    case taut::SourceKind::edge:
      x = reference_point(part.pieces().at(element).bezier, contact.u);
      break;
    case taut::SourceKind::vertex:
      x = rvec3(part.vertices().at(element));
      break;
  }
  const rvec3 shift = rvec3(instance.pose.translation) - rvec3(scene.frame().center);
  return glm::mat<3, 3, real>(instance.pose.rotation) * x + shift;
}

inline void check_support(const taut::Scene& scene, const SupportTruth& truth, const dvec3& n,
                          const taut::Support& s, SupportErrors& errors) {
  const real scale = scene.frame().scale;
  const real unit = 1 / (scale * scene.diagonal());
  const SupportRange range = truth(n);
  const real lower = range.lower * scale;
  const real upper = range.upper * scale;
  ASSERT_GE(s.contact.instance, 0);
  for (const double t : {s.contact.u, s.contact.v}) {
    ASSERT_GE(t, 0);
    ASSERT_LE(t, 1);
  }
  const auto raise = [&](real& most, real error) {
    ASSERT_FALSE(std::isnan(error));
    most = std::max(most, error * unit);
  };
  raise(errors.value, std::max(lower - s.h, s.h - upper));
  if ((lower - s.h_bound) * unit > errors.below) errors.worst_below = n;
  if ((s.h_bound - upper) * unit > errors.above) errors.worst_above = n;
  raise(errors.below, lower - s.h_bound);
  raise(errors.above, s.h_bound - upper);
  ++errors.directions;
  if ((upper - lower) * unit > 1e-13L) ++errors.undecided;
  const rvec3 x = contact_point(scene, s.contact) * scale;
  raise(errors.contact, glm::length(rvec3(s.point) - x));
  raise(errors.reproduced, std::abs(glm::dot(x, rvec3(n)) - real(s.h)));
}

/// Largest permitted share of the diagonal by which a support value, or its bound, may be wrong.
inline constexpr double support_accuracy = 1e-12;

/// `model_error`: by how much the control points as rounded may differ from the truth's shape.
/// `contact_error`: what the check of the contact, in long double, may be off itself.
inline void expect_correct(const SupportErrors& errors, const std::string& name,
                           double model_error = 0, double contact_error = 1e-14) {
  EXPECT_LE(errors.value, support_accuracy) << name;
  EXPECT_LE(errors.below, model_error) << name << " n = " << errors.worst_below.x << ", "
                                       << errors.worst_below.y << ", " << errors.worst_below.z;
  EXPECT_LE(errors.above, support_accuracy) << name << " n = " << errors.worst_above.x << ", "
                                            << errors.worst_above.y << ", " << errors.worst_above.z;
  EXPECT_LE(errors.contact, contact_error) << name;
  EXPECT_LE(errors.reproduced, contact_error) << name;
  EXPECT_LE(10 * errors.undecided, errors.directions) << name;
}

/// The six axis directions, the diagonals, and directions that miss an axis by 1e-1 .. 1e-16.
inline std::vector<dvec3> special_directions(Random& random) {
  std::vector<dvec3> result;
  for (int k = 0; k < 27; ++k) {
    const dvec3 d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (d != dvec3(0.0)) result.push_back(taut::unit(d));
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 1; k <= 16; ++k) {
      dvec3 d(0.0);
      d[axis] = k % 2 == 0 ? 1 : -1;
      result.push_back(taut::unit(d + std::pow(10.0, -k) * random_direction(random)));
    }
  }
  return result;
}

inline std::vector<dvec3> random_directions(Random& random, int count) {
  std::vector<dvec3> result;
  for (int k = 0; k < count; ++k) result.push_back(random_direction(random));
  return result;
}

/// Cold queries in all directions by both kinds of bounds.
inline void expect_support(const taut::Scene& scene, const SupportTruth& truth,
                           const std::vector<dvec3>& directions, const std::string& name,
                           double model_error = 0, double contact_error = 1e-14) {
  for (const taut::SupportBounds bounds :
       {taut::SupportBounds::bezier_nets, taut::SupportBounds::coons}) {
    taut::SupportQuery query(scene, {}, bounds);
    SupportErrors errors;
    for (const dvec3& n : directions) check_support(scene, truth, n, query(n), errors);
    expect_correct(errors, name + (bounds == taut::SupportBounds::coons ? " (coons)" : " (nets)"),
                   model_error, contact_error);
  }
}

}  // namespace taut_test
