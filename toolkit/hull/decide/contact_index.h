#pragma once

#include <array>
#include <utility>
#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/corner_rings.h"
#include "taut/hull/decide/curved_regions.h"
#include "taut/hull/decide/stand_in_normals.h"

namespace taut {

/// Proves that a branch has one contact for each direction of a cell, by the index of the gradient
/// of the heights (Poincare and Hopf; Milnor 1965, section 6).
///
/// Let the charts of the branch, rounded by a ball as small as one likes where edges and vertices
/// are, be a surface with a border. Where the surface is curved one way, each point at which a
/// plane across d touches counts one. Where the heights x . d grow from all of the border inwards,
/// the counts sum to the surface's Euler characteristic; if that is one, so is the number of such
/// points. All near-maxima hang together with it: a piece of the surface above some height that
/// does not hold it would have a maximum of its own.
///
/// Inwards means along some direction that leads into the surface. Where several charts meet at the
/// border the directions from its two sides may lead to either side of a notch, more than half a
/// turn apart through the surface. If heights grow along what the charts share there, too, they
/// grow along all that is between; or if they grow straight inwards from both ends of the border
/// there: then the gradient itself leads inwards, less than half a turn from each of these
/// directions, for charts that go round the point once at most.
///
/// From parts of the border to which nothing of the branch is glued, so that beyond them no plane
/// touches, heights may fall: if along these they have no local minimum, the highest points of
/// them, from which the heights grow outwards, count one each too (Morse theory for surfaces with
/// borders: minima there would count minus one). So there is one contact or none.
///
/// Patches may be nearly flat too, or bend towards the directions a little: the heights less
/// e times the square of the distance from a point, which is less than a quarter of the resolution
/// over the branch, count in place of the heights.
///
/// Nothing of this depends on how charts are parametrised: it holds about poles and over joins.
class ContactIndex {
 public:
  /// `resolution`: kinks of joins that amount to less over a branch are none.
  ContactIndex(const MapPieces& pieces, double resolution)
      : pieces_(pieces), regions_(pieces), stand_ins_(pieces), rho_(resolution), rings_(pieces) {}

  /// True is certain.
  bool is_one(const CellView& view, const Branches& branches, const Branch& branch);
  /// The same for a surface that reaches further, where the heights do not grow from the border of
  /// the branch inwards: what of it planes do not touch does not matter.
  bool is_one_of_more(const CellView& view, const Branches& branches, const Branch& branch) {
    return are_one_of_more(view, branches.alone(branch));
  }
  /// The same for a surface that holds all branches.
  bool are_one_of_more(const CellView& view, Branches branches);

  /// The same for a surface of one patch that is made of the branch's pieces, where their rectangle
  /// holds much else.
  bool is_one_of_pieces(const CellView& view, const Branches& branches, const Branch& branch);

 private:
  class Growth;
  /// Where a side at which charts meet ends on the border, and the first and the last of those
  /// that meet there, as far as is known.
  struct JoinEnd {
    CornerRings::Corner at;
    std::pair<int, Side> beside;  ///< of the chart on the other side, what its border is there
    std::optional<CornerRings::Fan> fan;
  };
  struct CornerRays {
    dvec4 corner;
    dvec3 next, other;
  };
  /// What is glued to the sides of its charts, which span the same stretches there.
  bool find_glued(const Branches& branches, const Branch& branch);
  static bool is_whole(const Branches& branches, const Glue& glue);
  /// The charts hang together to a surface of Euler characteristic one, with a border.
  bool is_disc(const Branches& branches, const Branch& branch);
  static bool any_overlap(const Branches& branches, const Branch& branch);
  void find_ends(const Branches& branches, const Branch& branch);
  /// They are joined smoothly, and curved, or nearly so.
  bool bends_down(const CellView& view, const Branches& branches, const Branch& branch);
  bool is_cap(const CellView& view, const Branches& branches, const Branch& branch) {
    return bends_down(view, branches, branch) && is_disc(branches, branch);
  }
  bool is_curved(const CellView& view, const Chart& chart);
  bool is_nearly_concave(const CellView& view, const Branches& branches, const Branch& branch);
  bool border_rises(const CellView& view, int chart);
  bool joins_rise(const CellView& view);
  CornerRays rays(const CornerRings::Corner& corner);
  bool join_rises(const CellView& view, const JoinEnd& end);
  bool is_pole(const Chart& chart, Side side) const;
  bool add_ends(const CellView& view, std::vector<std::pair<int, Side>>& sides);
  bool add_falling(const CellView& view, const Branch& branch, bool alone,
                   std::vector<std::pair<int, Side>>& sides);
  bool face_border_rises(const CellView& view, int chart);
  bool side_rises(const CellView& view, const NetShape& shape, Side side,
                  bool obliquely = true) const;
  bool side_has_no_low(const CellView& view, const NetShape& shape, Side side) const;
  void show(int chart);
  void show(int element, const Interval& u, const Interval& v);
  bool edge_border_rises(const CellView& view, int chart);
  bool vertex_border_rises(const CellView& view, int chart);
  bool is_beside(int chart, int element) const;
  static bool fold_outwards(const Growth& growth, const std::vector<std::vector<dvec4>>& inward);
  double kink(const Glue& glue);

  const MapPieces& pieces_;
  CurvedRegions regions_;
  StandInNormals stand_ins_;
  double rho_;
  double tilt_ = 0;  ///< by which heights have to grow from the border of the last cap
  CornerRings::Glued glued_;
  int glue_count_ = 0;  ///< of those that charts hang together by
  CornerRings rings_;
  std::vector<JoinEnd> ends_;
  /// An edge or vertex, and a chart of the branch that ends there.
  std::vector<std::pair<int, int>> beside_;
  const Branches* view_branches_ = nullptr;
  std::vector<dvec4> net_;  // scratch
};

}  // namespace taut
