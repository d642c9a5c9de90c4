#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/coefficient_range.h"

namespace taut {

/// Proves that a branch of one polynomial patch has at most one contact for each direction of a
/// cell, by the heights along a ridge: where contacts move up to a parabolic line, beyond which the
/// patch bends up and has none.
///
/// Let h(s, t) be the heights over a part R of the parameters, concave in t and growing from both
/// its ends in t inwards. Then for each s there is one highest point, at t*(s), on which all
/// contacts are, as maxima of g(s) = h(s, t*(s)). Along w = (1, -h_st / h_tt) the second derivative
/// of h is that of g and, as h_t stays zero along the ridge, the third is that of g too. Where g
/// bends down over one interval of s only, it has one maximum inside of R at most. An edge of the
/// branch at an end of R is one more if g falls from it inwards; of two the lower one is within the
/// resolution of what is between.
class RidgeContacts {
 public:
  RidgeContacts(const MapPieces& pieces, double resolution) : pieces_(pieces), rho_(resolution) {}

  /// True is certain.
  bool are_one(const CellView& view, const Branches& branches, const Branch& branch);

 private:
  /// What is known of the second derivative of g.
  enum class Bend { up, down, falling, rising };
  struct Stretch {
    Interval s, t;
    Bend bend = Bend::up;
  };
  using Range = CoefficientRange;  ///< for all directions of a cell
  static std::optional<int> patch(const Branches& branches, const Branch& branch,
                                  std::array<bool, 4>& edges);
  bool are_one(const CellView& view, Direction along, const std::vector<dvec2>& hull,
               const std::array<bool, 4>& edges);
  void derive(Direction along);
  bool cut(const CellView& view, const std::vector<dvec2>& hull, const Interval& s, int depth);
  Range of_net(const CellView& view, const std::vector<dvec4>& net, const Stretch& stretch);
  bool widen(const CellView& view, Stretch& stretch);
  void narrow(const CellView& view, Stretch& stretch);
  bool find_bend(const CellView& view, Stretch& stretch);
  Range bend(const CellView& view, const Stretch& stretch, Range& way);
  bool is_dent_small(const CellView& view, bool at_upper);
  bool bends_down_once(const CellView& view, const std::array<bool, 2>& edges);
  void restrict(const std::vector<dvec4>& net, const Stretch& stretch, std::vector<dvec4>& part);

  const MapPieces& pieces_;
  double rho_;
  double noise_ = 0;  ///< what rounding may do to derivatives
  NetShape shape_;    ///< of t within s
  std::vector<dvec4> net_;
  std::vector<dvec4> s_, t_;
  std::array<std::vector<dvec4>, 3> second_;  ///< ss, st, tt
  std::array<std::vector<dvec4>, 4> third_;   ///< sss, sst, stt, ttt
  std::vector<Stretch> stretches_;
  std::array<std::vector<dvec4>, 4> part_;  // scratch
};

}  // namespace taut
