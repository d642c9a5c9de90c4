#pragma once

#include <optional>
#include <span>
#include <vector>

#include "taut/hull/planar/outline_side.h"
#include "taut/hull/planar/planar_sweep.h"

namespace taut {

/// The outline of a planar hull, made of the touches of a sweep: a closed chain of stretches, which
/// are parts of curves or single corners. Tangent points of the straight sides between them are
/// polished, stretches that meet without one are joined, and corners that coincide are one.
class OutlineChain {
 public:
  /// Arcs and points must outlive this; the touches are those of swept_touches().
  OutlineChain(const PlanarArcs& arcs, std::span<const dvec2> points,
               const std::vector<Touch>& touches);

  /// Normals of sides, or of tangents of curved ones, that do not support all.
  std::vector<dvec2> failures() const;
  /// Leaves corners out that are on a line with their neighbours.
  void drop_collinear();
  /// The sides with their corners, counter-clockwise.
  std::vector<OutlineSide> sides() const;

 private:
  /// What lies between two jumps: a part of a curve, or a single corner.
  struct Stretch {
    int point = -1;
    int curve = -1;
    bool smooth = false;  ///< on a curve that is not straight
    double from = 0;
    double to = 0;
    dvec2 start = dvec2(0);
    dvec2 end = dvec2(0);
    bool corner = false;      ///< of no length
    bool joint = false;       ///< the next stretch begins where this one ends
    dvec2 normal = dvec2(0);  ///< of the side to the next one
  };

  void collect(const std::vector<Touch>& touches);
  void add(const Touch& touch);
  std::size_t next(std::size_t k) const { return (k + 1) % chain_.size(); }
  std::size_t previous(std::size_t k) const { return (k + chain_.size() - 1) % chain_.size(); }
  void connect(std::size_t k);
  bool join(Stretch& a, Stretch& b) const;
  /// A part of the stretch's curve stays above the height in direction n.
  bool stays_above(const Stretch& s, double from, double to, const dvec2& n, double height) const;
  bool join_at(Stretch& a, Stretch& b, double ta, double tb) const;
  void polish(Stretch& a, Stretch& b) const;
  dvec2 at(const Stretch& s, double t) const;
  double nearest(const Stretch& s, double t, const dvec2& x) const;
  std::optional<double> end_near(const Stretch& s, double t) const;
  bool is_tangent(const Stretch& s, double t, const dvec2& d) const;
  bool has_no_length(const Stretch& s) const;
  void drop_doubles();
  bool is_between(std::size_t k) const;
  bool supports(const dvec2& n, const dvec2& x) const;
  std::optional<int> point_at(const dvec2& x) const;
  OutlineSide corner_of(const Stretch& s, bool end) const;

  const PlanarArcs& arcs_;
  std::span<const dvec2> points_;
  std::vector<int> points_by_x_;
  std::vector<Stretch> chain_;
};

}  // namespace taut
