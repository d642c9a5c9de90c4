#pragma once

#include <array>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// A ruling in terms of its contacts' parameters in [0, 1].
struct RulingState {
  dvec3 n = dvec3(0.0);
  std::array<dvec2, 2> t = {dvec2(0.0), dvec2(0.0)};
};

/// @name States as points of a vector space
/// @{
RulingState operator+(const RulingState& a, const RulingState& b);
RulingState operator-(const RulingState& a, const RulingState& b);
RulingState operator*(double factor, const RulingState& a);
double dot(const RulingState& a, const RulingState& b);
double length(const RulingState& a);
/// @}

/// How polynomials go through the rulings that are known.
enum class Fit {
  best,  ///< through all
  worse  ///< through every second one where those between would not be met: tells the error
};

/// A stretch [from, to] of an interval's s over which rulings are one polynomial in s.
class RulingPanel {
 public:
  double from = 0;
  double to = 1;
  /// Every second node tells those between well enough that the error of all does not matter.
  bool settled = false;

  RulingPanel() = default;
  RulingPanel(double s0, double s1) : from(s0), to(s1) {}
  void add(double s, const RulingState& state);
  const std::vector<double>& nodes() const { return nodes_; }
  const std::vector<RulingState>& states() const { return states_; }
  /// The polynomial through every `stride`-th node in the order of adding, and its derivative.
  std::array<RulingState, 2> through(std::size_t stride, double s) const;
  std::array<RulingState, 2> at(double s, Fit fit) const {
    return through(fit == Fit::best || settled ? 1 : 2, s);
  }

 private:
  std::vector<double> nodes_;
  std::vector<RulingState> states_;
};

/// The rulings between two neighbours of a document's scroll, of which both contacts stay in one
/// Bezier patch or curve, over s in [0, 1]: at its ends are the two.
class RulingInterval {
 public:
  int ruling = -1;  ///< the first one; the other is the next in the list
  RulingState first, last;
  std::array<int, 2> source = {-1, -1};
  std::array<int, 2> patch = {-1, -1};
  /// The rulings at the nodes are solutions, not guesses.
  bool solved = false;
  /// From s = 0 to s = 1, without gaps; at least one.
  std::vector<RulingPanel> panels;

  /// Value and derivative.
  std::array<RulingState, 2> at(double s, Fit fit = Fit::best) const;
  RulingState value(double s) const { return at(s)[0]; }
};

}  // namespace taut
