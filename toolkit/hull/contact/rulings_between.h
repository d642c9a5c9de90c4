#pragma once

#include <array>
#include <optional>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/hermite_polynomial.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// A ruling that moves along a separating curve, and its derivatives.
struct MovingRuling {
  CommonSupport at;                                    ///< the ruling, evaluated
  dvec3 dn = dvec3(0.0);                               ///< of the direction
  std::array<dvec2, 2> dp = {dvec2(0.0), dvec2(0.0)};  ///< of the contacts' parameters
  std::array<dvec3, 2> dx = {dvec3(0.0), dvec3(0.0)};  ///< of their points

  /// Sets the derivatives: the tangent's times the speed.
  void move(const CurveTangent& t, double speed);
  /// All derivatives times the factor.
  void speed_up(double factor);
  /// Derivatives of the points and of the unit normal from those of the parameters and of n.
  void complete();
};

/// The rulings of a piece of a separating curve between two neighbouring ones, exact to rounding,
/// as smooth functions of s in [0, 1].
///
/// At s it is the ruling in the plane, across the chord from the first to the last in the space
/// of (n, point 0, point 1), that divides the chord in the ratio s. Where the two contacts merge at
/// one end (a ruling of length zero) it is the one whose length is s or 1 - s times the longer
/// one's: as functions of their distance n and the contacts are smooth there (mathematics: near an
/// A3 end, m +- rho e; a B3 end, linear). Where a parabolic curve touches an edge their distance
/// falls with the square of the way, and where it meets a join at a small angle they hardly part:
/// s is the chord's share there as well. Where one contact leaves the end of an edge that does not
/// bend there, as the borders of cages end in corners, or a side across which its patch is level, n
/// and the other contact move with the square of its way: there the root of the chord's share is s.
/// Where both do so, n alone moves with the square of their ways, and s is the share. Newton's
/// method starts from Hermite's interpolation. Where n is the same at both ends it starts from
/// contacts that go straight, in one plane.
class RulingsBetween {
 public:
  /// @pre the two rulings have the same elements; all outlive this
  RulingsBetween(const ContactSystem& system, const Ruling& from, const Ruling& to);

  /// The two rulings are the same.
  bool empty() const { return square_ == 0; }
  /// The two contacts merge at one end.
  bool merges() const { return free_end_ >= 0; }
  /// Rounding moves the contacts of exact rulings, and their derivatives, by more than the
  /// interpolation is off: at one end the two, of one smooth surface or curve, merge or are about
  /// to, or one of them is at an end or a side where its element is flat, or far from the origin
  /// lies flat, or it leaves a pole and is still close to it; or the chord is so short that the
  /// interpolation misses by less than rounding makes of exact rates, as beside planes in which an
  /// edge lies as a whole.
  bool is_smoother() const {
    return merges() || touches_ || nearly_merges_ || lies_flat_ || leaves_pole_ ||
           are_rates_noise();
  }
  /// One of them is at an end or a side where its element is flat, or lies flat.
  bool lies_flat() const { return lies_flat_; }
  /// At one end one of them is at a pole, and both rulings are close to it.
  bool leaves_pole() const { return leaves_pole_; }
  /// At one end one contact, not both, leaves where its element is flat.
  bool is_straight() const { return straight_[0] || straight_[1]; }
  /// Of the chord.
  double length() const { return std::sqrt(square_); }
  /// The s at which the chord is divided in this ratio, unless the two merge.
  double at_share(double share) const;
  /// The ruling at s, which may leave [0, 1] by a little, but not beyond a free end. None if
  /// Newton's method does not converge to one near the interpolated one. Next to a free end the
  /// derivatives are the interpolation's.
  std::optional<MovingRuling> operator()(double s) const;
  /// What Newton's method starts from: next to a free end, where rounding moves the contacts of
  /// exact rulings, the smoother ruling.
  MovingRuling interpolated(double s) const;

 private:
  /// n and the contacts' parameters of a ruling.
  using State = HermitePolynomial::State;
  static State state(const dvec3& n, const dvec2& p0, const dvec2& p1);
  static State place(const MovingRuling& m);
  static State rate(const MovingRuling& m);

  double share(double s) const;
  double share_slope(double s) const;
  bool nearly_merge() const;
  bool are_rates_noise() const;
  bool touch(const Ruling& end, const Ruling& longer);
  void fit();
  void refine();
  bool is_noise(const CommonSupport& s) const;
  void fit_free_end(const Ruling& end, const Ruling& longer);
  bool solve_share(MovingRuling& m, double s) const;
  bool solve_length(MovingRuling& m, double r) const;
  static bool is_distinct(double length);
  bool find_speed(MovingRuling& m) const;
  bool find_slope(MovingRuling& m, double r) const;
  bool is_near(const MovingRuling& start, const MovingRuling& m) const;
  MovingRuling moving(double r, double sense) const;
  CommonSupport support(const Ruling& r) const;
  template <class Equation>
  bool solve(MovingRuling& m, const Equation& equation) const;

  const ContactSystem& system_;
  const Ruling& from_;
  const Ruling& to_;
  std::array<int, 2> kept_;  // of the contacts' parameters (CommonSupport::kept)
  double square_ = 0;        // of the chord
  double shorter_ = 0;       // of the two rulings' lengths
  bool nearly_merges_ = false;
  bool lies_flat_ = false;
  bool leaves_pole_ = false;
  std::array<bool, 2> straight_ = {false, false};  // at either end
  std::array<bool, 2> stands_ = {false, false};    // n, at either end
  int free_end_ = -1;                              // at which the contacts merge
  double length_ = 0;                              // of the ruling at the other one
  bool touches_ = false;          // ... and their distance is no measure of the way there
  HermitePolynomial polynomial_;  // in s, or in the length's share
};

/// Chords from a pole so long that a parameter about it, which rounding moves by a rounding unit
/// over the way from the pole, is known as well as from a quadratic, which misses by the cube: the
/// fourth root of the unit, in the scene's frame.
inline constexpr double pole_chord = 1e-4;

/// One of its contacts is at a pole, or in a corner that a side is collapsed to.
bool lies_at_pole(const ContactGeometry& geometry, const Ruling& r);

/// A single ruling of RulingsBetween.
std::optional<Ruling> ruling_between(const ContactSystem& system, const Ruling& from,
                                     const Ruling& to, double s);

}  // namespace taut
