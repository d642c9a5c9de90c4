#pragma once

#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/corner_rings.h"
#include "taut/hull/decide/height_bends.h"

namespace taut {

/// Proves that the contacts of a branch are one to within the resolution, for each direction of a
/// cell: on each chart the heights are all but concave, and where two meet, the highest point of
/// what they share is the highest of one of them.
class NearConcavity {
 public:
  NearConcavity(const MapPieces& pieces, double resolution)
      : pieces_(pieces), rho_(resolution), rings_(pieces) {}

  /// True is certain.
  bool is_one(const CellView& view, const Branches& branches, const Branch& branch);

 private:
  bool is_nearly_concave(const CellView& view, const Chart& chart, double size,
                         const std::vector<dvec2>& region);
  bool is_reentrant(const Branches& branches, const Branch& branch);
  static std::vector<Interval> stretches(const CellView& view, const Chart& chart);
  bool find_chain(const CellView& view, const Branches& branches, const Branch& branch,
                  const std::vector<bool>& held);
  bool chain_is_nearly_concave(const CellView& view);
  bool meet_once(const CellView& view, const Branches& branches, const Branch& branch,
                 const Glue& glue) const;
  bool both_rise(const CellView& view, const Branches& branches, const Branch& branch,
                 const Glue& glue) const;
  ContactJet jet_at(const Branches& branches, int chart, Side side, double t) const;

  const MapPieces& pieces_;
  double rho_;
  CornerRings rings_;
  std::vector<dvec4> net_;                         // scratch
  NetBends bends_;                                 // scratch
  std::vector<std::pair<double, dvec4>> polygon_;  ///< of a chain, by its parameter
  std::vector<dvec3> known_;                       ///< points of it
  std::vector<dvec2> hull_;                        // scratch
};

}  // namespace taut
