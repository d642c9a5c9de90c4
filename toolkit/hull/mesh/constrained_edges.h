#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/mesh/boundary_samples.h"

namespace taut {

/// The chords of a boundary's curves, bisected by exact rulings.
class ConstrainedEdges : public EdgeConstraints {
 public:
  /// Chords no longer than `least` (in model units) are not bisected. All but the chords must
  /// outlive it.
  ConstrainedEdges(const ContactGeometry& geometry, const HullBoundary& boundary,
                   const ContactFaces& faces, const std::vector<CurveChord>& chords, double least);

  std::optional<Middle> middle(int a, int b) const override;
  void bisect(int a, int b, int middle) override;
  /// The faces beside middles that were inserted, by their numbers.
  const std::map<int, TouchedFaces>& inserted() const { return inserted_; }

 private:
  std::optional<ArcPlace> middle_of(const CurveChord& chord) const;
  void add(const CurveChord& chord);

  const ContactGeometry& geometry_;
  const HullBoundary& boundary_;
  const ContactFaces& faces_;
  ContactSystem system_;
  double least_;  // in the scene's frame
  std::map<std::pair<int, int>, CurveChord> chords_;
  std::map<int, TouchedFaces> inserted_;
};

}  // namespace taut
