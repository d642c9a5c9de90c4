#pragma once

#include <array>
#include <vector>

namespace taut {

/// Hermite's interpolation in Newton's form: the polynomial of the least degree with given values,
/// and slopes where they are given too. Nodes in any order; none twice.
class HermitePolynomial {
 public:
  /// n and the parameters of a ruling's two contacts.
  using State = std::array<double, 7>;

  /// Adds a node with its value.
  void add(double r, const State& value) { append(r, value, nullptr); }
  /// Adds a node with its value and slope.
  void add(double r, const State& value, const State& slope);
  /// At any r. @pre there is a node
  State value(double r) const { return evaluate(r)[0]; }
  /// The derivative at any r. @pre there is a node
  State slope(double r) const { return evaluate(r)[1]; }

 private:
  std::array<State, 2> evaluate(double r) const;
  void append(double r, const State& value, const State* slope);

  std::vector<double> node_;
  std::vector<State> coefficient_;
};

}  // namespace taut
