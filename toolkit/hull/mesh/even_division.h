#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Divides a sequence of places so that the sagittas of all parts are alike and no larger than
/// they may be. A chord's sagitta grows as its length squared, so it is the integral of the square
/// root that is divided.
class EvenDivision {
 public:
  /// A place on a sequence of points: in the interval behind one of them.
  struct Place {
    std::size_t interval = 0;
    double s = 0;
  };

  /// Adds the next interval; `sagitta_root` is the square root of its sagitta.
  void add(double sagitta_root) { sums_.push_back(sums_.back() + sagitta_root); }
  /// Adds the intervals between rulings, of whose two curves the larger sagittas count: those of
  /// pairs of intervals tell; of one interval alone, its middle.
  void add(const std::vector<Ruling>& rulings, const std::function<Ruling()>& middle);

  /// How many parts are needed, before rounding.
  double parts(double sagitta) const { return sums_.back() / std::sqrt(sagitta); }
  /// The ends of the parts, from the first to the last. @pre there are intervals
  std::vector<Place> places(double sagitta, int least_parts) const;

 private:
  std::vector<double> sums_ = {0};
};

}  // namespace taut
