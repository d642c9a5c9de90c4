#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// Where surfaces and curves go on smoothly: where two of them meet alone, and where nearly equal
/// ones meet side by side, each in its own continuation. Those that miss each other by least go
/// together.
class SmoothJoins {
 public:
  /// The geometry must outlive it.
  explicit SmoothJoins(const ContactGeometry& geometry);

  /// A side of a patch that another one goes on from.
  struct Side {
    Contact patch;  ///< of instance -1 where the other goes on into an equal of this one
    taut::Side side = taut::Side::u0;
    bool reversed = false;
  };
  /// What goes on beyond a side of a patch. @pre kind face
  std::optional<Side> beyond(const Contact& face, taut::Side side) const;
  /// The largest angle between the tangent planes on the two sides of where a patch goes on beyond
  /// its side, as measured at some places: the same from both; 0 where it does not.
  double kink(const Contact& face, taut::Side side);

  /// An end of a piece, 0 or 1.
  struct End {
    Contact piece;
    int end = 0;
  };
  /// What goes on beyond an end of a piece that is a vertex. @pre kind edge, not repeated
  std::optional<End> beyond(const Contact& piece, int end) const;
  /// The angle between the tangents where a piece goes on beyond its end, into another one of its
  /// edge or past a vertex; 0 where it does not. @pre kind edge, not repeated
  double kink(const Contact& piece, int end) const;

  /// All that meets in an edge's piece or a vertex goes on smoothly: contacts there are those of
  /// patches, or of curves that pass. @pre kind edge or vertex, not repeated
  bool passes(const Contact& c) const { return passed_.contains({c.kind, c.instance, c.element}); }

 private:
  void pair_sides(const Contact& edge);
  void pair_ends(const Contact& vertex);
  bool join(const Contact& vertex, const std::vector<ContactGeometry::PieceEnd>& all);
  bool is_surrounded(const Contact& vertex) const;
  /// A seam, or an edge that is none.
  bool is_smooth(const Contact& piece) const {
    return geometry_.piece(piece).edge < 0 || passes(piece);
  }
  double measured_kink(const Contact& face, taut::Side side, const Border& border) const;

  using Key = std::tuple<SourceKind, int, int>;
  const ContactGeometry& geometry_;
  struct Paired {
    Side beyond;
    double kink = 0;
  };
  std::map<std::tuple<int, int, taut::Side>, Paired> sides_;
  std::map<std::tuple<int, int, int>, End> ends_;
  std::set<Key> passed_;
  /// By part, and the first of the two patches and its side.
  std::map<std::array<int, 3>, double> measured_;
};

}  // namespace taut
