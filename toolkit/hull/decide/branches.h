#pragma once

#include <array>
#include <utility>
#include <vector>

#include "taut/hull/decide/cell_view.h"

namespace taut {

/// The pieces of one element that hang together, and the rectangle of its parameters that they
/// span.
struct Chart {
  int element = -1;
  SourceKind kind = SourceKind::face;
  Interval u, v;
  std::vector<int> pieces;  ///< of CellView::seen()
  int branch = -1;
};

/// Where two charts meet. Sides of a patch are numbered as Side, the ends of an edge 0 and 1.
struct Glue {
  enum class Kind {
    faces,        ///< along a smooth join
    face_edge,    ///< along a border
    face_vertex,  ///< at a corner
    edges,        ///< ends that go on into each other
    edge_vertex,  ///< at an end
  };
  Kind kind = Kind::faces;
  int a = -1, b = -1;      ///< charts, in the order of the kind's words
  int at_a = 0, at_b = 0;  ///< side or end
  bool reversed = false;   ///< parameters along the one side run against those of the other
};

/// What hangs together across joins, edges and vertices.
struct Branch {
  std::vector<int> charts;
  std::vector<int> glues;
  dvec3 lower = dvec3(infinity), upper = dvec3(-infinity);  ///< box of its control points
};

/// The pieces that a cell sees, sorted into branches: as far as is known, contacts of different
/// branches are different contacts.
class Branches {
 public:
  /// @pre the view is finished
  void find(const CellView& view);
  void clear();
  /// Forgets the other branches, and that their charts are of one.
  void keep(const std::vector<bool>& left);
  /// Takes all for one branch.
  void unite();
  /// One of the branches alone.
  Branches alone(const Branch& branch) const;
  /// Lets charts of patches reach further, beyond some of their sides, by as much as they are wide:
  /// onto what no plane of the cell touches, or what is known to be lower. Over smooth joins they
  /// go on in charts without pieces, or in those of other branches; beyond other borders there is
  /// nothing, and the answer false.
  bool extend(const MapPieces& pieces, const std::vector<std::pair<int, Side>>& beyond);

  const std::vector<Branch>& all() const { return branches_; }
  const Chart& chart(int k) const { return charts_[std::size_t(k)]; }
  const std::vector<Chart>& charts() const { return charts_; }
  const Glue& glue(int k) const { return glues_[std::size_t(k)]; }

 private:
  void make_charts(const CellView& view);
  void glue_face(const MapPieces& pieces, int chart);
  void glue_edge(const MapPieces& pieces, int chart);
  void add(const Glue& glue);
  /// Charts span the same stretch of what they share.
  void even_out();
  void glue(const MapPieces& pieces);
  void sort_into_branches(const MapPieces& pieces);
  void find_boxes(const CellView& view);
  bool extend(const MapPieces& pieces, int chart, Side side);
  bool join_touching();
  void sort_charts();
  int chart_touching(int element, const Interval& u, const Interval& v) const;

  std::vector<Chart> charts_;
  std::vector<Branch> branches_;
  std::vector<Glue> glues_;
  std::vector<std::pair<int, int>> of_elements_;  ///< elements and their charts, sorted
  std::vector<int> rest_;                         // scratch
};

/// In units of the resolution: what the kinks of a branch that may have one contact amount to over
/// its extent, together. A dent that they make is as deep as a quarter of that.
inline constexpr double kink_share = 2;

/// The interval of a side's free parameter that a chart spans.
const Interval& along(const Chart& chart, Side side);
/// The side that meets another one at its lower or upper end.
Side side_at_end(Side side, bool upper);
/// The chart reaches the side of its patch.
bool is_at(const Chart& chart, Side side);

}  // namespace taut
