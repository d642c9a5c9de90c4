#pragma once

#include <optional>

#include "taut/verify/document_geometry.h"
#include "taut/verify/ruling_interval.h"

namespace taut {

/// Solves for the rulings of an interval, whose contacts are where their surfaces are tangent to
/// the plane of the ruling.
class RulingSolver {
 public:
  /// Of an interval whose ends are known. Both must outlive it.
  RulingSolver(const DocumentGeometry& geometry, RulingInterval& interval);

  /// Makes the interval's panels. False if a ruling is not found: they are what is known then.
  bool run();

 private:
  /// Parameters of both contacts.
  using Parameters = std::array<std::vector<int>, 2>;

  SourceJet jet(std::size_t k, const RulingState& at) const {
    return geometry_.jet(interval_.source[k], {interval_.patch[k], at.t[k]});
  }
  double slope_along(std::size_t k, int parameter, const RulingState& at) const;
  bool moves(std::size_t k, int parameter, const RulingState& at) const;
  void find_parameters();
  bool run_along(const Parameters& free, const Parameters& level);
  bool add_panels(double s0, const RulingState& from, double s1, const RulingState& to,
                  double before, int depth);
  std::optional<double> fill(RulingPanel& panel, const RulingState& from,
                             const RulingState& to) const;
  std::optional<RulingState> solve(const RulingState& from, const RulingState& chord, double share,
                                   const RulingState& guess) const;
  RulingState newton_step(const RulingState& at, const RulingState& chord, double off) const;
  /// How far apart its contacts are.
  double span(const RulingState& at) const;
  bool is_ruling(const RulingState& at) const;

  const DocumentGeometry& geometry_;
  RulingInterval& interval_;
  double size_;
  Parameters all_;      ///< those of the patches, without those along which nothing moves
  Parameters on_side_;  ///< of these, those along the side that both ends lie on
  Parameters level_;    ///< others along which the surface is tangent to the planes of both ends
  Parameters free_, level_here_;  ///< what changes, and what else has to stay tangent
};

}  // namespace taut
