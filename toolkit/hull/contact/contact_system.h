#pragma once

#include <array>
#include <optional>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Contacts that are to support at one common direction, with their jets.
struct CommonSupport {
  static constexpr int capacity = 3;  ///< contacts, at most

  dvec3 n = dvec3(0.0);                   ///< unit, outward
  int count = 0;                          ///< of contacts
  std::array<Contact, capacity> contact;  ///< the first `count` count
  std::array<ContactJet, capacity> jet;   ///< per contact, as last evaluated
  /// The parameter that a contact keeps, 0 or 1: one on a side of its patch beyond which a plane or
  /// a ruled surface goes on stays on the side, where the patch may be so flat across it that the
  /// direction does not tell how far off it is. It supports all the same, or is no solution. One at
  /// the end of an edge may stay at a kink, whatever the slope there.
  std::array<int, capacity> kept = {free, free, free};
  static constexpr int free = -1;  ///< of a contact that keeps none

  CommonSupport() = default;
  /// The ruling's two contacts at its direction, evaluated.
  CommonSupport(const ContactGeometry& geometry, const Ruling& ruling);
  /// Adds a contact, evaluated. @pre fewer than capacity
  void add(const ContactGeometry& geometry, const Contact& c);
  /// Brings the jets up to date with the contacts.
  void evaluate(const ContactGeometry& geometry);

  /// From the second contact to the first. @pre two contacts, evaluated
  dvec3 d() const { return jet[0].x - jet[1].x; }
  /// The first two contacts as a ruling. @pre evaluated
  Ruling ruling() const;
};

/// The parameter that is at the same end of [0, 1] for both of two contacts of one patch or edge,
/// or CommonSupport::free: they lie on one side, or at one end.
int kept_parameter(const Contact& a, const Contact& b);

/// Contacts nearer than this, in the scene's frame, are one. Two contacts of one direction that are
/// so near are about to merge in a free end; they differ in height by the fourth power of it.
inline constexpr double same_contact = 1e-7;

/// One more equation, linearised: residual + n . dn + sum_i parameter[i] . d(u_i, v_i) = 0.
struct LinearEquation {
  double residual = 0;   ///< what the equation misses
  dvec3 n = dvec3(0.0);  ///< gradient by the direction
  /// Gradient by each contact's parameters.
  std::array<dvec2, CommonSupport::capacity> parameter = {dvec2(0.0), dvec2(0.0), dvec2(0.0)};

  /// Of the point of contact i: adds the gradient g . dx.
  void add_point(const CommonSupport& s, int i, const dvec3& g);
};

/// Keeps two contacts at this distance.
LinearEquation distance_equation(const CommonSupport& s, double length);

/// Rates of change along a separating curve of two contacts, of unit length in (n, x_0, x_1).
struct CurveTangent {
  dvec3 n = dvec3(0.0);                                       ///< rate of the direction
  std::array<dvec2, 2> parameter = {dvec2(0.0), dvec2(0.0)};  ///< rates of the contacts' parameters
  std::array<dvec3, 2> x = {dvec3(0.0), dvec3(0.0)};          ///< rates of the contacts' points
};

/// The system of equations of contacts that support together:
///     dx_i/da . n = 0  for every parameter a of every contact,   (x_0 - x_i) . n = 0,
/// in the unknown parameters and n on the unit sphere. It is regular where the contacts' dual
/// formulation divides by small curvatures (mathematics: dual formulation, conditioning): two
/// contacts trace a curve, three meet in isolated directions.
class ContactSystem {
 public:
  /// The geometry must outlive it.
  explicit ContactSystem(const ContactGeometry& geometry) : geometry_(geometry) {}

  /// What the contacts are of.
  const ContactGeometry& geometry() const { return geometry_; }

  /// Newton's method from `s`; `equation(s)` gives the equation that two contacts leave open.
  /// False if it does not converge, `s` is of no use then.
  template <class Equation>
  bool solve(CommonSupport& s, Equation equation) const {
    return iterate(s, equation, Steps::full, noise_step);
  }
  /// Newton's method for contacts so near to each other that the system is nearly singular, from a
  /// start near the solution: rounding may move them by more, and if need be steps of least length
  /// leave alone what the system does not tell. What is found supports to within rounding as well.
  template <class Equation>
  bool settle(CommonSupport& s, Equation equation) const {
    const CommonSupport start = s;
    if (iterate(s, equation, Steps::full, merging_noise_step)) return true;
    s = start;
    return iterate(s, equation, Steps::least, merging_noise_step);
  }
  /// Newton's method for three contacts, which leave no equation open.
  bool solve(CommonSupport& s) const;

  /// The direction near that of `s` in which its two contacts, of different surfaces or curves, are
  /// one point, or the one is above the other by no more than `depth`: Newton's method on x_0 - x_1
  /// as a function of n. None if it does not converge.
  std::optional<CommonSupport> crossing(CommonSupport s, double depth = 0) const;

  /// Tangent of the curve of two contacts along which n moves by n x (x_0 - x_1); none where all
  /// rates vanish. Where the system is singular the tangent is one of the directions that solve it.
  std::optional<CurveTangent> tangent(const CommonSupport& s) const;

  /// How far the rounding of coordinates may move two contacts off where their curve has them, in
  /// (n, x_0, x_1): the rounding over the smallest singular value of the system. Infinite where the
  /// system is singular.
  double uncertainty(const CommonSupport& s) const;

  /// Steps of Newton's method, since construction.
  long iterations() const { return iterations_; }

 private:
  static constexpr int step_limit = 20;
  static constexpr double step_bound = 0.7;
  static constexpr double converged_step = 1e-11;
  /// Steps below these that do not get shorter are rounding; of contacts that nearly merge.
  static constexpr double noise_step = 1e-7;
  static constexpr double merging_noise_step = 1e-6;
  static constexpr double residual_limit = 1e-13;

  enum class Steps { full, least };

  template <class Equation>
  bool iterate(CommonSupport& s, const Equation& equation, Steps steps, double noise_limit) const {
    double last = infinity;
    for (int k = 0; k < step_limit; ++k) {
      const LinearEquation extra = equation(s);
      const std::optional<double> length = step(s, &extra, steps);
      if (!length) return false;
      if (*length < converged_step) return residual(s) < residual_limit;
      const double now = *length;
      const bool noise = now < noise_limit && now > 0.5 * last;
      if (noise && residual(s) < residual_limit) return true;
      last = now;
    }
    return false;
  }
  std::optional<double> step(CommonSupport& s, const LinearEquation* extra,
                             Steps steps = Steps::full) const;
  double residual(const CommonSupport& s) const;
  static double largest_slope(const CommonSupport& s);

  const ContactGeometry& geometry_;
  mutable long iterations_ = 0;
};

}  // namespace taut
