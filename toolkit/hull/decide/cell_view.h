#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// Four numbers, one for each corner of a cell of directions.
using Corners = std::array<double, 4>;

/// What one piece is to one cell of directions.
struct SeenPiece {
  int piece = -1;
  std::size_t values = 0;  ///< of the control points: first index into CellView::values()
  Corners top = {};        ///< upper bounds of (x - q) . d over the piece, by corner
  Corners low = {};        ///< lower bounds
};

/// The pieces of a model that may touch a supporting plane with a normal in a cell of directions.
///
/// Directions d of the cell are the convex combinations of four; heights are over a point q of the
/// model: (x - q) . d. All is linear in d, so that what holds at the corners holds in the cell.
class CellView {
 public:
  CellView(MapPieces& pieces, double noise) : pieces_(pieces), noise_(noise) {}

  /// Turns to a cell. `beacons`: points of the model, of which q is one.
  void turn_to(const std::array<dvec3, 4>& corners, const dvec3& q, std::span<const dvec3> beacons);
  const std::array<dvec3, 4>& corners() const { return d_; }
  const dvec3& q() const { return q_; }

  /// Looks at a piece: keeps it if it may have a contact.
  void look(int piece);
  /// Upper bounds of the heights of supporting planes, once all pieces have been looked at; drops
  /// what cannot have a contact below them.
  void finish();
  std::vector<SeenPiece>& seen() { return seen_; }
  const std::vector<SeenPiece>& seen() const { return seen_; }
  const Corners& highest() const { return highest_; }
  /// Heights of the control points, times their weights, by corner.
  const Corners* values(const SeenPiece& seen) const { return values_.data() + seen.values; }

  /// Splits pieces that are curved by more than the cell is wide. True if there were any.
  bool refine();

  MapPieces& pieces() { return pieces_; }
  const MapPieces& pieces() const { return pieces_; }
  double noise() const { return noise_; }

  long looked = 0;

 private:
  bool is_beaten(const Corners& top) const;
  bool surely_rises(const MapPiece& piece, const SeenPiece& seen) const;
  struct Bend {
    double uu = 0, uv = 0, vv = 0;
  };
  Bend bend(const MapPiece& piece, const SeenPiece& seen) const;
  bool surely_rises_obliquely(const MapPiece& piece, const SeenPiece& seen) const;
  bool rises_inward(const MapPiece& piece, const SeenPiece& seen) const;
  int wanted_split(const SeenPiece& seen, double share) const;

  MapPieces& pieces_;
  double noise_;
  std::array<dvec3, 4> d_ = {};
  dvec3 q_ = dvec3(0.0);
  std::vector<Corners> beacons_;
  std::vector<SeenPiece> seen_;
  std::vector<SeenPiece> before_;  // scratch
  std::vector<Corners> values_;
  Corners highest_ = {};
};

}  // namespace taut
