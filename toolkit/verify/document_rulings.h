#pragma once

#include "taut/hull/contact/contact_system.h"
#include "taut/verify/document_geometry.h"

namespace taut {

/// A ruling in terms of its contacts' parameters in [0, 1].
struct RulingState {
  dvec3 n = dvec3(0.0);
  std::array<dvec2, 2> t = {dvec2(0.0), dvec2(0.0)};
};

/// The rulings between two neighbours of a document's scroll, of which both contacts stay in one
/// Bezier patch or curve: a polynomial in s through rulings that were solved for, s = 0 and s = 1
/// are the two. Where they merge into a free end, the polynomial is one in the ruling's length, or
/// in its root where it falls with the square of the way, through those of the interval before,
/// since contacts are smooth in it there.
class RulingInterval {
 public:
  static constexpr int node_count = 11;

  int ruling = -1;  ///< the first one; the other is the next in the list
  std::array<int, 2> source = {-1, -1};
  std::array<int, 2> patch = {-1, -1};
  /// The rulings at the nodes are solutions, not guesses.
  bool solved = false;

  void add(double s, const RulingState& state);
  RulingState value(double s) const { return evaluate(s)[0]; }
  RulingState slope(double s) const { return evaluate(s)[1]; }
  const std::vector<double>& nodes() const { return nodes_; }
  const std::vector<RulingState>& states() const { return states_; }

 private:
  std::array<RulingState, 2> evaluate(double s) const;

  std::vector<double> nodes_;
  std::vector<RulingState> states_;
};

/// The scene's contact at a place of the document. @pre the document's sources are the model's
Contact scene_contact(const DocumentGeometry& geometry, const Scene& scene, int source,
                      const SourcePlace& place);

/// Solves for rulings between those that a document lists.
class DocumentRulings {
 public:
  /// @pre the document's sources are the scene's model's, point for point
  DocumentRulings(const DocumentGeometry& geometry, const ContactSystem& system)
      : geometry_(geometry), system_(system) {}

  /// Between all neighbours that are not one ruling in two terms.
  std::vector<RulingInterval> intervals(const HullDocument::Face& scroll) const;

 private:
  bool fill(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
            RulingInterval& interval) const;
  bool solve_between(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
                     RulingInterval& interval) const;
  void extrapolate(const RulingInterval& neighbor, bool ends, RulingInterval& interval) const;

  const DocumentGeometry& geometry_;
  const ContactSystem& system_;
};

}  // namespace taut
