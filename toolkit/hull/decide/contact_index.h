#pragma once

#include <utility>
#include <vector>

#include "taut/hull/decide/border_heights.h"
#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/chart_glue.h"
#include "taut/hull/decide/corner_rings.h"
#include "taut/hull/decide/curved_regions.h"
#include "taut/hull/decide/rectangle_sides.h"
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
/// directions, for charts that go round the point once at most. Nor does it matter where it leads
/// if the heights do not grow along both borders from there at once: that is no minimum of theirs.
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
      : pieces_(pieces),
        regions_(pieces),
        stand_ins_(pieces),
        rho_(resolution),
        rings_(pieces),
        border_(pieces),
        rectangle_(pieces) {}

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
  /// The charts hang together to a surface of Euler characteristic one, with a border.
  bool is_disc(const Branches& branches, const Branch& branch);
  void find_ends(const Branches& branches, const Branch& branch);
  /// They are joined smoothly, and curved, or nearly so.
  bool bends_down(const CellView& view, const Branches& branches, const Branch& branch);
  bool is_cap(const CellView& view, const Branches& branches, const Branch& branch) {
    return bends_down(view, branches, branch) && is_disc(branches, branch);
  }
  bool is_curved(const CellView& view, const Chart& chart);
  bool is_nearly_concave(const CellView& view, const Branches& branches, const Branch& branch);
  double kink(const Branches& branches, const Glue& glue);
  /// A slope that amounts to the resolution over the branch.
  double slack(const Branch& branch) const {
    return rho_ / glm::distance(branch.lower, branch.upper);
  }
  void close_poles(const Branches& branches, const Branch& branch);
  using Sides = std::vector<std::pair<int, Side>>;  ///< of charts
  bool add_ends(Sides& sides);
  bool add_falling(const Branches& branches, const Branch& branch, bool alone, Sides& sides);

  const MapPieces& pieces_;
  CurvedRegions regions_;
  StandInNormals stand_ins_;
  double rho_;
  double tilt_ = 0;  ///< by which heights have to grow from the border of the last that bends down
  ChartGlue glue_;
  CornerRings rings_;
  std::vector<JoinEnd> ends_;  ///< of the last disc
  BorderHeights border_;
  RectangleSides rectangle_;
  std::vector<dvec4> net_;  // scratch
};

}  // namespace taut
