#include "taut/hull/trace/cell_crossings.h"

#include <algorithm>

namespace taut {
namespace {

/// Contacts within this of a side, in parameters, are on it.
constexpr double border_distance = 1e-9;

Interval between(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

bool meets(const Interval& a, const Interval& b) {
  return a.lower <= b.upper && b.lower <= a.upper;
}

bool holds(const Interval& a, const Interval& b) {
  return a.lower <= b.lower && b.upper <= a.upper;
}

}  // namespace

void CellCrossings::add(const SeparatingArc& arc) {
  for (const ArcPiece& piece : arc.pieces) {
    for (std::size_t k = 0; k + 1 < piece.rulings.size(); ++k) {
      for (const std::size_t i : {0U, 1U}) {
        add(piece.rulings[k].contact[i], piece.rulings[k + 1].contact[i]);
      }
    }
  }
}

void CellCrossings::add(const EdgeStretch& stretch) {
  add({stretch.instance, SourceKind::edge, stretch.piece, stretch.from, 0},
      {stretch.instance, SourceKind::edge, stretch.piece, stretch.to, 0});
}

/// From one contact to another in the same element.
void CellCrossings::add(const Contact& from, const Contact& to) {
  if (from.kind == SourceKind::face) {
    add(from.instance, from.element, {between(from.u, to.u), between(from.v, to.v)});
  } else if (from.kind == SourceKind::edge) {
    for (const ContactGeometry::PieceSide& on : geometry_.sides(from)) {
      const Interval along = on.reversed ? between(1 - from.u, 1 - to.u) : between(from.u, to.u);
      const double end = at_upper_end(on.side) ? 1 : 0;
      const Interval across{end, end};
      const int instance = on.instance < 0 ? from.instance : on.instance;
      add(instance, on.patch,
          along_v(on.side) ? Rectangle{across, along} : Rectangle{along, across});
    }
  }
}

void CellCrossings::add(int instance, int patch, const Rectangle& rectangle) {
  rectangles_[{instance, patch}].push_back(rectangle);
  const std::array<Border, 4>& borders =
      geometry_.patch({instance, SourceKind::face, patch, 0, 0}).borders;
  for (const Side side : all_sides) {
    const Interval& across = along_v(side) ? rectangle.u : rectangle.v;
    if (at_upper_end(side) ? across.upper < 1 - border_distance : across.lower > border_distance)
      continue;
    const double end = at_upper_end(side) ? 1 : 0;
    const Border& border = borders[std::size_t(side)];
    if (border.kind == BorderKind::collapsed) {
      // The whole side is the one point.
      add_beyond(instance, patch,
                 along_v(side) ? Rectangle{{end, end}, {0, 1}} : Rectangle{{0, 1}, {end, end}});
    } else if (border.kind == BorderKind::smooth) {
      Interval along = along_v(side) ? rectangle.v : rectangle.u;
      if (border.reversed) along = {1 - along.upper, 1 - along.lower};
      const double there = at_upper_end(border.neighbor_side) ? 1 : 0;
      add_beyond(instance, border.neighbor,
                 along_v(border.neighbor_side) ? Rectangle{{there, there}, along}
                                               : Rectangle{along, {there, there}});
    }
  }
}

/// Once, however often it is come to around a corner or a pole.
void CellCrossings::add_beyond(int instance, int patch, const Rectangle& rectangle) {
  if (!is_known(instance, patch, rectangle)) add(instance, patch, rectangle);
}

bool CellCrossings::is_known(int instance, int patch, const Rectangle& rectangle) const {
  const auto found = rectangles_.find({instance, patch});
  return found != rectangles_.end() &&
         std::any_of(found->second.begin(), found->second.end(), [&](const Rectangle& r) {
           return holds(r.u, rectangle.u) && holds(r.v, rectangle.v);
         });
}

bool CellCrossings::crosses(const CulledCell& cell, double margin) const {
  const auto widened = [&](const Interval& t) {
    const double more = margin * (t.upper - t.lower);
    return Interval{t.lower - more, t.upper + more};
  };
  const Interval u = widened(cell.cell.u());
  const Interval v = widened(cell.cell.v());
  const auto found = rectangles_.find({cell.instance, cell.patch});
  return found != rectangles_.end() &&
         std::any_of(found->second.begin(), found->second.end(),
                     [&](const Rectangle& r) { return meets(r.u, u) && meets(r.v, v); });
}

}  // namespace taut
