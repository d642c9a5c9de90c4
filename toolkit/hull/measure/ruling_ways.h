#pragma once

#include <array>
#include <vector>

#include "taut/hull/contact/rulings_between.h"

namespace taut {

/// Exact rulings between two that are none themselves, moved so that they lead from the one to the
/// other: where rounded patches join, rulings end at normals within the kink that are those of
/// neither side, and without this the faces beside would not meet.
class LedRulings {
 public:
  /// @pre all outlive this
  LedRulings(const ContactGeometry& geometry, const RulingsBetween& between, const Ruling& from,
             const Ruling& to);
  /// By how much exact rulings miss the two, both contacts together; zero where these are exact,
  /// infinite where there is none.
  double missed() const { return missed_; }
  /// The exact ruling at s in [0, 1], moved by its share of what those at the ends miss.
  std::optional<MovingRuling> operator()(double s) const;

 private:
  struct Offset {
    dvec3 n = dvec3(0.0);
    std::array<dvec2, 2> parameters = {dvec2(0.0), dvec2(0.0)};
  };
  static Offset offset(const Ruling& end, const MovingRuling& exact);

  const ContactGeometry& geometry_;
  const RulingsBetween& between_;
  std::array<Offset, 2> at_;  ///< either end
  double missed_ = infinity;
};

/// A part of the way from one ruling of a piece to the next, on which its contacts come from where
/// they are at its beginning to where they are at its end.
///
/// Exact rulings lead from one to the other where the piece is smooth. Next to the plane of a node
/// they may not: where an edge lies in that plane but for rounding its contact runs to and fro, or
/// beyond the edge's ends, while n turns by an angle of the rounding's size. Nor may they where
/// contacts leave their patches by as little. There the way is the straight one in n and the
/// contacts' parameters.
struct RulingWay {
  Ruling from, to;
  /// By exact rulings (RulingsBetween); else straight.
  bool exact = true;

  /// The ruling of the straight way at r in [0, 1].
  MovingRuling straight(const ContactGeometry& geometry, double r) const;
  /// Of a straight way, how far its contacts may be from where they are to be; together.
  double deviation = 0;

  /// By how much total mean curvature may differ from that along the way to be: of an edge's crease
  /// the two have strips of its normals between them, no larger than what n turns by times the
  /// deviation, and half of angle times length counts.
  double uncertainty() const;
};

/// By how much a way on which the points move by `moved` does not lead from the one ruling to the
/// other, both points together; infinite where that is no number.
double missed_way(const std::array<dvec3, 2>& moved, const Ruling& from, const Ruling& to);
/// Total mean curvature that misses so much at creases, whose angles, below pi / 2, count by half.
double missed_curvature(double missed);
/// Whether a way that misses so much leads on: by less, 1e-10 in the scene's frame, curvature is no
/// farther off than measures of exact boundaries may be.
bool leads(double missed);

/// Ways from a ruling to the next: halves of halves of the exact one, as far as they lead on, and
/// straight ones of which what n turns by times the deviation, which bounds the height by which
/// they miss, is within the tolerance, or that are 1/256 of it or between which no exact ruling is
/// found. These ones deviate by as much as they move at most, as if they went neither back nor
/// beyond.
std::vector<RulingWay> ruling_ways(const ContactSystem& system, const Ruling& from,
                                   const Ruling& to, double tolerance);

}  // namespace taut
