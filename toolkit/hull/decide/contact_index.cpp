#include "taut/hull/decide/contact_index.h"

#include <algorithm>
#include <optional>

#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/height_growth.h"
#include "taut/hull/decide/parameter_region.h"

namespace taut {
namespace {

/// In units of the resolution: what is smaller may be taken for a point.
constexpr double point_size = 4;

/// How often a surface is let reach further: each time it becomes up to three times as wide.
constexpr int extension_limit = 24;

/// Two charts of one element that overlap: what is in both would count twice.
bool any_overlap(const Branches& branches, const Branch& branch) {
  std::vector<int> order = branch.charts;
  const auto element = [&](int k) { return branches.chart(k).element; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return element(a) < element(b); });
  for (std::size_t a = 0; a < order.size(); ++a) {
    const Chart& s = branches.chart(order[a]);
    if (s.kind != SourceKind::face) continue;
    for (std::size_t b = a + 1; b < order.size() && element(order[b]) == s.element; ++b) {
      const Chart& t = branches.chart(order[b]);
      if (s.u.lower < t.u.upper && t.u.lower < s.u.upper && s.v.lower < t.v.upper &&
          t.v.lower < s.v.upper) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

/// Strictly where a plane may touch, so that every point at which one does counts one.
bool ContactIndex::is_curved(const CellView& view, const Chart& chart) {
  if (chart.kind == SourceKind::vertex) return true;
  if (stand_ins_.is_stand_in(chart)) return true;  // are_points() tells
  if (chart.kind == SourceKind::face) {
    return regions_.are_definite(chart.element, chart.u, chart.v,
                                 CurvedRegions::cone_of(view.corners()));
  }
  pieces_.restricted(chart.element, chart.u, {0, 1}, net_);
  HeightGrowth growth(view);
  for (const dvec4& p : net_) growth.include(p);
  for (std::size_t k = 0; k + 2 < net_.size(); ++k) {
    if (!growth.along(2.0 * net_[k + 1] - net_[k] - net_[k + 2])) return false;
  }
  return net_.size() > 2;
}

/// The largest angle by which two charts that go on into each other miss a smooth way.
double ContactIndex::kink(const Branches& branches, const Glue& glue) {
  if (glue.kind == Glue::Kind::faces) {
    const MapElement& element = pieces_.element(branches.chart(glue.a).element);
    return element.kink[std::size_t(glue.at_a)];
  }
  if (glue.kind != Glue::Kind::edges) return 0;
  const auto tangent = [&](int chart, int end) {
    const int element = branches.chart(chart).element;
    pieces_.restricted(element, {0, 1}, {0, 1}, net_);
    const std::size_t last = net_.size() - 1;
    return unit(end == 0 ? euclidean(net_[1]) - euclidean(net_[0])
                         : euclidean(net_[last - 1]) - euclidean(net_[last]));
  };
  return glm::length(tangent(glue.a, glue.at_a) + tangent(glue.b, glue.at_b));
}

bool ContactIndex::is_disc(const Branches& branches, const Branch& branch) {
  if (any_overlap(branches, branch) || !glue_.find(branches, branch)) return false;
  DisjointSets sets(branches.charts().size());
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::face_vertex) sets.unite(glue.a, glue.b);
  }
  for (const int k : branch.charts) {
    if (sets.find(k) != sets.find(branch.charts.front())) return false;
  }
  rings_.find(branches, branch, glue_.table());
  if (int(branch.charts.size()) - glue_.count() + rings_.count() != 1) return false;
  find_ends(branches, branch);
  for (const auto& [chart, side] : rings_.poles()) glue_.close(chart, side);
  return true;
}

void ContactIndex::find_ends(const Branches& branches, const Branch& branch) {
  ends_.clear();
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::faces) continue;
    const Side side = Side(glue.at_a);
    for (const bool upper : {false, true}) {
      const Side border = side_at_end(side, upper);
      if (rings_.is_inside(glue.a, side, border)) continue;
      const Side there = Side(glue.at_b);
      const Side border_there = side_at_end(there, upper != glue.reversed);
      std::optional<CornerRings::Fan> fan = rings_.fan(glue.a, side, border);
      if (!fan && !is_at(branches.chart(glue.a), border)) {
        fan = {{{glue.a, border, side}, {glue.b, border_there, there}}};
      }
      if (fan && std::any_of(fan->begin(), fan->end(), [&](const CornerRings::Corner& c) {
            return !glue_.is_border(c.chart, c.next);
          })) {
        fan.reset();  // not the last ones
      }
      ends_.push_back({{glue.a, side, border}, {glue.b, border_there}, fan});
    }
  }
}

bool ContactIndex::bends_down(const CellView& view, const Branches& branches,
                              const Branch& branch) {
  const double size = glm::distance(branch.lower, branch.upper);
  double kinks = 0;
  for (const int g : branch.glues) {
    const double own = kink(branches, branches.glue(g));
    kinks += own;
    if (!(own * size <= rho_)) return false;
  }
  if (!(kinks * size <= kink_share * rho_)) return false;
  tilt_ = 0;
  const bool curved = std::all_of(branch.charts.begin(), branch.charts.end(),
                                  [&](int k) { return is_curved(view, branches.chart(k)); });
  if (curved) return stand_ins_.are_points(branches, branch, rho_);
  return is_nearly_concave(view, branches, branch);
}

/// Let D be the extent of the branch, h the heights less e |x - c|^2 with c in its box and
/// e = rho / (4 D^2). Where h has no slope, the normal is d - 2 e (x - c), of a length less than
/// 2 and all but along d, and h is concave there if the curvature towards it is less than e, for
/// its second derivatives are that times the length less 2 e. The slopes of h differ from those of
/// the heights by 2 e D.
bool ContactIndex::is_nearly_concave(const CellView& view, const Branches& branches,
                                     const Branch& branch) {
  const double size = glm::distance(branch.lower, branch.upper);
  tilt_ = rho_ / (2 * size);
  CurvedRegions::Cone directions = CurvedRegions::cone_of(view.corners());
  directions.angle += 2 * tilt_;
  return std::all_of(branch.charts.begin(), branch.charts.end(), [&](int k) {
    const Chart& chart = branches.chart(k);
    return chart.kind == SourceKind::face &&
           regions_.are_nearly_concave(chart.element, chart.u, chart.v, directions,
                                       rho_ / (4 * size * size));
  });
}

bool ContactIndex::is_one(const CellView& view, const Branches& branches, const Branch& branch) {
  if (glm::distance(branch.lower, branch.upper) <= point_size * rho_) return true;
  if (!is_cap(view, branches, branch)) return false;
  border_.turn_to(view, branches, glue_, tilt_, slack(branch));
  return std::all_of(ends_.begin(), ends_.end(),
                     [&](const JoinEnd& end) { return border_.rise_from(end); }) &&
         std::all_of(branch.charts.begin(), branch.charts.end(),
                     [&](int k) { return border_.rise_from(k); });
}

bool ContactIndex::are_one_of_more(const CellView& view, Branches branches) {
  Sides beyond;
  for (int round = 0; round < extension_limit; ++round) {
    beyond.clear();
    const bool one = branches.all().size() == 1;
    for (const Branch& branch : branches.all()) {
      if (!bends_down(view, branches, branch) || !glue_.find(branches, branch)) return false;
      close_poles(branches, branch);
      border_.turn_to(view, branches, glue_, 0, slack(branch));
      if (!add_falling(branches, branch, one, beyond)) return false;
    }
    if (beyond.empty()) {
      // Now it is to be a cap, of which less may be a border and heights have to grow by more.
      const Branch& all = branches.all().front();
      if (!one || !is_cap(view, branches, all)) return false;
      border_.turn_to(view, branches, glue_, tilt_, slack(all));
      if (!add_falling(branches, all, true, beyond)) return false;
      if (beyond.empty() && !add_ends(beyond)) return false;
      if (beyond.empty()) return true;
    }
    if (!branches.extend(pieces_, beyond)) return false;
  }
  return false;
}

/// The borders beside joins from whose ends the heights do not grow inwards. False if there are
/// none.
bool ContactIndex::add_ends(Sides& sides) {
  for (const JoinEnd& end : ends_) {
    if (border_.rise_from(end)) continue;
    const std::size_t before = sides.size();
    for (const auto& [chart, side] : {std::pair(end.at.chart, end.at.other), end.beside}) {
      if (glue_.is_border(chart, side)) sides.emplace_back(chart, side);
    }
    if (sides.size() == before) return false;
  }
  return true;
}

/// Nothing is beyond them, whether charts meet all around them or not yet.
void ContactIndex::close_poles(const Branches& branches, const Branch& branch) {
  for (const int k : branch.charts) {
    const Chart& chart = branches.chart(k);
    if (chart.kind != SourceKind::face) continue;
    for (const Side side : all_sides) {
      if (is_at(chart, side) && pieces_.is_pole(pieces_.element(chart.element), side)) {
        glue_.close(k, side);
      }
    }
  }
}

/// The sides of a branch beyond which it has to reach further: from which heights do not grow
/// inwards, and if it is `alone` not from where it matters. False if they do not so from edges or
/// vertices.
bool ContactIndex::add_falling(const Branches& branches, const Branch& branch, bool alone,
                               Sides& sides) {
  for (const int k : branch.charts) {
    const bool is_face = branches.chart(k).kind == SourceKind::face;
    if ((alone || !is_face) && border_.rise_from(k)) continue;
    if (!is_face) return false;
    for (const Side side : all_sides) {
      if (glue_.is_border(k, side) && !border_.rise_from(k, side)) sides.emplace_back(k, side);
    }
  }
  return true;
}

/// Beyond a side from which the heights do not grow inwards the region goes on, as far as it may.
bool ContactIndex::is_one_of_pieces(const CellView& view, const Branches& branches,
                                    const Branch& branch) {
  const Chart& chart = branches.chart(branch.charts.front());
  if (branch.charts.size() > 1 || chart.kind != SourceKind::face || chart.pieces.size() < 3) {
    return false;
  }
  const CurvedRegions::Cone directions = CurvedRegions::cone_of(view.corners());
  std::vector<ParameterRegion::Cell> rectangles;
  for (const int k : chart.pieces) {
    const MapPiece& piece = *view.seen()[std::size_t(k)].piece;
    rectangles.push_back({piece.u, piece.v});
    if (!regions_.are_definite(chart.element, piece.u, piece.v, directions)) return false;
  }
  ParameterRegion region(rectangles);
  for (int round = 0; round < extension_limit; ++round) {
    if (!region.is_disc()) return false;
    bool any = false;
    // Where heights grow inwards obliquely, or not at all.
    std::vector<ParameterRegion::BorderSide> others;
    for (const ParameterRegion::BorderSide& side : region.border()) {
      const ParameterRegion::Cell cell = region.cell(side.i, side.j);
      rectangle_.turn_to(chart.element, cell.u, cell.v);
      if (rectangle_.rise(view, side.side, 0, false)) continue;
      if (rectangle_.rise(view, side.side, 0) || rectangle_.have_no_low(view, side.side)) {
        others.push_back(side);
        continue;
      }
      const std::optional<ParameterRegion::Cell> beyond = region.extend(side);
      if (!beyond || !regions_.are_definite(chart.element, beyond->u, beyond->v, directions)) {
        return false;
      }
      any = true;
    }
    if (!any) return !region.any_end_inwards(others);
  }
  return false;
}

}  // namespace taut
