#pragma once

#include <array>
#include <functional>
#include <vector>

#include "shapes.h"
#include "taut/core/geometry.h"

namespace taut_test {

using taut::dvec2;
using taut::dvec3;
using taut::dvec4;
using taut::shapes::Shape;

/// The support function of NURBS curves, surfaces and points by brute force: dense samples, and
/// from the highest of them on a search among ever nearer neighbours. It shares nothing with the
/// toolkit but the control points: values are de Boor's. Every value is attained, so it is a lower
/// bound of the support function; on smooth pieces it is exact to rounding.
class SupportReference {
 public:
  explicit SupportReference(const Shape& shape);

  struct Top {
    dvec3 x = dvec3(0.0);
    double h = 0;
  };
  Top operator()(const dvec3& n) const;
  /// The highest value to which a way leads up, from where elements pass through the point, to
  /// within this distance of it, and over to others that it comes as near to; minus infinity where
  /// none is found.
  double climbed_from(const dvec3& x, const dvec3& n, double within) const;
  /// Of the box of the samples.
  double diagonal() const { return diagonal_; }

 private:
  /// A surface, a curve (one row of knots) or a point (none).
  struct Element {
    std::array<int, 2> degree = {0, 0};
    std::array<std::vector<double>, 2> knots;
    std::vector<dvec4> points;
    /// The lower and upper end of the parameters.
    std::array<dvec2, 2> domain = {dvec2(0.0), dvec2(0.0)};
  };
  struct Place {
    std::size_t element = 0;
    dvec2 at = dvec2(0.0);
    dvec2 step = dvec2(0.0);  ///< to its neighbours
    dvec3 x = dvec3(0.0);
  };

  void add(Element element);
  static dvec3 evaluate(const Element& element, const dvec2& at);
  /// So many places at which samples are highest, none beside another, in order.
  std::vector<const Place*> highest(std::size_t count,
                                    const std::function<double(const dvec3&)>& height) const;
  /// Uphill from the place, in steps of a share of its own at first, which are doubled and halved.
  Place climbed(Place place, double share, const std::function<double(const dvec3&)>& height) const;

  std::vector<Element> elements_;
  std::vector<Place> samples_;
  double diagonal_ = 0;
};

}  // namespace taut_test
