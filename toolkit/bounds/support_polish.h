#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/scene_content.h"

namespace taut {

/// Newton steps for the maximum on one element; convergence is quadratic, more would mean a bad
/// start.
inline constexpr int newton_step_limit = 12;

/// Parameter step after which a further one is below rounding: Newton's method squares the error.
inline constexpr double newton_step_end = 1e-9;

/// A rise of the best value, in the scene's frame, that is more than rounding.
inline constexpr double gain_worth_taking = 16 * rounding_unit;

/// A local maximum of x . n on an element.
struct PolishedSupport {
  double h = 0;  ///< about the part's centre
  dvec2 uv = dvec2(0);
  bool converged = false;
  bool curved = false;  ///< the value is strictly concave there
  int steps = 0;
};

/// x . n on whole elements, whose nets have lost nothing to subdivision: what a contact that a
/// search has found, or that is known from before, is worth to the last bits.
///
/// Holds scratch memory; use one object a thread.
class SupportPolish {
 public:
  /// Takes up an element, which must outlive its use, and a direction in its part's own frame.
  void take(const SceneElement& element, const dvec3& n);

  /// Newton's method for the maximum.
  PolishedSupport polish(const dvec2& start);

  /// Where the value does not change along a parameter line (the ruling of a cylinder, a plane that
  /// faces the direction), the line's end; else uv. h is the value at uv.
  dvec2 end_of_flat(const dvec2& uv, double h) const;

 private:
  template <class Net>
  double value(const Net& net, double u, double v) const;
  template <class Net>
  PolishedSupport polish(const Net& net, const dvec2& start);
  template <class Net>
  dvec2 end_of_flat(const Net& net, const dvec2& uv, double h) const;

  const SceneElement* element_ = nullptr;
  std::vector<double> nets_;  ///< N and, where rational, W: the value is N / W
  std::vector<double> g_;
};

/// The end of the ruling through a contact on a patch, as far as patches go on smoothly, at which
/// x . n is as large as h; none if the contact is on no ruling or at the end of one. Points
/// between are not extreme, and tell nothing.
/// @pre kind face
std::optional<Contact> end_of_ruling(const SceneContent& scene, const Contact& contact,
                                     const dvec3& n, double h);

}  // namespace taut
