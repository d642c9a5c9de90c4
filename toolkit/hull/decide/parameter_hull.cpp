#include "taut/hull/decide/parameter_hull.h"

#include <algorithm>

namespace taut {

std::vector<dvec2> parameter_hull(const CellView& view, const Branches& branches,
                                  const Branch& branch, int index) {
  const Chart& chart = branches.chart(index);
  std::vector<dvec2> points;
  const auto add = [&](double u, double v) {
    points.emplace_back((u - chart.u.lower) / (chart.u.upper - chart.u.lower),
                        (v - chart.v.lower) / (chart.v.upper - chart.v.lower));
  };
  for (const int k : chart.pieces) {
    const MapPiece& piece = *view.seen()[std::size_t(k)].piece;
    for (const double u : {piece.u.lower, piece.u.upper}) {
      for (const double v : {piece.v.lower, piece.v.upper}) add(u, v);
    }
  }
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.a != index || glue.kind == Glue::Kind::faces) continue;
    if (glue.kind == Glue::Kind::face_vertex && glue.at_a >= 4) {  // a corner
      const int corner = glue.at_a - 4;
      add(corner < 2 ? 0 : 1, corner % 2);
      continue;
    }
    const Interval& own = glue.kind == Glue::Kind::face_edge ? branches.chart(glue.b).u
                                                             : along(chart, Side(glue.at_a));
    for (const double t : {own.lower, own.upper}) {
      const dvec2 uv = on_side(Side(glue.at_a), glue.reversed ? 1 - t : t);
      add(uv.x, uv.y);
    }
  }
  std::sort(points.begin(), points.end(),
            [](const dvec2& a, const dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<dvec2> hull;
  for (const bool above : {false, true}) {
    const std::size_t first = hull.size();
    for (const dvec2& p : points) {
      while (hull.size() > first + 1 && !turns_right(p, hull.back(), hull[hull.size() - 2])) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    if (!above) std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace taut
