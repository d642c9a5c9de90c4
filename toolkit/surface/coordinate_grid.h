#pragma once

#include <array>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// The grid on which coordinates lie, where it tells how they were rounded.
struct CoordinateGrid {
  /// How the coordinates were rounded.
  enum class Kind {
    none,      ///< they are doubles, or were not rounded: 12, 0.5, 2.54
    float32,   ///< each is a float32
    decimals,  ///< each has so many decimals, or fewer
  };
  Kind kind = Kind::none;  ///< how they were rounded
  int decimals = 0;        ///< kind decimals: at least six
  double step = 0;         ///< between neighbours on the grid, at the largest coordinate
};

/// Judges by the numbers themselves how the coordinates of a file or an array were rounded, whoever
/// wrote or read them. Keeps counts of them; their order does not matter.
///
/// They were rounded to float32, or to k >= 6 decimals, if all of them lie on that grid and at
/// least half of them use the last 8 of its 24 bits, or the last two of its decimals. Numbers that
/// need no rounding use nothing: whole numbers up to 2^24, each of which is a float32, those with
/// as many binary places as decimals, such as 1/64, and those of fewer than four digits, such as
/// 0.000254. Decimal numbers have at most 15 digits: what is written with more, no double tells.
class StoredCoordinates {
 public:
  /// More are not looked for: powers of ten are doubles up to this one.
  static constexpr int most_decimals = 22;

  /// Counts the coordinates of points.
  void add(std::span<const dvec3> points);
  /// Homogeneous points, whose Euclidean coordinates are the numbers, stored times their weights,
  /// rounded. Weights do not count.
  void add(std::span<const dvec4> points);

  /// What the numbers counted tell.
  CoordinateGrid grid() const;

 private:
  void add(double product, double weight);
  void add_float32(double product, double weight);
  void add_decimal(double product, double weight);

  long count_ = 0;
  double largest_ = 0;
  bool all_float32_ = true;
  long using_last_bits_ = 0;
  bool all_decimal_ = true;
  int decimals_ = 0;  // the most that any needs
  /// Numbers that need so many decimals, and were rounded to them.
  std::array<long, most_decimals + 1> needing_decimals_ = {};
};

}  // namespace taut
