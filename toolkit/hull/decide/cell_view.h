#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/hull/decide/beacon_envelope.h"
#include "taut/hull/decide/pieces.h"
#include "taut/hull/decide/seen_piece.h"

namespace taut {

/// The pieces of a model that may touch a supporting plane with a normal in a cell of directions.
///
/// Directions d of the cell are the convex combinations of four; heights are over a point q of the
/// model: (x - q) . d. All is linear in d, so that what holds at the corners holds in the cell.
class CellView {
 public:
  /// `noise`: what rounding may do to heights and their differences. The pieces must outlive it.
  CellView(const MapPieces& pieces, double noise) : pieces_(pieces), noise_(noise) {}

  /// Turns to a cell. `beacons`: points of the model, of which q is one.
  void turn_to(const std::array<dvec3, 4>& corners, const dvec3& q, std::span<const dvec3> beacons);
  const std::array<dvec3, 4>& corners() const { return d_; }
  const dvec3& q() const { return q_; }

  /// A beacon is the highest of them for some direction of the cell.
  bool is_highest(std::size_t beacon) const { return envelope_.is_highest(beacon); }

  /// Looks at a piece: drops it if for each direction one of the beacons is above all of it, by
  /// more than what it stands for may be, or its element moved on to a translate is higher.
  void look(const MapPiece& piece);
  /// Once all pieces have been looked at: drops those that no plane can touch.
  void finish();
  /// Those that are left.
  const std::vector<SeenPiece>& seen() const { return seen_; }
  /// Upper bounds of the heights of supporting planes, by corner.
  const Corners& highest() const { return highest_; }
  /// Heights of the control points, times their weights, by corner.
  const Corners* values(const SeenPiece& seen) const { return values_.data() + seen.values; }

  /// Splits pieces over which slopes change by more than over the cell. True if there were any.
  bool refine();
  /// Splits pieces that bend up in places, by more than its share of `depth`, with one of
  /// `shares` for each of seen(), and drops those that are farther than `depth` below the convex
  /// hull of what else there is. True if there were any.
  bool sharpen(double depth, const std::vector<double>& shares);

  /// How many times more pieces than in a wide cell are not too many to be looked at together.
  std::size_t crowding() const;

  const MapPieces& pieces() const { return pieces_; }
  double noise() const { return noise_; }
  /// Pieces looked at since construction.
  long looked() const { return looked_; }

 private:
  double longest_direction() const;
  void find_envelope();
  double depth_of(const MapPiece& piece) const;
  bool box_is_beaten(const MapPiece& piece) const;
  bool is_beaten(const SeenPiece& seen, const MapPiece& piece) const;
  void add_highest_corner(const SeenPiece& seen);
  bool is_surpassed(const MapElement& element) const;
  bool rises_inward(const SeenPiece& seen) const;

  const MapPieces& pieces_;
  double noise_;
  std::array<dvec3, 4> d_ = {};
  dvec3 q_ = dvec3(0.0);
  std::vector<Corners> beacons_;
  BeaconEnvelope envelope_;
  /// A vertex of the envelope: its direction, and a plane across it as high as the envelope.
  struct Limit {
    dvec3 d;
    double height;
  };
  std::vector<Limit> limits_;
  double depth_ = 0;  ///< by which what is dropped is below the envelope
  std::vector<SeenPiece> seen_;
  std::vector<SeenPiece> before_;  // scratch
  std::vector<double> scratch_;
  std::vector<Corners> values_;
  Corners highest_ = {};
  long looked_ = 0;
};

/// Heights of a homogeneous point or vector over q, times its weight, by corner.
inline Corners heights(const dvec4& p, const dvec3& q, const std::array<dvec3, 4>& d) {
  const dvec3 x = dvec3(p) - p.w * q;
  return {glm::dot(x, d[0]), glm::dot(x, d[1]), glm::dot(x, d[2]), glm::dot(x, d[3])};
}

}  // namespace taut
