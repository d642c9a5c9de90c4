#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/mesh/boundary_samples.h"

namespace taut {

/// The chords of a boundary's curves, bisected by exact rulings.
///
/// Chords that begin at an end of a piece, where other curves may begin at a small angle, are
/// divided at a length that is a power of two, in the root of the second fundamental form: of
/// chords as long as each other none hides another (concentric shells, Shewchuk 2002). Others are
/// halved.
class ConstrainedEdges : public EdgeConstraints {
 public:
  /// Chords no longer than the spacing's width are not bisected. All but the chords and the spacing
  /// must outlive it.
  ConstrainedEdges(const ContactGeometry& geometry, const HullBoundary& boundary,
                   const ContactFaces& faces, const std::vector<CurveChord>& chords,
                   const SampleSpacing& spacing);

  std::optional<Middle> middle(int a, int b) const override;
  /// Those inside of patches; along edges samples of other curves may stand between.
  std::vector<std::pair<int, int>> wanted() const override;
  /// The gap of the spacing.
  double narrow() const override { return spacing_.gap; }
  void bisect(int a, int b, int middle) override;
  /// The faces beside middles that were inserted, by their numbers.
  const std::map<int, TouchedFaces>& inserted() const { return inserted_; }

 private:
  /// Part of a chord within a piece.
  struct Span {
    Ruling a, b;
    bool from_end = false;  ///< a is an end of the piece, or
    bool to_end = false;    ///< b is
  };
  bool near(const Ruling& a, const Ruling& b, int contact) const;
  double share(const Span& span, int contact,
               const std::function<std::optional<Ruling>(double share)>& at) const;
  std::optional<ArcPlace> within(const CurveChord& chord, int piece, const Ruling& a,
                                 const Ruling& b) const;
  std::optional<ArcPlace> middle_of(const CurveChord& chord) const;
  void add(const CurveChord& chord);

  const ContactGeometry& geometry_;
  const HullBoundary& boundary_;
  const ContactFaces& faces_;
  ContactSystem system_;
  SampleSpacing spacing_;
  double least_;  // the width, in the scene's frame
  std::map<std::pair<int, int>, CurveChord> chords_;
  std::map<int, TouchedFaces> inserted_;
};

}  // namespace taut
