#pragma once

#include "taut/hull/decide/coefficient_range.h"
#include "taut/hull/decide/pieces.h"
#include "taut/hull/decide/seen_piece.h"

namespace taut {

/// The slopes of the heights over a piece, in all directions of a cell at once: bounds by Bernstein
/// coefficients, linear in the direction.
///
/// A plane at height h across d touches a rational piece where (P - q w) . d - h w has no slope, P
/// and w its homogeneous points; h is a height of the piece.
class PieceSlopes {
 public:
  /// `values`: heights of the control points times their weights; `noise`: what rounding may do to
  /// them. All must outlive it.
  PieceSlopes(const MapPieces& pieces, const SeenPiece& seen, const Corners* values, double noise)
      : piece_(*seen.piece),
        element_(pieces.element_of(piece_)),
        points_(piece_.net.points),
        seen_(seen),
        values_(values),
        noise_(noise) {}

  /// Certain: in each direction of the cell the heights grow or fall along a line of the
  /// parameters, the same everywhere, so that no plane touches inside.
  bool surely_rise() const;

  /// Certain: in each direction of the cell the heights bend up along a line of the parameters, the
  /// same everywhere, so that no point inside is higher than all those beside it.
  bool surely_bend_up() const;

  /// The parameter along which the heights may bend up the most, if over the piece by more than
  /// `least`, though not everywhere.
  std::optional<Direction> bends_both_ways(double least) const;

  /// The parameter across which the piece is to be halved so that its slopes change over it by less
  /// than over the cell, times `share`; none if they do already.
  /// Scratch is working space.
  std::optional<Direction> wanted_split(double share, std::vector<double>& scratch) const;

 private:
  /// Second derivatives in the middle of the piece and of the cell, with respect to parameters that
  /// run from 0 to 1 over the piece.
  struct Bend {
    double uu = 0, uv = 0, vv = 0;
  };
  /// By how much slopes change over the extents of a piece.
  struct Change {
    double along_u = 0, along_v = 0;
    void include(double of_u, double of_v);
  };

  int p() const { return piece_.net.shape.p; }
  int q() const { return piece_.net.shape.q; }
  std::size_t index(int i, int j) const { return std::size_t(i * (q() + 1) + j); }
  double middle(std::size_t k) const;
  template <class Middle>
  Bend bend_at(int i, int j, const Middle& middle) const;
  Bend bend() const;
  /// A direction in the parameters, and the second derivative in it in the middle where it counts.
  struct Way {
    double along_u = 0, along_v = 0;
    double up = 0;
  };

  /// The control points along a parameter, in lines side by side: the steps from one to the next
  /// and to the next line, the degrees along them and across.
  struct Lines {
    int step, across;
    int count, degree;
  };
  Lines lines(Direction direction) const;

  bool is_at(Side side) const;
  bool is_at_pole_or_kink() const;
  double longest_step(Direction direction) const;
  CoefficientRange second_differences(Direction direction, double least) const;
  bool bend_up_along(Direction direction) const;
  bool bend_up_obliquely() const;
  std::optional<Way> steepest_bend(const Bend& bend) const;
  bool are_convex(const Way& way) const;
  Direction changes_most(const Way& way) const;
  template <class Of>
  double slope_at(int i, int j, const Way& way, const Of& of) const;
  bool rise_along(Direction direction) const;
  double pole_margin(Direction direction, bool lower, bool upper) const;
  bool rise_obliquely() const;
  bool are_definite(const Way& way) const;
  double spread(double along_u, double along_v) const;

  const MapPiece& piece_;
  const MapElement& element_;
  const dvec4* points_;
  const SeenPiece& seen_;
  const Corners* values_;
  double noise_;
};

}  // namespace taut
