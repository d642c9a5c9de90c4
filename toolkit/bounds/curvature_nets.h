#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/bounds/normal_pyramid.h"
#include "taut/bounds/second_form.h"
#include "taut/surface/bezier.h"

namespace taut {

/// The second fundamental form of a patch as Bernstein nets: N . Suu, N . Suv and N . Svv, all
/// times one positive function, N a positive multiple of Su x Sv. Degrees are high, but affine maps
/// of the patch leave the nets as they are, up to a factor, and no bound of the normals loosens
/// what they tell.
///
/// At a pole, a side that is one point with one tangent plane, the form and N vanish. There, too,
/// they tell: what vanishes as powers of the distance from the pole is divided by these powers.
/// One object a thread.
class CurvatureNets {
 public:
  /// `poles`: the sides (indexed by Side) that are poles. @pre degrees are at least 1, weights
  /// positive
  CurvatureNets(const BezierPatch& patch, const std::array<bool, 4>& poles);

  /// Bounds over a rectangle, in parameters stretched by distances from the poles: definite where
  /// the form is.
  SecondForm over(const Interval& u, const Interval& v) const;
  /// Over all of the square.
  SecondForm over() const;
  /// What the form surely is over all of the square: -1 negative, 1 positive definite; 0 if
  /// neither.
  int definite_sign() const;
  /// At least how much has to be added to the form, times the sign, as a multiple of the sum of
  /// squares, so that it is surely not negative over the square; 0: nothing.
  double shortfall_bound(int sign) const;
  /// Of the vectors N over the square: their lengths along a unit vector are at least `least`, and
  /// their angles to it at most `angle`.
  struct NormalBounds {
    dvec3 axis = dvec3(0.0);
    double least = 0;
    double angle = 0;
  };
  NormalBounds normal_bounds() const;
  /// Contains the normals over the rectangle.
  std::optional<NormalPyramid> normals(const Interval& u, const Interval& v) const;
  /// Contains the normals over all of the square.
  std::optional<NormalPyramid> normals() const;

  /// The nets over the two halves of the square, in parameters of their own.
  std::array<CurvatureNets, 2> halves(Direction direction) const;

 private:
  template <class Entry>
  struct Net {
    NetShape shape;
    std::vector<Entry> entries;
    double error = 0;  ///< of an entry
    double size = 0;   ///< of the largest entry

    /// Holds an entry's true value.
    Interval around(std::size_t k) const { return {entries[k] - error, entries[k] + error}; }
    /// Of a higher degree.
    Net<Entry> raised(NetShape to) const;
    Net<Entry> upper_half(Direction direction, Net<Entry>& lower) const;
  };
  CurvatureNets() = default;
  double least_determinant() const;
  static Interval range(const std::vector<double>& entries, double error);
  static Interval range(const Net<double>& net, const Interval& u, const Interval& v);

  Net<dvec3> normals_;
  Net<double> uu_, uv_, vv_;                         // of one degree
  mutable std::optional<double> least_determinant_;  // once it was asked for
};

}  // namespace taut
