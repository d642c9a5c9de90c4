#pragma once

#include <functional>
#include <vector>

#include "taut/bounds/scalar_net.h"
#include "taut/core/geometry.h"
#include "taut/surface/bezier.h"

namespace taut {

/// The second derivatives of a net of homogeneous points, with respect to parameters from 0 to 1,
/// as nets of its own degrees: those of the heights over a plane are linear in them.
class NetBends {
 public:
  void find(NetShape shape, const std::vector<dvec4>& net);

  const std::vector<dvec4>& uu() const { return part_.uu; }
  const std::vector<dvec4>& uv() const { return part_.uv; }
  const std::vector<dvec4>& vv() const { return part_.vv; }

  /// A convex function of the three, by index of the coefficients, is nowhere above a limit in a
  /// convex polygon of the parameters, counterclockwise. True is certain; the nets are split until
  /// all coefficients or one at a corner tell.
  bool are_below(const std::function<double(std::size_t)>& measure, double limit,
                 const std::vector<dvec2>& polygon);

 private:
  struct Part {
    std::vector<dvec4> uu, uv, vv;
    Interval u = {0, 1}, v = {0, 1};
  };
  void halve();

  NetShape shape_;
  Part part_;
  std::vector<Part> waiting_;  // scratch
};

/// The largest second derivative along a way (s, t) with -1 <= s, t <= 1; 0 if none is positive.
double largest_bend(double uu, double uv, double vv);

}  // namespace taut
