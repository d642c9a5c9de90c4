#pragma once

#include "taut/verify/document_geometry.h"
#include "taut/verify/ruling_interval.h"

namespace taut {

/// The rulings of a document's scroll between those that it lists: each is solved for by Newton's
/// method where it is cut off at a share of the way between two known ones, and stretches are
/// bisected until polynomials through such rulings tell them to some 1e-13 of their change.
///
/// Where rulings merge into a free end no system of equations is regular. The last interval is a
/// polynomial in the ruling's length, or in its root where it falls with the square of the way,
/// through rulings of the interval before, since contacts are smooth in it there.
class DocumentRulings {
 public:
  explicit DocumentRulings(const DocumentGeometry& geometry) : geometry_(geometry) {}

  /// Between all neighbours that are not one ruling in two terms.
  std::vector<RulingInterval> intervals(const HullDocument::Face& scroll) const;

 private:
  bool fill(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
            RulingInterval& interval) const;
  void extrapolate(const RulingInterval& neighbor, bool ends, RulingInterval& interval) const;

  const DocumentGeometry& geometry_;
};

}  // namespace taut
