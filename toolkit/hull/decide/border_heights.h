#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "taut/hull/decide/chart_glue.h"
#include "taut/hull/decide/corner_rings.h"
#include "taut/hull/decide/rectangle_sides.h"

namespace taut {

/// Where a side at which charts meet ends on the border, and the first and the last of those that
/// meet there, as far as is known.
struct JoinEnd {
  CornerRings::Corner at;
  std::pair<int, Side> beside;  ///< of the chart on the other side, what its border is there
  std::optional<CornerRings::Fan> fan;
};

/// Whether the heights grow from the border of a surface made of charts inwards, for all directions
/// of a cell: along some direction that leads into it, as ContactIndex says. True is certain.
class BorderHeights {
 public:
  /// The pieces must outlive it.
  explicit BorderHeights(const MapPieces& pieces) : pieces_(pieces), sides_(pieces) {}

  /// Turns to the charts of a branch; all must outlive it. `tilt`: by how much heights have to grow
  /// along vectors of length one, at least; `slack`: slopes that amount to nothing over the branch.
  void turn_to(const CellView& view, const Branches& branches, const ChartGlue& glue, double tilt,
               double slack) {
    view_ = &view;
    branches_ = &branches;
    glue_ = &glue;
    tilt_ = tilt;
    slack_ = slack;
  }

  /// From all of a chart's border, or so that along what they fall from they have no local minimum.
  bool rise_from(int chart);
  /// From a side of a patch's chart.
  bool rise_from(int chart, Side side);
  /// From where charts meet on the border heights grow along what two of them share; or straight
  /// inwards from both of their borders there, which leads to the same side of a notch; or they do
  /// not grow along both borders at once, so that there is no local minimum of them.
  bool rise_from(const JoinEnd& end);

 private:
  RectangleSides::Corner corner(const CornerRings::Corner& c);
  void show(int chart);
  bool rise_from_face(int chart);
  bool rise_from_edge(int chart);
  bool rise_from_vertex(int chart) const;

  const MapPieces& pieces_;
  RectangleSides sides_;
  const CellView* view_ = nullptr;
  const Branches* branches_ = nullptr;
  const ChartGlue* glue_ = nullptr;
  double tilt_ = 0;
  double slack_ = 0;
  std::vector<dvec4> net_;  // scratch
};

}  // namespace taut
